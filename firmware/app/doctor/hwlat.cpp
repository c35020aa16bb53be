#include "firmware/app/doctor/hwlat.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string_view>
#include <thread>

#include "firmware/app/doctor/file_text.hpp"

namespace ligature::app {
namespace {

bool put(const std::string& path, const char* word) {
  std::ofstream file(path);
  file << word << std::flush;
  return file.good();
}

bool has_word(const std::string& text, const std::string& word) {
  std::istringstream words(text);
  for (std::string each; words >> each;)
    if (each == word) return true;
  return false;
}

std::chrono::steady_clock::duration to_clock(double seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

std::optional<double> longest_gap_us(const std::string& trace) {
  constexpr std::string_view kMark = "inner/outer(us):";
  std::optional<double> longest;
  for (auto at = trace.find(kMark); at != std::string::npos; at = trace.find(kMark, at + 1)) {
    const char* const first = trace.c_str() + at + kMark.size();
    char *slash = nullptr, *end = nullptr;
    const double inner = std::strtod(first, &slash);
    if (slash == first || *slash != '/') continue;
    const double outer = std::strtod(slash + 1, &end);
    if (end != slash + 1) longest = std::max({longest.value_or(0.0), inner, outer});
  }
  return longest;
}

std::string look_for_gaps(const std::string& folder, double seconds, const std::atomic<bool>& stop) {
  if (!has_word(file_text(folder + "/available_tracers"), "hwlat"))
    return "not looked for: this kernel has no tracer hwlat, or the user may not read its files";
  if (!has_word(file_text(folder + "/current_tracer"), "nop")) return "not looked for: another tracer is in use";
  if (!put(folder + "/tracing_on", "1") || !put(folder + "/current_tracer", "hwlat"))
    return "not looked for: the user may not start the tracer hwlat";
  const auto begin = std::chrono::steady_clock::now(), end = begin + to_clock(seconds);
  while (!stop && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::min(to_clock(0.1), end - std::chrono::steady_clock::now()));
  const double lasted_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const auto longest = longest_gap_us(file_text(folder + "/trace"));
  put(folder + "/current_tracer", "nop");
  char text[96];
  if (!longest)
    std::snprintf(text, sizeof text, "none above 10 us in %.0f s (tracer hwlat)", lasted_s);
  else
    std::snprintf(text, sizeof text, "gaps of up to %.0f us in %.0f s (tracer hwlat)", *longest, lasted_s);
  return text;
}

}  // namespace ligature::app
