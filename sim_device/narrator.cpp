#include "sim_device/narrator.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace ligature::sim {

Narrator::Narrator(std::string hand) : hand_(std::move(hand)), is_terminal_(isatty(STDOUT_FILENO) == 1) {}

void Narrator::say(const std::string& what) const {
  std::printf("%s%s hand: %s\n", is_terminal_ ? "\r" : "", hand_.c_str(), what.c_str());
  std::fflush(stdout);
}

void Narrator::look(const HandDevice& device, int clients, Time now) {
  if (clients != std::exchange(clients_, clients)) say(std::to_string(clients) + " on the bus beside the drives");
  const bool faulted = std::ranges::any_of(device.drives(), [](const auto& drive) { return drive->has_fault(); });
  const Mechanics& m = device.mechanics();
  if (faulted && !faulted_ && m.has_started())  // start-up may try the watchdogs
    say("controller silent, drives took their torque away (moteus drives damp)");
  faulted_ = faulted;
  const bool has_end = m.script_end_s() < kEndless_s;
  if (m.has_started() && !std::exchange(started_, true))
    say(has_end ? "drives enabled, script begins" : "drives enabled, the operator begins");
  if (started_ && m.is_done() && !std::exchange(done_, true)) say("done, dead-man let go");
  if (!is_terminal_ || !started_ || !has_end || done_ || now < next_progress_) return;
  next_progress_ = now + std::chrono::seconds(1);
  std::printf("\r%s hand: %.0f s of %.0f s ", hand_.c_str(), m.script_time_s(), m.script_end_s());
  std::fflush(stdout);
}

}  // namespace ligature::sim
