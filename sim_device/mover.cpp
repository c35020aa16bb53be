#include "sim_device/mover.hpp"

#include "protocol/scene/gripper_script.hpp"
#include "protocol/scene/scene_file.hpp"
#include "sim_device/page/page_link.hpp"
#include "sim_device/script_hand.hpp"
#include "sim_device/tying/tying_link.hpp"
#include "sim_device/unrest.hpp"

namespace ligature::sim {
namespace {

/// Without a scene the script's positions are taken as metres in the device's own frame.
std::string no_scene(const Options& o) { return o.scene.empty() ? "; --scene says them, and is not given" : ""; }

std::variant<Mover, std::string> scripted(const Options& o, const scene::Scene& scene, const Linkage& linkage) {
  scene::GripperScript script;
  if (!o.script.empty()) {
    auto read = scene::load_gripper_script(o.script);
    if (const auto* e = std::get_if<scene::Error>(&read)) return e->text;
    script = std::get<scene::GripperScript>(std::move(read));
  }
  auto path = script_hand(script, o.is_left ? 0 : 1, WorkspaceMap(scene.hands, linkage));
  if (const auto* why = std::get_if<std::string>(&path)) return o.script + ": " + *why + no_scene(o);
  return Mover{std::get<std::unique_ptr<Intention>>(std::move(path)), nullptr};
}

std::variant<Mover, std::string> steered(const Options& o, const Linkage& linkage) {
  auto hand = std::make_unique<SteeredHand>(linkage);
  auto link = std::make_unique<PageLink>(o.lcm_url, o.is_left, *hand);
  if (!link->objection().empty()) return link->objection();
  return Mover{std::move(hand), std::move(link)};
}

std::variant<Mover, std::string> tying(const Options& o, const scene::Scene& scene, const Linkage& linkage) {
  const auto refused = [&o](const std::string& why) { return "--operator " + o.script + ": " + why; };
  if (o.scene.empty()) return refused("needs --scene, which says where the thread hangs");
  auto tier = tier_of(o.script, scene);
  if (const auto* why = std::get_if<std::string>(&tier)) return refused(*why);
  const std::size_t index = o.is_left ? kLeftHand : kRightHand;
  const WorkspaceMap map(scene.hands, linkage);
  const Vec3 start_W = std::get<KnotTier>(tier).wish()[index].p_W;
  const auto q = linkage.joints(map.to_device(start_W));
  if (!q || !linkage.is_within_stops(*q)) return refused("this hand would begin out of the device's reach");
  auto hand = std::make_unique<PlayedHand>(map, index, start_W);
  auto link = std::make_unique<TyingLink>(o.lcm_url, TyingPlan(std::get<KnotTier>(std::move(tier)), scene), *hand);
  if (!link->objection().empty()) return link->objection();
  return Mover{std::move(hand), std::move(link)};
}

std::unique_ptr<Intention> with_unrest(std::unique_ptr<Intention> will, const Options& o) {
  if (o.tremor_mm > 0.0) will = std::make_unique<Trembling>(std::move(will), 1e-3 * o.tremor_mm, o.tremor_Hz, o.seed);
  if (o.adversary_lead_s > 0.0)
    will = std::make_unique<Adversarial>(std::move(will), o.adversary_lead_s, 1e-3 * o.adversary_reach_mm);
  return will;
}

}  // namespace

std::variant<Mover, std::string> mover_of(const Options& options, const Linkage& linkage) {
  scene::Scene scene;
  if (!options.scene.empty()) {
    auto read = scene::load_scene(options.scene, options.overrides);
    if (const auto* e = std::get_if<scene::Error>(&read)) return e->text;
    scene = std::get<scene::Scene>(std::move(read));
  }
  auto found = options.is_steered() ? steered(options, linkage)
               : options.is_tying() ? tying(options, scene, linkage)
                                    : scripted(options, scene, linkage);
  if (auto* mover = std::get_if<Mover>(&found)) mover->will = with_unrest(std::move(mover->will), options);
  return found;
}

}  // namespace ligature::sim
