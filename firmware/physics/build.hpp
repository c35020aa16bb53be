#pragma once

#include <string>
#include <variant>

#include "firmware/physics/contact.hpp"
#include "firmware/physics/grasp.hpp"
#include "firmware/physics/thread.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::physics {

/// A thread built from a scene: constants and initial shape.
struct BuiltThread {
  ThreadModel model;
  ThreadState initial;
};

/// Per-node constants from the scene. With reference_nodes N0 the Table I values are read as properties per length,
///   density m N0 / L,  EA = k_l,  EI = k_ts l0 / pi,  stretch loss k_d l0,  bend loss k_td l0,  twist loss k_sw l0^2,
/// with l0 = L / (N0 - 1), and spread over `nodes`; without it they are per node, exactly as in the paper.
/// @return the thread, or why the scene cannot be simulated (allocates; never called in the cycle)
[[nodiscard]] std::variant<BuiltThread, std::string> build_thread(const scene::Scene& scene);

[[nodiscard]] ContactSettings build_contact(const scene::Scene& scene, const ThreadModel& model);

}  // namespace ligature::physics
