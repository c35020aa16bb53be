#pragma once
// A point of the map of cost against error: a model and how finely it is computed.

#include <string>
#include <vector>

#include "protocol/scene/scene.hpp"

namespace ligature::lab {

struct Setting {
  scene::Model model = scene::Model::kRod;
  int nodes = 154;
  int substeps = 16;     ///< of a 1 ms tick
  int passes = 0;        ///< of the rod's contact solver, most and on average; 0: as the preset has them
  std::string preset{};  ///< "fast", "balanced", "fine": the scene key `accuracy` as it is; empty: substeps and passes

  /// "rod/154/16/40" or "rod/154/fine": what --one takes and the table names.
  [[nodiscard]] std::string text() const;
};

/// @throws Refusal when the text is none of Setting::text().
[[nodiscard]] Setting setting_of(const std::string& text);

/// Every model, N = 20 .. 500, substeps (an explicit model's: what its stability limit asks for, and twice) and
/// passes. @param quick about a sixth of them.
[[nodiscard]] std::vector<Setting> all_settings(bool quick);

/// The one that others are measured against.
[[nodiscard]] Setting finest(scene::Model model);

}  // namespace ligature::lab
