#pragma once
// Counts allocator calls and mutex locks of the watched thread, through functions that replace libc's by name.

#include <atomic>

#include "firmware/platform/sanitized.hpp"

namespace ligature::watch {

#ifdef LIGATURE_SANITIZED
inline constexpr bool kCounts = false;  // a sanitizer itself replaces malloc and the mutex functions
#else
inline constexpr bool kCounts = true;
#endif

extern thread_local bool watching;     ///< whether the calling thread is watched; a signal handler may set it
extern std::atomic<long> allocations;  ///< calls of malloc and free; throwing an exception allocates, too
extern std::atomic<long> locks;        ///< mutexes locked or tried, uncontended ones included

}  // namespace ligature::watch
