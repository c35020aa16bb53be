#pragma once
// The keys of scene files and fault scripts, as their readers list them. A test compares docs/scene.md with these
// lists.

#include <string>
#include <vector>

#include "protocol/scene/scene.hpp"

namespace ligature::scene {

/// One key, as its reader takes it.
struct KeyRow {
  std::string key;      ///< dotted; `[]` stands for the index of an array: "world.fixed[].node"
  std::string allowed;  ///< as in messages: "integer 2 .. 5000"; "a table" for a table
  std::string
      standard;  ///< the default as TOML writes it; "none" if the key has no default, "required" if it must be present
  std::string owner;  ///< "with suture.model \"rod\"" if other models refuse the key; else empty
};

/// All keys of scene files, with the defaults that a scene with this model has.
[[nodiscard]] std::vector<KeyRow> scene_keys(Model model);

/// All keys of fault scripts.
[[nodiscard]] std::vector<KeyRow> fault_keys();

}  // namespace ligature::scene
