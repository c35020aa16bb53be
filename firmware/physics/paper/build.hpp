#pragma once

#include <string>
#include <variant>

#include "firmware/physics/paper/contact.hpp"
#include "firmware/physics/paper/grasp.hpp"
#include "firmware/physics/paper/thread.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::physics {

/// A thread built from a scene: constants and initial shape.
struct BuiltThread {
  ThreadModel model;
  ThreadState initial;
};

/// Builds a thread of one of the paper's models. Without reference_nodes, the values of the paper's Table I apply to
/// each node. With reference_nodes N0, they are converted to properties per length of the thread (length L, mass m per
/// node, stiffness k_l stretch and k_ts bend, damping k_d, k_td and k_sw of stretch, bend and swivel)
///   density m N0 / L,  EA = k_l,  EI = k_ts l0 / pi,  damping: stretch k_d l0, bend k_td l0, swivel k_sw l0^2
/// with l0 = L / (N0 - 1), and from these to constants for `nodes` nodes.
/// @return the thread, or why the scene cannot be simulated. Allocates; not for the real-time loop.
[[nodiscard]] std::variant<BuiltThread, std::string> build_thread(const scene::Scene& scene);

[[nodiscard]] ContactSettings build_contact(const scene::Scene& scene, const ThreadModel& model);

}  // namespace ligature::physics
