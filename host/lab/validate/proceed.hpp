#pragma once
// Runs one tick of a validation case, or stops it when the user asks for that, because a case may take minutes.

#include <cstdint>
#include <stdexcept>

namespace ligature::validate {

struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Whether to stop. Set by a program that catches Interrupted. @see console::stop_requested
inline bool (*stop_asked)() noexcept = []() noexcept { return false; };

/// Number of ticks of all cases so far. To compute the cost of a tick, read this before and after a case.
inline std::int64_t ticks_done = 0;

/// To be called once a tick. @throws Interrupted
inline void heed_stop() {
  if (stop_asked()) throw Interrupted();
}

/// Runs one tick. @throws Interrupted
template <class Thread, class... Input>
void proceed(Thread& thread, const Input&... input) {
  heed_stop();
  thread.tick(input...);
  ++ticks_done;
}

}  // namespace ligature::validate
