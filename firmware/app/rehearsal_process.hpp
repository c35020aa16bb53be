#pragma once
// Runs `ligature-firmware rehearse` as a child process of the running controller, so that a harmful scene can only
// crash the child.

#include <atomic>
#include <chrono>
#include <string>
#include <vector>

namespace ligature::app {

struct Rehearsal {
  std::string program;  ///< path of ligature-firmware
  std::string file;     ///< names the scene; its polyline files are looked up relative to it
  std::string text;     ///< the scene's text, exactly as it will be run
  std::vector<std::string> overrides;
  double no_loss_m_per_s = 0.0;               ///< hand speed up to which time loss is measured; 0: not measured
  std::chrono::milliseconds patience{9'000};  ///< longest wait: less than the 10 s for which the command's sender waits
};

struct Verdict {
  std::string refusal;  ///< why the scene must not run; empty: it may
  std::string excess;   ///< time lost beyond what is allowed; empty: none, or not measured
};

/// Starts the child and waits for its verdict. Kills the child after `patience`, or when `cancelled` is set. The child
/// inherits the calling thread's CPU affinity, but none of our open files. posix_spawn() starts it without copying our
/// memory, so the loop gets no page faults.
[[nodiscard]] Verdict rehearse_elsewhere(const Rehearsal& what, const std::atomic<bool>& cancelled);

}  // namespace ligature::app
