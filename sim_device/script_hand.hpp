#pragma once
// Creates the hand that plays a script, with the interpolation that the script's `motion` selects.

#include <memory>
#include <string>
#include <variant>

#include "protocol/scene/gripper_script.hpp"
#include "sim_device/intention.hpp"
#include "sim_device/workspace_map.hpp"

namespace ligature::sim {

/// @param hand 0 left, 1 right. @return the hand, or an error with the key's time if the device cannot reach a key.
[[nodiscard]] std::variant<std::unique_ptr<Intention>, std::string> script_hand(const scene::GripperScript& script,
                                                                                std::size_t hand,
                                                                                const WorkspaceMap& map);

/// Why the device cannot reach a key; empty if it can.
[[nodiscard]] std::string objection_to(const scene::GripKey& key, const WorkspaceMap& map);

}  // namespace ligature::sim
