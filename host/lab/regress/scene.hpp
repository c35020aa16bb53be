#pragma once
// Regression scenes: small fixed runs. Their figures show which results a change to the physics has moved.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "protocol/scene/scene.hpp"

namespace ligature::regress {

/// One number of a scene. What it should be stands in expected.csv.
struct Figure {
  std::string name;  ///< with the unit in brackets
  double value = 0.0;
  double tolerance = 0.0;  ///< in the unit of the value; used only when the figure is new in expected.csv
};
using Figures = std::vector<Figure>;

/// What a scene needs beside its own code.
struct Bench {
  std::filesystem::path scenes;  ///< folder of the shipped scenes
};

struct RegressScene {
  const char* name;
  const char* about;
  bool cheap;  ///< takes less than about a second
  Figures (*measure)(const Bench&);
};

/// All scenes: one for each knot, each part of the world and the thread, and each model.
[[nodiscard]] std::span<const RegressScene> all_scenes();

// Knots: a shipped loose knot is drawn tight at several speeds and held. Mean figures.
Figures overhand(const Bench&);
Figures figure_eight(const Bench&);
Figures square(const Bench&);
Figures granny(const Bench&);
Figures surgeons(const Bench&);

// Parts of the world and of the thread.
Figures desk(const Bench&);
Figures static_friction(const Bench&);
Figures peg(const Bench&);
Figures drum(const Bench&);
Figures gripper(const Bench&);
Figures clamp_and_load(const Bench&);
Figures jaws(const Bench&);
Figures frame(const Bench&);
Figures curl(const Bench&);
Figures set_bends(const Bench&);

// Models: a swing of each, and the paper's overhand.
Figures paper_overhand(const Bench&);
template <scene::Model M>
Figures swing(const Bench&);
template <scene::Accuracy A>
Figures rod_swing(const Bench&);

}  // namespace ligature::regress
