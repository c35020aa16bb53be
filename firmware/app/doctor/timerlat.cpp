#include "firmware/app/doctor/timerlat.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <vector>

#include "firmware/app/doctor/file_text.hpp"

namespace ligature::app {
namespace {

constexpr std::size_t kMostNames = 3;

/// A folder of its own, removed at the end: rtla writes its trace into the current folder.
struct TemporaryFolder {
  TemporaryFolder() : path("/tmp/ligature-rtla-XXXXXX") {
    if (mkdtemp(path.data()) == nullptr) path.clear();
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path.empty()) std::filesystem::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string path;
};

std::string us(double ns) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f us", 1e-3 * ns);
  return text;
}

/// Reads the trace line by line. Its last wake-up is the late one, with which the tracer stopped.
class TraceReader {
 public:
  void take(const std::string& line) {
    static const std::regex wake_up(R"(\s(\d+\.\d+): #\d+\s+context\s+(irq|thread)\s+timer_latency\s+(\d+) ns)");
    static const std::regex noise(R"(: (irq|nmi|softirq|thread)_noise:\s+(.*?)\s*start (\d+\.\d+) duration (\d+) ns)");
    static const std::regex function(R"(^ => (\S+))");
    std::smatch m;
    if (std::regex_search(line, m, wake_up)) {
      at_s_ = std::stod(m[1]);
      late_ns_ = std::stod(m[3]);
      has_woken_ = m[2] == "thread";
      if (!has_woken_) interrupt_ns_ = late_ns_;
    } else if (std::regex_search(line, m, noise)) {
      const std::string kind = m[1] == "irq" ? "interrupt" : m[1] == "nmi" ? "non-maskable interrupt" : m[1].str();
      const double duration_ns = std::stod(m[4]);
      noises_.push_back(
          {kind + (m[2].length() > 0 ? " " + m[2].str() : ""), std::stod(m[3]) + 1e-9 * duration_ns, duration_ns});
    } else if (line.find("<stack trace>") != std::string::npos) {
      interrupted_.clear();
      is_below_interrupt_ = false;
    } else if (std::regex_search(line, m, function) && interrupted_.empty()) {
      const std::string name = m[1];
      const bool is_of_interrupt = name.find("irq") != std::string::npos || name.find("interrupt") != std::string::npos;
      if (is_below_interrupt_ && !is_of_interrupt && name.find("hrtimer") == std::string::npos) interrupted_ = name;
      is_below_interrupt_ = is_below_interrupt_ || is_of_interrupt;
    }
  }

  [[nodiscard]] std::string text() const {
    if (late_ns_ < 0.0) return {};
    std::string text = us(late_ns_) + " late, the timer's interrupt " + us(interrupt_ns_);
    if (!has_woken_) text += ", the thread not yet awake";
    if (interrupt_ns_ > 0.5 * late_ns_ && !interrupted_.empty()) text += " (it interrupted " + interrupted_ + ")";
    for (const auto& [name, ns] : longest()) text += "; " + name + " took " + us(ns);
    return text;
  }

 private:
  struct Noise {
    std::string name;
    double end_s = 0.0, duration_ns = 0.0;
  };

  /// The names that took longest, among the noises that ended within the delay.
  [[nodiscard]] std::vector<std::pair<std::string, double>> longest() const {
    constexpr double kRounding_s = 1e-6;  // of the times in the trace
    std::map<std::string, double> by_name;
    for (const Noise& n : noises_)
      if (n.end_s >= at_s_ - 1e-9 * late_ns_ && n.end_s <= at_s_ + kRounding_s) by_name[n.name] += n.duration_ns;
    std::vector<std::pair<std::string, double>> all(by_name.begin(), by_name.end());
    std::ranges::sort(all, std::greater{}, &std::pair<std::string, double>::second);
    if (all.size() > kMostNames) all.resize(kMostNames);
    return all;
  }

  std::vector<Noise> noises_;
  double at_s_ = 0.0, late_ns_ = -1.0, interrupt_ns_ = 0.0;
  bool has_woken_ = false, is_below_interrupt_ = false;
  std::string interrupted_;  // what ran when the timer's interrupt came
};

}  // namespace

std::string delayed_by(const std::string& trace) {
  TraceReader reader;
  std::istringstream lines(trace);
  for (std::string line; std::getline(lines, line);) reader.take(line);
  return reader.text();
}

std::string look_for_culprit(int core, int priority, double least_us, double seconds) {
  const TemporaryFolder folder;
  char command[256];
  std::snprintf(command, sizeof command,
                "cd '%s' && rtla timerlat top -q -c %d -P f:%d -a %.0f -d %.0fs > rtla.log 2>&1 < /dev/null",
                folder.path.c_str(), core, priority, std::max(1.0, least_us), std::max(1.0, seconds));
  // NOLINTNEXTLINE(bugprone-command-processor): the text is ours
  const int status = folder.path.empty() ? -1 : std::system(command);
  if (status == -1) return "not looked for: no folder for the trace in /tmp";
  // Before the exit code: newer versions of rtla end with 2 after a late wake-up
  std::string found = delayed_by(file_text(folder.path + "/timerlat_trace.txt"));
  if (!found.empty()) return found;
  constexpr int kNotFound = 127;
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNotFound) return "not looked for: no program rtla";
  if (status != 0) return "not looked for: rtla ended with an error; it needs root and the kernel's tracer timerlat";
  char text[96];
  std::snprintf(text, sizeof text, "no wake-up was late by %.0f us in %.0f s", least_us, seconds);
  return text;
}

}  // namespace ligature::app
