#pragma once
// The experiments of the lab. Each writes a table, a picture and a verdict to a folder.

#include <cstdint>
#include <filesystem>
#include <string>

#include "protocol/scene/scene.hpp"

namespace ligature::lab {

/// Folders and extent of an experiment.
struct Bench {
  std::filesystem::path scenes;  ///< folder with paper.toml, desk.toml and operators/
  std::filesystem::path out;     ///< created before the experiment starts
  bool quick = false;            ///< the smallest set of runs that tests each claim, without pictures: for ctest
  std::uint64_t seed = 1;        ///< of what an experiment draws at random
};

// One function per experiment. @return kDone, or kRunFailed when one of the experiment's claims does not hold.
int experiment_models(const Bench& bench);
int experiment_knotting(const Bench& bench);
int experiment_pulling(const Bench& bench);
int experiment_unknotting(const Bench& bench);
int experiment_stability(const Bench& bench);
int experiment_extremes(const Bench& bench);
int experiment_cost(const Bench& bench);
int experiment_haptics(const Bench& bench);

/// Lays the thread's `nodes` nodes in a horizontal straight line from its fixed end, every segment at rest length.
void lay_level(scene::Scene& scene);

}  // namespace ligature::lab
