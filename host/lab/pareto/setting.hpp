#pragma once
// One setting in the diagram of cost against error: a model and its numerical resolution.

#include <string>
#include <vector>

#include "protocol/scene/scene.hpp"

namespace ligature::lab {

struct Setting {
  scene::Model model = scene::Model::kRod;
  int nodes = 154;
  int substeps = 16;  ///< time steps per tick of 1 ms
  /// Largest number of passes of the rod's contact solver per substep; 0: as in the preset. From 40 on the solver also
  /// gets a tolerance of 1e-5 m/s and a budget of 4e7 instructions.
  int passes = 0;
  /// "fast", "balanced", "fine": value of the scene's key `accuracy`; empty: `substeps` and `passes` apply
  std::string preset{};

  /// "rod/154/16/40" or "rod/154/fine": argument of --one, and name in the table.
  [[nodiscard]] std::string text() const;
};

/// @throws Refusal when the text does not have the form of Setting::text(), or names what no thread can have.
[[nodiscard]] Setting setting_of(const std::string& text);

/// All settings of the diagram: every model, N = 20 .. 500, several substeps (for an explicit model the number that its
/// stability needs, and twice that) and passes. @param quick returns only about a sixth of them.
[[nodiscard]] std::vector<Setting> all_settings(bool quick);

/// The setting whose result is the reference for all others of this model.
[[nodiscard]] Setting finest(scene::Model model);

}  // namespace ligature::lab
