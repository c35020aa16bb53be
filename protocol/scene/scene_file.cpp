#include "protocol/scene/scene_file.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "protocol/scene/cells.hpp"
#include "protocol/scene/polyline.hpp"
#include "protocol/scene/rod_keys.hpp"
#include "protocol/scene/text_file.hpp"
#include "protocol/scene/toml_text.hpp"

namespace ligature::scene {
namespace {

namespace fs = std::filesystem;

// Ranges are wide, to allow experiments with extreme sizes, but exclude values such as 1e-300 m.
constexpr double kFar_m = 1e4;           // largest allowed coordinate
constexpr Range kCoefficient{0.0, 1e9};  // allowed range of stiffness and damping
constexpr Range kEitherSign{-1e9, 1e9};  // of the two dampers whose printed sign feeds energy in
constexpr int kMostWork = 2'000'000;     // nodes x substeps: a tick takes some tenths of a second
constexpr std::size_t kMostLoads = 5000;
constexpr const char* kOfTheRod = "with suture.model \"rod\"";
constexpr const char* kOfThePaper = "with suture.model \"paper-1\" .. \"paper-5\"";

constexpr std::pair<const char*, Model> kModels[] = {{"paper-1", Model::kPaper1}, {"paper-2", Model::kPaper2},
                                                     {"paper-3", Model::kPaper3}, {"paper-4", Model::kPaper4},
                                                     {"paper-5", Model::kPaper5}, {"rod", Model::kRod}};
constexpr std::pair<const char*, ContactSolver> kSolvers[] = {
    {"none", ContactSolver::kNone}, {"paper", ContactSolver::kPaper}, {"implicit", ContactSolver::kImplicit}};
constexpr std::pair<const char*, BroadPhase> kBroadPhases[] = {{"auto", BroadPhase::kAuto},
                                                               {"brute", BroadPhase::kBrute},
                                                               {"sweep", BroadPhase::kSweep},
                                                               {"bvh", BroadPhase::kBvh}};
constexpr std::pair<const char*, SwivelDamper> kSwivels[] = {{"internal", SwivelDamper::kInternal},
                                                             {"paper", SwivelDamper::kPaper}};
constexpr std::pair<const char*, Damping> kDampings[] = {{"implicit", Damping::kImplicit},
                                                         {"explicit", Damping::kExplicit}};
constexpr std::pair<const char*, Integrator> kIntegrators[] = {{"semi-implicit", Integrator::kSemiImplicit},
                                                               {"forward", Integrator::kForward}};
constexpr std::pair<const char*, QuadraticStretch> kQuadratics[] = {{"stiff", QuadraticStretch::kStiff},
                                                                    {"printed", QuadraticStretch::kPrinted}};

/// Number of points that a start shape needs. Nodes with adaptive spacing may start anywhere, so the shape is stored
/// with a spacing of about one diameter.
int initial_points(const Suture& s) {
  if (s.model != Model::kRod || s.rod.spacing != Spacing::kAdaptive) return s.nodes;
  constexpr double kMost = 5000.0;
  return std::max(s.nodes, 1 + static_cast<int>(std::min(0.5 * s.length_m / s.radius_m, kMost)));
}

/// Refuses negative damping coefficients (the signs that the paper prints) where they make no sense: with implicit
/// damping, because the step then has no solution in general, and for the internal swivel damper, which is not in the
/// paper.
void refuse_printed_signs(StrictTable& t, const PaperParameters& p) {
  const char* const why =
      "0 or more, or suture.damping = \"explicit\": only explicitly has the printed sign a solution";
  const bool implicit = p.damping == Damping::kImplicit;
  if (p.bend_damping < 0.0 && implicit) t.refuse("bend_damping", why);
  if (p.swivel_damping < 0.0 && implicit) t.refuse("swivel_damping", why);
  if (p.swivel_damping < 0.0 && p.swivel == SwivelDamper::kInternal)
    t.refuse("swivel_damping", "0 or more, or suture.swivel = \"paper\": the paper prints no internal damper");
}

void read_paper(StrictTable& t, PaperParameters& p) {
  t.number("node_mass_kg", p.node_mass_kg, {1e-9, 1e4});
  t.number("stretch_N", p.stretch_N, kCoefficient);
  t.number("stretch_damping", p.stretch_damping, kCoefficient);
  t.number("bend", p.bend, kCoefficient);
  t.number("bend_damping", p.bend_damping, kEitherSign);
  t.number("swivel_damping", p.swivel_damping, kEitherSign);
  t.integer("reference_nodes", p.reference_nodes, 2, 5000);
  t.choice("damping", p.damping, kDampings);
  t.choice("integrator", p.integrator, kIntegrators);
  t.choice("swivel", p.swivel, kSwivels);
  t.choice("quadratic_stretch", p.quadratic_stretch, kQuadratics);
  refuse_printed_signs(t, p);
}

void read_suture(StrictTable& t, const fs::path& folder, Suture& s) {
  t.choice("model", s.model, kModels);
  t.integer("nodes", s.nodes, 2, 5000);
  t.number("length_m", s.length_m, {1e-3, 1e3});
  const bool is_rod = s.model == Model::kRod;
  t.keys_of(is_rod, kOfTheRod, [&] { read_rod(t, s.length_m, s.rod, s.radius_m); });
  t.keys_of(!is_rod, kOfThePaper, [&] { read_paper(t, s.paper); });
  t.number("radius_m", s.radius_m, {1e-6, 100.0});
  t.text("initial", s.initial);
  t.number("air_drag_per_s", is_rod ? s.rod.air_drag_per_s : s.paper.air_drag_per_s, {0.0, 1e6});
  if (t.failed() || s.initial == "hanging") return;
  const fs::path file = t.was_overridden("initial") ? fs::path(s.initial) : folder / s.initial;
  auto read = load_polyline(file);
  if (auto* error = std::get_if<Error>(&read))
    return t.refuse("initial", "\"hanging\" or a CSV polyline (" + error->text + ")");
  const int points = initial_points(s);
  s.initial_polyline_m = lay_out(std::get<std::vector<Vec>>(read), points, s.length_m / (points - 1));
}

void read_contact(StrictTable& t, bool is_rod, Contact& c) {
  t.choice("solver", c.solver, kSolvers);
  t.number("friction", c.friction, {0.0, 1e3});
  t.number("static_friction", c.static_friction, {0.0, 1e3});
  t.keys_of(is_rod, kOfTheRod, [&] { t.boolean("turns_thread", c.turns_thread); });
  t.keys_of(!is_rod, kOfThePaper, [&] {
    t.number("repulsion_N_per_m", c.repulsion_N_per_m, kCoefficient);
    t.number("repulsion_N_s_per_m", c.repulsion_N_s_per_m, kCoefficient);
    t.boolean("friction_cap", c.friction_cap);
    t.choice("broad_phase", c.broad_phase, kBroadPhases);
  });
  if (c.static_friction && *c.static_friction < c.friction) t.refuse("static_friction", "contact.friction or more");
}

double length_of(const Vec& v) { return std::hypot(v[0], v[1], v[2]); }

/// The paper's contact acts only between parts of the thread. A scene that asks for contact with anything else is
/// refused; otherwise that contact would be missing without notice.
void read_obstacles(StrictTable& t, bool is_rod, ContactSolver solver, World& w) {
  const bool itself_alone = !is_rod && solver == ContactSolver::kPaper;
  if (itself_alone) w.grippers_collide = w.frame_collides = false;
  t.number("desk_height_m", w.desk_height_m, {-kFar_m, kFar_m});
  t.boolean("grippers_collide", w.grippers_collide);
  t.keys_of(!is_rod, kOfThePaper, [&] { t.boolean("frame_collides", w.frame_collides); });
  if (!itself_alone) return;
  const std::string why = " with contact.solver = \"paper\", which separates the thread from itself alone";
  if (w.desk_height_m) t.refuse("desk_height_m", "no desk" + why);
  if (w.grippers_collide) t.refuse("grippers_collide", "false" + why);
  if (w.frame_collides) t.refuse("frame_collides", "false" + why);
}

void read_world(StrictTable& t, const Suture& suture, ContactSolver solver, World& w) {
  const int nodes = suture.nodes;
  const bool is_rod = suture.model == Model::kRod;
  t.vector("gravity_m_per_s2", w.gravity_m_per_s2, 1e4);
  std::set<int> seen;
  t.tables("fixed", [&](StrictTable& f) {
    FixedNode fixed;
    f.require("node");
    f.require("position_m");
    f.integer("node", fixed.node, -1, nodes - 1);
    f.vector("position_m", fixed.position_m, kFar_m);
    f.vector("direction", fixed.direction, kFar_m);
    if (fixed.direction && !(length_of(*fixed.direction) >= 1e-6))
      f.refuse("direction", "a vector of length 1e-6 or more");
    if (!seen.insert(fixed.node < 0 ? nodes - 1 : fixed.node).second)
      f.refuse("node", "a node that is not fixed already");
    w.fixed.push_back(fixed);
  });
  t.tables("loads", [&](StrictTable& l) {
    Load load;
    l.require("node");
    l.require("force_N");
    l.integer("node", load.node, -1, nodes - 1);
    l.vector("force_N", load.force_N, 1e6);
    w.loads.push_back(load);
  });
  if (w.loads.size() > kMostLoads) t.refuse("loads", std::to_string(kMostLoads) + " at most");
  t.keys_of(is_rod, kOfTheRod, [&] { read_pegs(t, w); });
  read_obstacles(t, is_rod, solver, w);
}

void read_time(StrictTable& t, int nodes, Time& time) {
  t.number("tick_s", time.tick_s, {1e-7, 1.0});
  t.integer("substeps", time.substeps, 1, 10000);
  if (time.substeps > kMostWork / nodes)
    t.refuse("substeps", std::to_string(kMostWork / nodes) + " at most with " + std::to_string(nodes) + " nodes");
}

void read_hands(StrictTable& t, const Suture& suture, Hands& h) {
  t.number("coupling_N_per_m", h.coupling_N_per_m, kCoefficient);
  t.number("coupling_N_s_per_m", h.coupling_N_s_per_m, kCoefficient);
  t.number("reach_m", h.reach_m, {1e-6, kFar_m});
  if (h.reach_m && *h.reach_m < suture.radius_m)
    t.refuse("reach_m", "suture.radius_m or more: it goes to the thread's middle");
  const bool is_rod = suture.model == Model::kRod;
  t.keys_of(is_rod, kOfTheRod, [&] {  // the paper's grippers hold one node and never slip
    t.number("pinch_width_m", h.pinch_width_m, {0.0, kFar_m});
    t.number("pinch_force_N", h.pinch_force_N, {1e-6, 1e4});
  });
  t.number("device_N_per_m", h.device_N_per_m, {1e-3, 1e5});
  t.number("device_N_s_per_m", h.device_N_s_per_m, {0.0, 1e3});
  t.boolean("passivity", h.passivity);
  t.boolean("override_passivity", h.override_passivity);
  t.number("energy_credit_J", h.energy_credit_J, {0.0, 0.02});
  t.number("force_scale", h.force_scale, {0.0, 1e3});
  t.number("max_force_N", h.max_force_N, {0.0, 100.0});
  t.keys_of(!is_rod, kOfThePaper, [&] {
    t.boolean("propagation", h.propagation);
    t.number("min_length", h.min_length, {0.01, 1.0});
    t.number("max_length", h.max_length, {1.0, 100.0});
  });
  t.number("workspace_scale", h.workspace_scale, {1e-3, 1e4});
  t.vector("workspace_origin_m", h.workspace_origin_m, kFar_m);
}

void read_scene(StrictTable& top, const fs::path& folder, Scene& s) {
  top.table("suture", [&](StrictTable& t) { read_suture(t, folder, s.suture); });
  top.table("contact", [&](StrictTable& t) { read_contact(t, s.suture.model == Model::kRod, s.contact); });
  top.table("world", [&](StrictTable& t) { read_world(t, s.suture, s.contact.solver, s.world); });
  top.table("time", [&](StrictTable& t) { read_time(t, s.suture.nodes, s.time); });
  top.table("hands", [&](StrictTable& t) { read_hands(t, s.suture, s.hands); });
  top.finish();
}

/// Inserts one `key=value` into the tree and creates tables as needed; false if the text is malformed.
bool override_key(toml::table& root, const std::string& text, ReadContext& context) {
  const auto equals = text.find('=');
  const std::string key(trim(std::string_view(text).substr(0, equals)));
  const auto bad = [&](const std::string& why) {
    context.error = Error{"--set " + text + ": " + why};
    return false;
  };
  if (equals == std::string::npos || key.empty())
    return bad("allowed key=value without spaces, for example suture.nodes=35");
  if (std::ranges::count(key, '.') > static_cast<std::ptrdiff_t>(kDeepest))
    return bad("nested too deep, allowed " + std::to_string(kDeepest) + " dots");
  toml::table value;
  auto parsed = parse_toml("v = " + text.substr(equals + 1), "--set");
  if (auto* tree = std::get_if<toml::table>(&parsed)) {
    value = std::move(*tree);
  } else {
    const std::string plain(trim(std::string_view(text).substr(equals + 1), " \t"));
    if (plain.empty() || plain.find_first_of("[]{}\"'=,") != std::string::npos) {
      return bad("the value is not TOML, allowed for example 0.5, [0.0, 0.0, 1.0] or \"text\"");
    }
    value = toml::table{{"v", plain}};  // accepts suture.model=paper-1, because a shell removes the quotes
  }
  if (value.size() != 1) return bad("allowed one value");
  toml::table* table = &root;
  std::size_t from = 0;
  for (auto dot = key.find('.'); dot != std::string::npos; from = dot + 1, dot = key.find('.', from)) {
    const auto part = key.substr(from, dot - from);
    if (!table->contains(part)) table->insert(part, toml::table{});
    table = (*table)[part].as_table();
    if (!table) return bad("'" + key.substr(0, dot) + "' is not a table");
  }
  table->insert_or_assign(key.substr(from), std::move(*value.get("v")));
  context.overridden[key] = text;
  return true;
}

}  // namespace

const char* name(Model model) noexcept {
  for (const auto& [label, value] : kModels) {
    if (value == model) return label;
  }
  return "unknown";
}

std::vector<KeyRow> scene_keys(Model model) {
  std::vector<KeyRow> rows;
  ReadContext context{{}, {}, {}, &rows};
  const toml::table root{{"suture", toml::table{{"model", name(model)}}}};
  Scene scene;
  StrictTable top(root, "", context);
  read_scene(top, {}, scene);
  return rows;
}

std::variant<Scene, Error> load_scene(const fs::path& path, std::span<const std::string> overrides) {
  const auto read = read_text(path, kMostScene_bytes);
  if (const auto* error = std::get_if<Error>(&read)) return *error;
  return parse_scene(std::get<std::string>(read), path, overrides);
}

std::variant<Scene, Error> parse_scene(const std::string& text, const fs::path& path,
                                       std::span<const std::string> overrides) {
  auto parsed = parse_toml(text, path.string());
  if (auto* error = std::get_if<Error>(&parsed)) return *error;
  auto& root = std::get<toml::table>(parsed);
  const bool has_suture = root.contains("suture");
  ReadContext context{path.string(), {}, {}};
  for (const auto& each : overrides) {
    if (!override_key(root, each, context)) return context.error.value();
  }
  Scene scene;
  StrictTable top(root, "", context);
  read_scene(top, path.parent_path(), scene);
  if (context.error) return *context.error;
  if (!has_suture) return Error{path.string() + ": no [suture] table, allowed a scene with one (it may be empty)"};
  return scene;
}

}  // namespace ligature::scene
