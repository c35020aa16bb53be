#pragma once
// One tick of a case, unless the user has had enough: a case may take minutes.

#include <stdexcept>

namespace ligature::validate {

struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Whether to give up; who catches Interrupted may say. @see console::stop_requested
inline bool (*stop_asked)() noexcept = []() noexcept { return false; };

/// @throws Interrupted
template <class Thread, class... Input>
void proceed(Thread& thread, const Input&... input) {
  if (stop_asked()) throw Interrupted();
  thread.tick(input...);
}

}  // namespace ligature::validate
