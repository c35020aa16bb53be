#include "tests/realtime/watch.hpp"

#include <dlfcn.h>
#include <pthread.h>

#include <cstdlib>

namespace ligature::watch {

thread_local bool watching = false;
std::atomic<long> allocations{0}, locks{0};

}  // namespace ligature::watch

#ifndef LIGATURE_SANITIZED

namespace {

using ligature::watch::watching;

void count(std::atomic<long>& what) noexcept {
  if (watching) what.fetch_add(1, std::memory_order_relaxed);
}
void count_allocation() noexcept { count(ligature::watch::allocations); }

using Lock = int(pthread_mutex_t*);
/// libc's pthread_mutex_lock; resolved before any thread is watched.
Lock* next_lock() noexcept {
  static Lock* const next = reinterpret_cast<Lock*>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  return next;
}
Lock* next_trylock() noexcept {
  static Lock* const next = reinterpret_cast<Lock*>(dlsym(RTLD_NEXT, "pthread_mutex_trylock"));
  return next;
}
[[maybe_unused]] const bool kLookedUp = next_lock() != nullptr && next_trylock() != nullptr;

}  // namespace

extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier): names of glibc
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
// NOLINTEND(bugprone-reserved-identifier)

// All heap allocation ends in one of these functions, operator new included.
void* malloc(std::size_t n) {
  count_allocation();
  return __libc_malloc(n);
}
void* calloc(std::size_t n, std::size_t size) {
  count_allocation();
  return __libc_calloc(n, size);
}
void* realloc(void* p, std::size_t n) {
  count_allocation();
  return __libc_realloc(p, n);
}
void* aligned_alloc(std::size_t alignment, std::size_t n) {
  count_allocation();
  return __libc_memalign(alignment, n);
}
int posix_memalign(void** p, std::size_t alignment, std::size_t n) {
  count_allocation();
  *p = __libc_memalign(alignment, n);
  return *p == nullptr ? 12 : 0;
}
void free(void* p) {
  if (p != nullptr) count_allocation();  // freeing is an allocator call, too
  __libc_free(p);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) {
  count(ligature::watch::locks);
  return next_lock()(mutex);
}
int pthread_mutex_trylock(pthread_mutex_t* mutex) {
  count(ligature::watch::locks);
  return next_trylock()(mutex);
}
}

#endif
