#include "python/src/looks.hpp"

#include <nanobind/stl/array.h>

namespace ligature::python {
namespace {

const char* name(physics::Degradation degradation) {
  constexpr const char* kNames[] = {"none", "iterations", "contacts", "motion"};
  return kNames[static_cast<std::size_t>(degradation)];
}

const char* name(physics::Propagation condition) {
  constexpr const char* kNames[] = {"none", "A", "B", "C"};
  return kNames[static_cast<std::size_t>(condition)];
}

template <class T>
View<T, nb::ndim<1>> one_row(std::vector<T> values) {
  const std::size_t n = values.size();
  return View<T, nb::ndim<1>>(array_of(std::move(values), {n}));
}

void bind_hand(nb::module_& module) {
  using physics::HandContact;
  nb::class_<HandContact>(module, "Hand", "What a hand held in the last tick, and the force on it.")
      .def_ro("node", &HandContact::node,
              "The held node that is nearest to the middle of the jaws; -1 if the hand holds nothing.")
      .def_prop_ro(
          "p_W_m", [](const HandContact& h) { return plain(h.p_WG); },
          "Position of the thread at the middle of the jaws, m.")
      .def_prop_ro(
          "v_W_m_per_s", [](const HandContact& h) { return plain(h.v_WG); }, "Its velocity, m/s.")
      .def_prop_ro(
          "f_W_N", [](const HandContact& h) { return plain(h.f_W); },
          "Force on the hand in the simulated world, N: before hands.force_scale and the limits of a device.")
      .def_prop_ro(
          "condition", [](const HandContact& h) { return name(h.condition); },
          "Condition A, B or C of the paper's force propagation (docs/physics.md), or 'none'.");
}

}  // namespace

Floats tension_N(const physics::Simulation& simulation) {
  std::vector<float> values(simulation.nodes_W().size());
  simulation.describe(values, {});
  return one_row(std::move(values));
}

Floats turn_rad(const physics::Simulation& simulation) {
  std::vector<float> values(simulation.nodes_W().size());
  simulation.describe({}, values);
  return one_row(std::move(values));
}

Reals curvature_per_m(const physics::Simulation& simulation) {
  const auto p = simulation.nodes_W();
  std::vector<double> values(p.size());
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    const physics::Vec3 before = p[i] - p[i - 1], after = p[i + 1] - p[i], across = p[i + 1] - p[i - 1];
    // curvature of the circle through three points: 4 area / product
    const double product = before.norm() * after.norm() * across.norm();
    values[i] = product > 0.0 ? 2.0 * before.cross(after).norm() / product : 0.0;
  }
  return one_row(std::move(values));
}

nb::tuple contacts(const physics::Simulation& simulation) {
  std::vector<physics::ContactPoint> points(physics::Simulation::kMostContacts);
  points.resize(simulation.contacts(points));
  std::vector<std::int64_t> pairs;
  std::vector<double> places, normals, forces, gaps;
  for (const auto& c : points) {
    pairs.insert(pairs.end(), {c.segment, c.other});
    places.insert(places.end(), c.p_W.data(), c.p_W.data() + 3);
    normals.insert(normals.end(), c.normal_W.data(), c.normal_W.data() + 3);
    forces.insert(forces.end(), c.f_W.data(), c.f_W.data() + 3);
    gaps.push_back(c.gap_m);
  }
  const std::size_t k = points.size();
  return nb::make_tuple(array_of(std::move(pairs), {k, 2}), array_of(std::move(places), {k, 3}),
                        array_of(std::move(normals), {k, 3}), array_of(std::move(forces), {k, 3}),
                        array_of(std::move(gaps), {k}));
}

void bind_looks(nb::module_& module) {
  bind_hand(module);
  using physics::Diagnostics;
  nb::class_<Diagnostics>(module, "Diagnostics",
                          "Numbers about the last tick: energies, contacts, work, and whether the state is finite.")
      .def_ro("kinetic_J", &Diagnostics::kinetic_J, "Kinetic energy, J.")
      .def_ro("potential_J", &Diagnostics::potential_J,
              "Energy of weight (zero at z = 0), stretch, bending, twist and compressed contacts, J.")
      .def_ro("max_stretch", &Diagnostics::max_stretch, "Largest strain of a segment: length / rest length - 1.")
      .def_ro("min_gap_m", &Diagnostics::min_gap_m,
              "Smallest gap between the surfaces of two strands, m; negative if they overlap, inf if none are near.")
      .def_ro("contacts", &Diagnostics::contacts, "Number of contacts that carried an impulse in the last step.")
      .def_ro("contact_cap_hit", &Diagnostics::contact_cap_hit,
              "True if contacts were left out, because there was no room or no work left for them.")
      .def_prop_ro(
          "degradation", [](const Diagnostics& d) { return name(d.degradation); },
          "What the tick left out because its work is limited: 'none', 'iterations', 'contacts', 'motion'.")
      .def_ro("time_lost", &Diagnostics::time_lost, "Share of the tick in which the thread was not moved.")
      .def_ro("work", &Diagnostics::work,
              "Work on contact in this tick, in instructions (sum of prices); 0 for models without a limit.")
      .def_ro("finite", &Diagnostics::finite,
              "False if a value was not finite: the state stays the last finite one, with open hands and no force.")
      .def_ro(
          "bad_node", &Diagnostics::bad_node,
          "Index of the first node whose position was not a finite number. -1 if there was none, or if a value of a "
          "tool was not finite.")
      .def_ro("bad_tick", &Diagnostics::bad_tick, "Tick in which that happened; -1 if it did not.");
}

}  // namespace ligature::python
