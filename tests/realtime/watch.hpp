#pragma once
// Counts what the watched thread asks of the allocator and of locks, by functions of those names put before libc's.

#include <atomic>

namespace ligature::watch {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kCounts = false;  // the sanitizer owns both
#else
inline constexpr bool kCounts = true;
#endif

extern thread_local bool watching;     ///< this thread; may be set by a signal handler
extern std::atomic<long> allocations;  ///< and ways back; an exception is one, too
extern std::atomic<long> locks;        ///< mutexes taken or tried, also those that nobody held

}  // namespace ligature::watch
