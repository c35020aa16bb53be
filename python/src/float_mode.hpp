#pragma once
// Rounding as the laboratory's programs have it, whatever a library in the same process has done to it.

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace ligature::python {

/// While it lives: round to nearest, denormals kept. A shared library built with -ffast-math switches them off for the
/// thread that loads it, and results would differ from a run without that library.
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
  static constexpr unsigned kDefault = 0x1f80, kModes = 0xffc0;  // the other bits only remember what has happened
  [[nodiscard]] bool is_strange() const { return (before_ & kModes) != kDefault; }
  unsigned before_;
#endif
};

}  // namespace ligature::python
