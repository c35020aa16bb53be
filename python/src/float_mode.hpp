#pragma once
// Sets the floating-point mode of ligature-lab in Python's process, where another library may have changed the mode.

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace ligature::python {

/// While an object lives: rounding to nearest, denormals kept. A shared library built with -ffast-math switches
/// denormals off for the thread that loads it; results would then differ from those of the lab's programs.
class DefaultFloats {
 public:
#if defined(__x86_64__)
  DefaultFloats() : before_(_mm_getcsr()) {
    if (is_strange()) _mm_setcsr(kDefault);
  }
  ~DefaultFloats() {
    if (is_strange()) _mm_setcsr(before_);
  }
  DefaultFloats(const DefaultFloats&) = delete;
  DefaultFloats& operator=(const DefaultFloats&) = delete;

 private:
  static constexpr unsigned kDefault = 0x1f80, kModes = 0xffc0;  // kModes: control bits; the others are status flags
  [[nodiscard]] bool is_strange() const { return (before_ & kModes) != kDefault; }
  unsigned before_;
#endif
};

}  // namespace ligature::python
