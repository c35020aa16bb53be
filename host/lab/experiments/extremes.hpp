#pragma once
// One trial of `extremes`: a scene, a script, so many ticks; finite, or stopped in time and named.

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "host/lab/rehearsal.hpp"
#include "host/lab/report.hpp"

namespace ligature::lab {

/// How a trial ended.
struct Ending {
  std::string word;  ///< "finite", "stopped", "refused", or "LEAKED": a non-finite number got out
  double tick = 0.0;
  double node = 0.0;  ///< -1: none, or a hand was
  std::string cause;
  bool by_hand = false;  ///< stopped by where the script had a hand, before it reached the thread
};

[[nodiscard]] Ending trial(const scene::Scene& scene, const scene::GripperScript& script, int ticks);

/// A parameter and how a factor acts on it.
struct Dial {
  const char* name;
  int low, high;  ///< decades
  std::function<void(scene::Scene&, double)> turn;
};

/// An odd scene by name, with how it ended.
using OddEndings = std::vector<std::pair<std::string, Ending>>;

/// Tables and counts of one model's map.
struct ExtremesMap {
  Table map{{"parameter", "factor", "step_s", "ending", "tick", "node", "likely_cause"}};
  Table odd{{"case", "ending", "tick", "node", "likely_cause"}};
  int trials = 0, finite = 0, refused = 0, leaked = 0, unnamed = 0;
  bool as_shipped = false;  ///< finite with every factor 1 at 1 ms

  void add(const char* parameter, double factor, double step_s, const Ending& e);
  void add(const std::string& odd_case, const Ending& e);

 private:
  void count(const Ending& e);
};

/// The rod's map: scenes/suture-3-0.toml and suture-3-0-knot.toml, every dial over its decades at six steps, odd
/// scenes.
[[nodiscard]] ExtremesMap rod_extremes(const std::filesystem::path& scenes);

}  // namespace ligature::lab
