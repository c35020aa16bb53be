#pragma once
// LIGATURE_SANITIZED: this is a build with AddressSanitizer or ThreadSanitizer, which replace the allocator and the
// locks, cause page faults and need much memory. GCC defines macros for these builds; clang
// has __has_feature.

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LIGATURE_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define LIGATURE_SANITIZED 1
#endif
#endif
