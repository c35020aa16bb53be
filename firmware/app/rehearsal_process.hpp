#pragma once
// `ligature-firmware rehearse` as a child of the running controller: what a scene does to it ends with it.

#include <atomic>
#include <chrono>
#include <string>
#include <vector>

namespace ligature::app {

struct Rehearsal {
  std::string program;  ///< ligature-firmware
  std::string file;     ///< names the scene, and polylines are found beside it
  std::string text;     ///< of the scene, as it will be run
  std::vector<std::string> overrides;
  double no_loss_m_per_s = 0.0;               ///< what a drawn knot loses is measured up to this speed; 0: it is not
  std::chrono::milliseconds patience{9'000};  ///< whoever asked waits for 10 s
};

struct Verdict {
  std::string refusal;  ///< why it must not run; empty: it may
  std::string excess;   ///< what time it loses that it must not; empty: none, or it was not measured
};

/// Waits for the child's verdict, for `patience` at most and until `cancelled`; then the child is killed. The child
/// inherits the calling thread's cores and none of our files. It is started without a copy of our memory, so that no
/// page of the loop's is touched.
[[nodiscard]] Verdict rehearse_elsewhere(const Rehearsal& what, const std::atomic<bool>& cancelled);

}  // namespace ligature::app
