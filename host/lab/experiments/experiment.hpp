#pragma once
// The paper's experiments: each fills a folder with a table, a picture and a verdict.

#include <filesystem>
#include <string>

#include "protocol/scene/scene.hpp"

namespace ligature::lab {

/// Where an experiment finds its scenes and puts its results.
struct Bench {
  std::filesystem::path scenes;  ///< folder with paper.toml, desk.toml and operators/
  std::filesystem::path out;     ///< made before the experiment starts
};

// Each returns kDone, or kRunFailed when a claim does not hold.
int experiment_models(const Bench& bench);
int experiment_knotting(const Bench& bench);
int experiment_pulling(const Bench& bench);
int experiment_unknotting(const Bench& bench);
int experiment_stability(const Bench& bench);
int experiment_extremes(const Bench& bench);
int experiment_cost(const Bench& bench);
int experiment_haptics(const Bench& bench);
/// @param quick the least that shows each claim, without pictures: for ctest.
int experiment_haptics(const Bench& bench, bool quick);

/// A thread of `nodes` nodes stretched out level from its fixed end, every segment at rest length.
void lay_level(scene::Scene& scene);

}  // namespace ligature::lab
