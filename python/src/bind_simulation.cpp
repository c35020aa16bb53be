// Binds Simulation.

#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include "host/knot/recognise.hpp"
#include "python/src/bindings.hpp"
#include "python/src/clock.hpp"
#include "python/src/looks.hpp"
#include "python/src/play_runs.hpp"

namespace ligature::python {
namespace {

using Self = nb::pointer_and_handle<Sim>;
using Tool = physics::ToolInput;

const Tool& tool_or_away(const Tool* tool) {
  static const Tool away{physics::Vec3(scene::kParked_W_m.data()), physics::Vec3::Zero(), false, {}};
  return tool != nullptr ? *tool : away;
}

bool tick(Sim& sim, const Tool* left, const Tool* right) {
  sim.idle().tick({tool_or_away(left), tool_or_away(right)});
  return sim.simulation().diagnostics().finite;
}

std::span<const physics::Vec3> as_points(std::span<const double> values) {
  return {reinterpret_cast<const physics::Vec3*>(values.data()), values.size() / 3};
}

void set_state(Sim& sim, const Numbers& nodes, const std::optional<Numbers>& velocities) {
  constexpr double kFar = 1e9;  // m, m/s; the physics treats larger values as divergence
  const std::size_t n = sim.idle().simulation().nodes_W().size();
  const auto same = [n](const Numbers& array, const char* name) {
    const auto points = as_points(rows_of(array, name, 3, kFar));
    if (points.size() != n)
      throw lab::Refusal(std::string(name) + ": found " + std::to_string(points.size()) + " rows, allowed " +
                         std::to_string(n));
    return points;
  };
  const auto p_W = same(nodes, "nodes");
  sim.set_state(p_W, velocities ? same(*velocities, "velocities") : std::span<const physics::Vec3>());
}

void add_motion(nb::class_<Sim>& type) {
  type.def(nb::init<const Scene&>(), nb::arg("scene"), "Builds the thread of a scene. Raises Refusal.")
      .def(
          "__init__", [](Sim* at, Sim& other) { new (at) Sim(other.idle()); }, nb::arg("other"))
      .def("tick", &tick, nb::arg("left").none() = nb::none(), nb::arg("right").none() = nb::none(),
           nb::sig("def tick(self, left: Tool | None = None, right: Tool | None = None) -> bool"),
           "Advances by scene.tick_s. left, right: the hands' tools; None: a hand that is not there.\n"
           "Returns False once the state is no number (diagnostics.finite); from then on ticks do nothing.")
      .def(
          "reset", [](Sim& s) { s.idle().reset(); }, "Back to the scene's initial state, hands open.")
      .def("_save",
           [](Sim& s) {
             const auto image = s.idle().save();
             return nb::bytes(image.data(), image.size());
           })
      .def(
          "_load",
          [](Sim& s, const nb::bytes& image) {
            s.idle().load({static_cast<const std::byte*>(image.data()), image.size()});
          },
          nb::arg("image"))
      .def("_set_state", &set_state, nb::arg("nodes"), nb::arg("velocities").none())
      .def("_run", &run_here, nb::arg("script"), nb::arg("duration_s").none(), nb::arg("shape_every_s"),
           nb::arg("start_s"))
      .def("_rollout", &run_copies, nb::arg("scripts"), nb::arg("threads"), nb::arg("duration_s").none(),
           nb::arg("shape_every_s"), nb::arg("start_s"))
      .def_prop_ro(
          "scene", [](Sim& s) { return s.scene(); }, "A copy of the scene that it was made of.")
      .def_prop_ro(
          "ticks", [](Sim& s) { return s.idle().ticks(); }, "Number of ticks since the start or the last reset.")
      .def_prop_ro(
          "time_s", [](Sim& s) { return clock_of(s.scene().scene.time.tick_s).time_s(s.idle().ticks()); },
          "Their time, s.")
      .def_prop_ro(
          "budget", [](Sim& s) { return s.idle().simulation().work(); },
          "Most work on contact in a tick, instructions; 0: the model has no budget.");
}

void add_shape(nb::class_<Sim>& type) {
  type.def_prop_ro(
          "nodes", [](const Self& s) { return points_view(s.p->idle().nodes_W(), s.h); },
          "n x 3, m, world frame (x right, y away, z up). Read-only and no copy: it shows the thread as it is "
          "after each tick.")
      .def_prop_ro(
          "velocities", [](const Self& s) { return points_view(s.p->idle().velocities_W(), s.h); },
          "n x 3, m/s; as nodes.")
      .def_prop_ro(
          "tension_N", [](Sim& s) { return tension_N(s.idle().simulation()); }, nb::rv_policy::automatic,
          "n float32, N, a new array: of the edge after each node, positive pulls; the last repeats the one "
          "before.")
      .def_prop_ro(
          "turn_rad", [](Sim& s) { return turn_rad(s.idle().simulation()); }, nb::rv_policy::automatic,
          "n float32, rad, a new array: material frame against the one carried along without twist from node "
          "0.")
      .def_prop_ro(
          "curvature_per_m", [](Sim& s) { return curvature_per_m(s.idle().simulation()); }, nb::rv_policy::automatic,
          "n, 1/m, a new array: of the circle through a node and its two neighbours; 0 at the ends.")
      .def("_contacts", [](Sim& s) { return contacts(s.idle().simulation()); })
      .def(
          "knot",
          [](Sim& s) {
            std::vector<std::array<double, 3>> line;
            for (const auto& p : s.idle().simulation().nodes_W()) line.push_back({p.x(), p.y(), p.z()});
            return knot::recognise(line, false);
          },
          "The knot in the thread: ligature.knot(self.nodes).");
}

void add_state(nb::class_<Sim>& type) {
  const auto hand = [](physics::Hand which) { return [which](Sim& s) { return s.idle().simulation().hand(which); }; };
  type.def_prop_ro("left", hand(physics::Hand::kLeft), "The left hand's hold of the thread, a copy.")
      .def_prop_ro("right", hand(physics::Hand::kRight), "The right hand's hold of the thread, a copy.")
      .def_prop_ro(
          "diagnostics", [](Sim& s) { return s.idle().simulation().diagnostics(); },
          "Diagnostics of the last tick, a copy.");
}

}  // namespace

void bind_simulation(nb::module_& module) {
  bind_looks(module);
  nb::class_<Sim> type(module, "Simulation", "A thread in its world: firmware/physics/simulation.hpp.");
  add_motion(type);
  add_shape(type);
  add_state(type);
}

}  // namespace ligature::python
