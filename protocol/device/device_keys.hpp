#pragma once
// The keys of device records, as their reader lists them. A test compares docs/scene.md with this list.

#include <vector>

#include "protocol/scene/key_list.hpp"

namespace ligature::device {

/// Each number appears as two keys: "drives.gear.value" and "drives.gear.source".
[[nodiscard]] std::vector<scene::KeyRow> device_keys();

}  // namespace ligature::device
