#include "bridge/exchange.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "sim_device/event_loop.hpp"

namespace ligature::bridge {

using sim::now_monotonic;

Exchange::Exchange(std::unique_ptr<Device> device, Nanoseconds period, Nanoseconds owner_within)
    : device_(std::move(device)),
      period_(period),
      owner_within_(owner_within),
      event_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)),
      thread_([this](const std::stop_token& stop) { live(stop); }) {}

Exchange::~Exchange() {
  thread_.request_stop();
  thread_.join();
  close(event_);
}

void Exchange::set_force(const Vec& force_D_N, Nanoseconds now) {
  const std::scoped_lock lock(mutex_);
  if (force_ != force_D_N && !waits_since_) waits_since_ = now;
  force_ = force_D_N;
  force_at_ = now;
}

Exchange::Outgoing Exchange::take_force(Nanoseconds now) {
  const std::scoped_lock lock(mutex_);
  return {now - force_at_ <= owner_within_ ? force_ : Vec{}, std::exchange(waits_since_, std::nullopt)};
}

std::optional<Heard> Exchange::newest() const {
  const std::scoped_lock lock(mutex_);
  return heard_;
}

std::string Exchange::problem() const {
  const std::scoped_lock lock(mutex_);
  return problem_;
}

Nanoseconds Exchange::longest_exchange() const {
  const std::scoped_lock lock(mutex_);
  return longest_;
}

ForceWaits Exchange::force_waits() const {
  const std::scoped_lock lock(mutex_);
  return waits_;
}

/// Counts an exchange in which the device answered.
void Exchange::count(Nanoseconds begin, Nanoseconds end, std::optional<Nanoseconds> waited_since) noexcept {
  longest_ = std::max(longest_, end - begin);
  if (!waited_since) return;
  ++waits_.forces;
  waits_.sum += end - *waited_since;
  waits_.worst = std::max(waits_.worst, end - *waited_since);
}

void Exchange::clear_event() const noexcept {
  eventfd_t count = 0;
  (void)eventfd_read(event_, &count);
}

void Exchange::live(const std::stop_token& stop) {
  Nanoseconds due = now_monotonic();
  while (!stop.stop_requested()) {
    const Nanoseconds begin = now_monotonic();
    const Outgoing outgoing = take_force(begin);
    const auto state = device_->exchange(outgoing.force_D_N);
    const Nanoseconds end = now_monotonic();
    {
      const std::scoped_lock lock(mutex_);
      if (state) heard_ = Heard{*state, end, heard_ ? heard_->number + 1 : 1};
      problem_ = state ? std::string() : device_->problem();
      if (state) count(begin, end, outgoing.waits_since);
    }
    ++exchanges_;
    if (state) (void)eventfd_write(event_, 1);
    due = std::max(due + (state ? period_ : std::max<Nanoseconds>(period_, std::chrono::milliseconds(1))), end);
    const auto whole = std::chrono::duration_cast<std::chrono::seconds>(due);
    const timespec at{whole.count(), (due - whole).count()};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
  }
  (void)device_->exchange(Vec{});
  device_.reset();
}

}  // namespace ligature::bridge
