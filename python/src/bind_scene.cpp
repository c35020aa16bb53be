// Binds Scene, Script and Tool: the inputs of a simulation.

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <numbers>

#include "host/lab/script_tools.hpp"
#include "protocol/scene/recorded_scene.hpp"
#include "protocol/scene/scene_file.hpp"
#include "python/src/arrays.hpp"
#include "python/src/bindings.hpp"
#include "python/src/float_mode.hpp"
#include "python/src/inputs.hpp"
#include "python/src/or_refuse.hpp"

namespace ligature::python {
namespace {

constexpr double kMost = 1e6;  // limit of values in s, m and degrees, as for script files

/// Adds the keys of one hand from rows of time, x, y, z, grip, and optionally three rotation angles.
void add_keys(scene::GripperScript& script, int hand, const Numbers& array) {
  const char* name = hand == 0 ? "left" : "right";
  if (array.size() == 0) return;
  const bool turns = array.ndim() == 2 && array.shape(1) == 8;
  const std::size_t columns = turns ? 8 : 5;
  script.turns = script.turns || turns;
  const auto values = rows_of(array, name, columns, kMost);
  auto& keys = script.keys[hand];
  for (std::size_t i = 0; i < values.size(); i += columns) {
    const double* v = &values[i];
    const auto refuse = [&](const char* column, double found, const char* allowed) {
      char text[160];
      std::snprintf(text, sizeof text, "%s: row %zu, column '%s': found %g, allowed %s", name, i / columns, column,
                    found, allowed);
      throw lab::Refusal(text);
    };
    if (v[0] < 0.0) refuse("time", v[0], "0 .. 1e6");
    if (v[4] != 0.0 && v[4] != 1.0) refuse("grip", v[4], "0 or 1");
    if (!keys.empty() && v[0] <= keys.back().time_s) refuse("time", v[0], "later than the row before it");
    scene::GripKey key{v[0], {v[1], v[2], v[3]}, v[4] == 1.0, {}};
    if (turns) key.turn_deg = {v[5], v[6], v[7]};
    keys.push_back(key);
  }
}

void make_scene(Scene* at, const std::string& path, const std::vector<std::string>& overrides,
                const std::optional<std::string>& text, bool recorded) {
  const DefaultFloats floats;
  auto read = !text      ? scene::load_scene(path, overrides)
              : recorded ? scene::parse_recorded(*text, path, overrides)
                         : scene::parse_scene(*text, path, overrides);
  new (at) Scene{or_refuse(std::move(read)), path};
}

void make_tool(physics::ToolInput* at, const std::array<double, 3>& p_W_m, const std::array<double, 3>& v_W_m_per_s,
               bool grip, const std::optional<std::array<double, 3>>& turn_deg) {
  new (at) physics::ToolInput{physics::Vec3(p_W_m.data()), physics::Vec3(v_W_m_per_s.data()), grip, {}};
  if (!turn_deg) return;
  const DefaultFloats floats;
  const physics::Vec3 turn = physics::Vec3(turn_deg->data()) * (std::numbers::pi / 180.0);
  at->R_WT = Eigen::AngleAxisd(turn.norm(), turn.stableNormalized());
}

}  // namespace

void bind_scene(nb::module_& module) {
  nb::class_<Scene>(module, "Scene", "A scene file, read and checked: see Scene.load.")
      .def("__init__", &make_scene, nb::arg("path"), nb::arg("overrides"), nb::arg("text") = nb::none(),
           nb::arg("recorded") = false)
      .def_prop_ro(
          "path", [](const Scene& s) { return text_of(s.path); }, "Name of the scene in messages.")
      .def_prop_ro(
          "model", [](const Scene& s) { return scene::name(s.scene.suture.model); }, "'paper-1' .. 'paper-5' or 'rod'.")
      .def_prop_ro(
          "nodes", [](const Scene& s) { return s.scene.suture.nodes; }, "Nodes of the thread.")
      .def_prop_ro(
          "length_m", [](const Scene& s) { return s.scene.suture.length_m; }, "Its length, m.")
      .def_prop_ro(
          "radius_m", [](const Scene& s) { return s.scene.suture.radius_m; }, "Its radius, m.")
      .def_prop_ro(
          "friction", [](const Scene& s) { return s.scene.contact.friction; },
          "Coulomb friction coefficient of a sliding contact.")
      .def_prop_ro(
          "tick_s", [](const Scene& s) { return s.scene.time.tick_s; }, "Simulated time of a tick, s.")
      .def_prop_ro(
          "workspace_scale", [](const Scene& s) { return s.scene.hands.workspace_scale; },
          "World metres for each metre of a device's motion.")
      .def_prop_ro(
          "workspace_origin_m", [](const Scene& s) { return s.scene.hands.workspace_origin_m; },
          "x, y, z, m: where a device's home pose is in the world.");

  nb::class_<scene::GripperScript>(module, "Script", "What two hands do over time: see Script.load, Script.of_keys.")
      .def(
          "__init__",
          [](scene::GripperScript* at, const std::optional<std::string>& path) {
            new (at) scene::GripperScript(path ? or_refuse(scene::load_gripper_script(*path)) : scene::GripperScript{});
          },
          nb::arg("path") = nb::none())
      .def("_add_keys", &add_keys, nb::arg("hand"), nb::arg("keys"))
      .def(
          "tools",
          [](const scene::GripperScript& script, double t_s) {
            const DefaultFloats floats;
            return lab::tools_at(script, t_s);
          },
          nb::arg("t_s"), "Both tools at a time of the script, s: [left, right].")
      .def_prop_ro("end_s", &scene::end_time_s, "When the last key of either hand is due, s.");

  nb::class_<physics::ToolInput>(
      module, "Tool",
      "A hand's tool for one tick.\n\n"
      "p_W_m: position in the world, m, three numbers. v_W_m_per_s: velocity, m/s. grip: jaws "
      "closed. turn_deg: rotation\nvector of the tool, degrees; None: a grip leaves the "
      "thread's direction free. Position and velocity beyond\n1e9, or no numbers, end the "
      "simulation (Diagnostics.finite).")
      .def("__init__", &make_tool, nb::arg("p_W_m"), nb::arg("v_W_m_per_s") = std::array<double, 3>{},
           nb::arg("grip") = false, nb::arg("turn_deg") = nb::none())
      .def_prop_rw(
          "p_W_m", [](const physics::ToolInput& t) { return plain(t.p_WT); },
          [](physics::ToolInput& t, const std::array<double, 3>& p) { t.p_WT = physics::Vec3(p.data()); },
          "Position, m.")
      .def_prop_rw(
          "v_W_m_per_s", [](const physics::ToolInput& t) { return plain(t.v_WT); },
          [](physics::ToolInput& t, const std::array<double, 3>& v) { t.v_WT = physics::Vec3(v.data()); },
          "Velocity, m/s.")
      .def_rw("grip", &physics::ToolInput::grip, "Are its jaws closed?");
}

}  // namespace ligature::python
