#pragma once
// Tries several things from one state: fork() copies the process, and each copy goes on by itself until it tells one
// result. The process must have one thread only.

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <type_traits>

namespace ligature::test {

template <class Result>
class ProcessCopy {
  static_assert(std::is_trivially_copyable_v<Result>);

 public:
  /// Copies the process. @return in the original, after the copy has ended: its result. In the copy: nothing; it must
  /// end by tell(). @throws std::runtime_error if no copy can be made, or it ended without a result.
  std::optional<Result> branch() {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    std::fflush(nullptr);  // else the copy would print it, too
    const pid_t copy = fork();
    if (copy < 0) throw std::runtime_error("no copy of the process");
    if (copy == 0) {
      close(ends[0]);
      tells_to_ = ends[1];
      return std::nullopt;
    }
    close(ends[1]);
    Result result;
    const bool told = read(ends[0], &result, sizeof result) == static_cast<ssize_t>(sizeof result);
    close(ends[0]);
    int status = 0;
    while (waitpid(copy, &status, 0) < 0 && errno == EINTR) continue;
    if (!told || status != 0) throw std::runtime_error("a copy of the process ended without a result");
    return result;
  }

  [[nodiscard]] bool is_copy() const noexcept { return tells_to_ >= 0; }
  /// Ends the copy.
  [[noreturn]] void tell(const Result& result) const noexcept {
    const bool told = write(tells_to_, &result, sizeof result) == static_cast<ssize_t>(sizeof result);
    _exit(told ? 0 : 1);
  }

 private:
  int tells_to_ = -1;
};

}  // namespace ligature::test
