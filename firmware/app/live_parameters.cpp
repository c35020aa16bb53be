#include "firmware/app/live_parameters.hpp"

namespace ligature::app {
namespace {

constexpr double kFurthest = 4.0;
constexpr double kMostFriction = 10.0;    // the paper's Table I
constexpr double kMostRodFriction = 2.0;  // no pair of real threads has more

using Get = double (*)(const scene::Scene&);
struct Row {
  const char *key, *name, *unit;
  Get get;
  scene::Model first = scene::Model::kPaper1;  ///< the first of the paper's models on which it acts
};

constexpr Row kPaper[] = {
    {"suture.stretch_N", "stiffness, stretch", "N", [](const scene::Scene& s) { return s.suture.paper.stretch_N; }},
    {"suture.bend", "stiffness, bending", "N m", [](const scene::Scene& s) { return s.suture.paper.bend; },
     scene::Model::kPaper2},
    {"suture.stretch_damping", "damping, stretch", "N s/m",
     [](const scene::Scene& s) { return s.suture.paper.stretch_damping; }},
    {"suture.bend_damping", "damping, bending", "N m s",
     [](const scene::Scene& s) { return s.suture.paper.bend_damping; }, scene::Model::kPaper3},
    {"suture.air_drag_per_s", "damping, air", "1/s",
     [](const scene::Scene& s) { return s.suture.paper.air_drag_per_s; }},
};
constexpr Row kRod[] = {
    {"suture.EI_N_m2", "stiffness, bending", "N m²", [](const scene::Scene& s) { return s.suture.rod.EI_N_m2; }},
    {"suture.damping_s", "damping, bending", "s", [](const scene::Scene& s) { return s.suture.rod.damping_s; }},
    {"suture.air_drag_per_s", "damping, air", "1/s", [](const scene::Scene& s) { return s.suture.rod.air_drag_per_s; }},
};
constexpr Row kForceScale{"hands.force_scale", "force scale", "",
                          [](const scene::Scene& s) { return s.hands.force_scale; }};

}  // namespace

std::vector<LiveParameter> live_parameters(const scene::Scene& file, const scene::Scene& now) {
  std::vector<LiveParameter> list;
  const auto add = [&](const Row& row) {
    const double given = row.get(file);
    if (given > 0.0) list.push_back({row.key, row.name, row.unit, row.get(now), given / kFurthest, given * kFurthest});
  };
  const bool is_rod = now.suture.model == scene::Model::kRod;
  const bool has_contact = now.contact.solver != scene::ContactSolver::kNone;
  // A rod decides at construction whether it computes friction at all, so friction cannot be switched on during a run.
  if (has_contact && (!is_rod || file.contact.friction > 0.0))
    list.push_back({"contact.friction", "friction", "", now.contact.friction, is_rod ? 0.01 : 0.0,
                    is_rod ? kMostRodFriction : kMostFriction});
  if (is_rod)
    for (const Row& row : kRod) add(row);
  else
    for (const Row& row : kPaper)
      if (now.suture.model >= row.first) add(row);
  add(kForceScale);
  return list;
}

}  // namespace ligature::app
