#include "sim_device/mover.hpp"

#include "protocol/scene/gripper_script.hpp"
#include "protocol/scene/scene_file.hpp"
#include "sim_device/script_hand.hpp"
#include "sim_device/unrest.hpp"

namespace ligature::sim {
namespace {

std::variant<std::unique_ptr<Intention>, std::string> read_script(const Options& o, const Linkage& linkage) {
  scene::Scene scene;
  if (!o.scene.empty()) {
    auto read = scene::load_scene(o.scene, o.overrides);
    if (const auto* e = std::get_if<scene::Error>(&read)) return e->text;
    scene = std::get<scene::Scene>(std::move(read));
  }
  scene::GripperScript script;
  if (!o.script.empty() && !o.is_steered()) {
    auto read = scene::load_gripper_script(o.script);
    if (const auto* e = std::get_if<scene::Error>(&read)) return e->text;
    script = std::get<scene::GripperScript>(std::move(read));
  }
  auto path = script_hand(script, o.is_left ? 0 : 1, WorkspaceMap(scene.hands, linkage));
  if (const auto* why = std::get_if<std::string>(&path)) return o.script + ": " + *why;
  return path;
}

std::unique_ptr<Intention> with_unrest(std::unique_ptr<Intention> will, const Options& o) {
  if (o.tremor_mm > 0.0) will = std::make_unique<Trembling>(std::move(will), 1e-3 * o.tremor_mm, o.tremor_Hz, o.seed);
  if (o.adversary_lead_s > 0.0)
    will = std::make_unique<Adversarial>(std::move(will), o.adversary_lead_s, 1e-3 * o.adversary_reach_mm);
  return will;
}

}  // namespace

std::variant<Mover, std::string> mover_of(const Options& options, const Linkage& linkage) {
  auto script = read_script(options, linkage);
  if (const auto* why = std::get_if<std::string>(&script)) return *why;
  Mover mover;
  if (options.is_steered()) {
    auto hand = std::make_unique<SteeredHand>(linkage);
    mover.page = std::make_unique<PageLink>(options.lcm_url, options.is_left, *hand);
    if (!mover.page->objection().empty()) return mover.page->objection();
    mover.will = std::move(hand);
  } else {
    mover.will = std::get<std::unique_ptr<Intention>>(std::move(script));
  }
  mover.will = with_unrest(std::move(mover.will), options);
  return mover;
}

}  // namespace ligature::sim
