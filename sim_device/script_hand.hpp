#pragma once
// The hand that plays a script, in the way that the script's `motion` asks for.

#include <memory>
#include <string>
#include <variant>

#include "protocol/scene/gripper_script.hpp"
#include "sim_device/intention.hpp"
#include "sim_device/workspace_map.hpp"

namespace ligature::sim {

/// @param hand 0 left, 1 right;  @return or why not: a key, by its time, that the device cannot reach.
[[nodiscard]] std::variant<std::unique_ptr<Intention>, std::string> script_hand(const scene::GripperScript& script,
                                                                                std::size_t hand,
                                                                                const WorkspaceMap& map);

/// Why the device cannot be at a key; empty when it can.
[[nodiscard]] std::string objection_to(const scene::GripKey& key, const WorkspaceMap& map);

}  // namespace ligature::sim
