#pragma once
// What a machine must grant for a real-time thread, asked for item by item.

#include <string>
#include <vector>

namespace ligature::platform {

/// One line for each thing that was refused, naming it, the cause and the remedy; empty: all granted.
using Refusals = std::vector<std::string>;

/// For the whole process, before the loop starts: locks present and future pages into memory, those of its files as
/// copies, keeps freed heap from
/// going back to the system, and touches a heap reserve, so that no page fault waits in the loop.
[[nodiscard]] Refusals lock_memory();

inline constexpr int kLoopPriority = 80;     ///< above threaded interrupts (50), below the kernel's own (99)
inline constexpr int kPhysicsPriority = 70;  ///< whatever the loop has to do goes before

/// For the calling thread: pinned to `core`, SCHED_FIFO, stack touched, exact timers.
[[nodiscard]] Refusals make_realtime(int core, int priority = kLoopPriority);

/// For the calling thread, granted always: denormals are zero. A thread at rest decays into them, and
/// each costs a hundred cycles; a force below 1e-308 N is nobody's.
void flush_denormals() noexcept;

/// For the calling thread: that core and no other. @return false when it is not allowed there.
bool stay_on(int core) noexcept;

/// The isolated core, or else the last one this process may use: interrupts and other work gather on the first.
/// @param isolated  the kernel's list of isolated cores
[[nodiscard]] int realtime_core(const char* isolated = "/sys/devices/system/cpu/isolated");

/// For the calling thread (and those it starts): every allowed core but that one; no change when it is the only one.
void keep_off(int core) noexcept;

}  // namespace ligature::platform
