// Linked into every program and test. Prints which required CPU features this machine lacks; otherwise the program
// would end with SIGILL at the first unsupported instruction. Compiled for the x86-64 baseline, and run before all
// other constructors.

#if defined(__x86_64__) && LIGATURE_X86_64_LEVEL >= 2
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdio>

namespace {

#define LACKS(feature) (__builtin_cpu_supports(feature) ? "" : " " feature)

__attribute__((constructor(101))) void check_cpu() {
  __builtin_cpu_init();
  char lacks[128];
#if LIGATURE_X86_64_LEVEL == 3
  const int n =
      std::snprintf(lacks, sizeof lacks, "%s%s%s%s", LACKS("avx"), LACKS("avx2"), LACKS("fma"), LACKS("bmi2"));
  constexpr char kRemedy[] = "cmake --preset rig-v2 makes a build for every x86-64 since 2009";
#else
  const int n = std::snprintf(lacks, sizeof lacks, "%s%s%s", LACKS("ssse3"), LACKS("sse4.2"), LACKS("popcnt"));
  constexpr char kRemedy[] = "LIGATURE_ARCH=x86-64 makes a build for every x86-64";
#endif
  if (n == 0) return;
  char text[384];
  const int length =
      std::snprintf(text, sizeof text, "%s: this CPU lacks%s, and this build is for x86-64-v%d; remedy: %s\n",
                    program_invocation_short_name, lacks, LIGATURE_X86_64_LEVEL, kRemedy);
  const auto told = write(STDERR_FILENO, text, static_cast<std::size_t>(length));
  static_cast<void>(told);
  _exit(3);
}

}  // namespace
#endif
