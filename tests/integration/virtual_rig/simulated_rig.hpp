#pragma once
// The virtual rig as tests use it: armed, with the scene's own hands, playing a script.

#include "host/lab/rig/virtual_rig.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature {

using lab::DeviceBus;

struct SimulatedRig : lab::VirtualRig {
  SimulatedRig(const scene::Scene& scene, const scene::GripperScript& script)
      : VirtualRig(lab::RigSetup{.scene = scene}, script) {}
};

}  // namespace ligature
