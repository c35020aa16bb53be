#pragma once
// Operating-system rights and settings of a real-time thread.

#include <string>
#include <vector>

namespace ligature::platform {

/// One line per refused item with its name, cause and remedy; empty: all granted.
using Refusals = std::vector<std::string>;

/// For the whole process, before the loop starts, so that the loop meets no page fault: locks present and future pages,
/// copies pages that are shared with files, keeps freed heap from being returned to the system, and touches a heap
/// reserve.
[[nodiscard]] Refusals lock_memory();

inline constexpr int kLoopPriority = 80;     ///< above threaded interrupts (50), below the kernel's own threads (99)
inline constexpr int kPhysicsPriority = 70;  ///< below the loop, which preempts it

/// For the calling thread: pins it to `core`, sets SCHED_FIFO and exact timers, touches its stack.
[[nodiscard]] Refusals make_realtime(int core, int priority = kLoopPriority);

/// For the calling thread: treats denormals as zero. The velocities of a thread at rest decay into denormals, which
/// cost about a hundred cycles each; values below 1e-308 have no physical meaning here.
void flush_denormals() noexcept;

/// Pins the calling thread to that core. @return false if this is not allowed.
bool stay_on(int core) noexcept;

/// The last isolated core, or else the last core that this process may use: interrupts and other work run mostly on the
/// first core.
/// @param isolated  path of the kernel's list of isolated cores
[[nodiscard]] int realtime_core(const char* isolated = "/sys/devices/system/cpu/isolated");

/// Removes the core from the affinity of the calling thread and its future children; no change if it is the only one.
void keep_off(int core) noexcept;

}  // namespace ligature::platform
