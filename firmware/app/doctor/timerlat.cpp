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

std::string content(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::string us(double ns) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f us", 1e-3 * ns);
  return text;
}

}  // namespace

std::string delayed_by(const std::string& trace) {
  static const std::regex wake_up(R"(\s(\d+\.\d+): #\d+\s+context\s+(irq|thread)\s+timer_latency\s+(\d+) ns)");
  static const std::regex noise(R"(: (irq|nmi|softirq|thread)_noise:\s+(.*?)\s*start (\d+\.\d+) duration (\d+) ns)");
  struct Noise {
    std::string name;
    double end_s = 0.0, duration_ns = 0.0;
  };
  std::vector<Noise> noises;
  double at_s = 0.0, late_ns = -1.0, interrupt_ns = 0.0;
  std::istringstream lines(trace);
  std::smatch m;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_search(line, m, wake_up)) {
      const double latency_ns = std::stod(m[3]);
      if (m[2] == "irq") {
        interrupt_ns = latency_ns;
      } else {
        at_s = std::stod(m[1]);
        late_ns = latency_ns;
      }
    } else if (std::regex_search(line, m, noise)) {
      const double duration_ns = std::stod(m[4]);
      const std::string kind = m[1] == "irq" ? "interrupt" : m[1] == "nmi" ? "non-maskable interrupt" : m[1].str();
      noises.push_back(
          {kind + (m[2].length() > 0 ? " " + m[2].str() : ""), std::stod(m[3]) + 1e-9 * duration_ns, duration_ns});
    }
  }
  if (late_ns < 0.0) return {};
  std::map<std::string, double> by_name;
  constexpr double kRounding_s = 1e-6;  // of the times in the trace
  for (const Noise& n : noises)
    if (n.end_s >= at_s - 1e-9 * late_ns && n.end_s <= at_s + kRounding_s) by_name[n.name] += n.duration_ns;
  std::vector<std::pair<std::string, double>> longest(by_name.begin(), by_name.end());
  std::ranges::sort(longest, std::greater{}, &std::pair<std::string, double>::second);
  if (longest.size() > kMostNames) longest.resize(kMostNames);
  std::string text = us(late_ns) + " late, the timer's interrupt " + us(interrupt_ns);
  for (const auto& [name, ns] : longest) text += "; " + name + " took " + us(ns);
  return text;
}

std::string look_for_culprit(int core, double least_us, double seconds) {
  const TemporaryFolder folder;
  char command[256];
  std::snprintf(command, sizeof command,
                "cd '%s' && rtla timerlat top -q -c %d -a %.0f -d %.0fs > rtla.log 2>&1 < /dev/null",
                folder.path.c_str(), core, std::max(1.0, least_us), std::max(1.0, seconds));
  // NOLINTNEXTLINE(bugprone-command-processor): the text is ours
  const int status = folder.path.empty() ? -1 : std::system(command);
  if (status == -1) return "not looked for: no folder for the trace in /tmp";
  constexpr int kNotFound = 127;
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNotFound) return "not looked for: no program rtla";
  if (status != 0) return "not looked for: rtla ended with an error; it needs root and the kernel's tracer timerlat";
  const std::string found = delayed_by(content(folder.path + "/timerlat_trace.txt"));
  if (!found.empty()) return found;
  char text[96];
  std::snprintf(text, sizeof text, "no wake-up was late by %.0f us in %.0f s", least_us, seconds);
  return text;
}

}  // namespace ligature::app
