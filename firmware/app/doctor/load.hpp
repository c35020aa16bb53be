#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

namespace ligature::app {

/// Keeps the machine busy while something is measured: four processes with normal priority that copy memory (64 MB),
/// write to the disk (a nameless file of 32 MB in /var/tmp), compute, and send packets on the loopback interface of a
/// separate network namespace. Each process ends after `seconds`, or when this process ends. Construct a Load before
/// the program requests real-time priority or starts threads.
class Load {
 public:
  explicit Load(double seconds);
  ~Load();
  Load(const Load&) = delete;
  Load& operator=(const Load&) = delete;

  /// The kinds of load that were started; a kind that could not be started has the reason after its name.
  [[nodiscard]] const std::vector<std::string>& kinds() const { return kinds_; }
  /// Number of the processes that still run.
  [[nodiscard]] int running();

 private:
  std::vector<pid_t> processes_;
  std::vector<std::string> kinds_;
};

}  // namespace ligature::app
