#include "sim_device/event_loop.hpp"

#include <ctime>

#include "sim_device/arrival_times.hpp"

namespace ligature::sim {

using std::chrono::nanoseconds;
using std::chrono::seconds;

Time now_monotonic() noexcept {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return seconds(t.tv_sec) + nanoseconds(t.tv_nsec);
}

void EventLoop::serve(Time now) {
  received_.clear();
  left_.clear();
  port_.receive(received_, left_);
  for (auto first = received_.begin(); first != received_.end();) {  // frames of one client are consecutive
    const auto last =
        std::find_if(first, received_.end(), [&](const Received& r) { return r.client != first->client; });
    const std::vector<Time> times = arrival_times({first, last}, last_look_, now, HandDevice::kPeriod,
                                                  [&](const can::Frame& f) { return device_.begins_period(f); });
    if (times.front() != now) ++stats_.stalls;
    for (std::size_t i = 0; first != last; ++first, ++i) {
      device_.submit(first->frame, HandDevice::kFirstClient + first->client, times[i]);
    }
  }
  last_look_ = now;
  device_.advance(now);
  if (faults_ != nullptr) faults_->apply(device_, now);
  std::vector<Delivery>& out = device_.deliveries();
  std::size_t sent = 0;
  for (; sent < out.size() && out[sent].due <= now; ++sent)
    port_.send(out[sent].frame, out[sent].sender - HandDevice::kFirstClient);
  out.erase(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(sent));
  for (const int client : left_) device_.drop_client(HandDevice::kFirstClient + client);
}

void EventLoop::wait(Time at_most, const sigset_t& during_sleep) {
  const Time before = now_monotonic();
  const Time wake = std::min(device_.wake_at(port_.clients()), before + at_most);
  const Time timeout = std::max(wake - before, Time(0));
  const auto whole = std::chrono::duration_cast<seconds>(timeout);
  const timespec limit{whole.count(), (timeout - whole).count()};
  fds_.clear();
  port_.add_descriptors(fds_);
  const int ready = ppoll(fds_.data(), fds_.size(), &limit, &during_sleep);
  ++stats_.wakeups;
  if (ready == 0) stats_.worst_lateness = std::max(stats_.worst_lateness, now_monotonic() - wake);
}

}  // namespace ligature::sim
