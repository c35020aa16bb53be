#include "host/lab/rig/stepped_rig.hpp"

#include <cstdio>
#include <stdexcept>

namespace ligature::lab {
namespace {

/// Not armed from the start, like a rig without `--arm`.
RigSetup setup_of(const scene::Scene& scene) { return {.scene = scene, .settings = {20, false}}; }

VirtualRig::Intentions steered(std::array<sim::SteeredHand*, 2>& hands) {
  VirtualRig::Intentions intentions;
  for (std::size_t h = 0; h < hands.size(); ++h) {
    auto hand = std::make_unique<sim::SteeredHand>(sim::Body::of(device::omni()).plant.linkage);
    hands[h] = hand.get();
    intentions[h] = std::move(hand);
  }
  return intentions;
}

sim::WorkspaceMap map_of(const scene::Scene& scene) {
  return sim::WorkspaceMap(scene.hands, sim::Body::of(device::omni()).plant.linkage);
}

}  // namespace

SteppedRig::SteppedRig(const scene::Scene& scene, std::span<const scene::FaultScript> faults)
    : rig_(setup_of(scene), steered(hands_)) {
  for (const auto& fault : faults) {
    auto& bus = fault.hand == 0 ? rig_.left : rig_.right;
    if (bus.faults) throw std::runtime_error("faults: found two for one hand, allowed one for each");
    bus.faults.emplace(fault);
  }
  wishes_.fill({map_of(scene).origin_W_m, false, false});
  rig_.each_tick = [this] { after_a_period(); };
  thread_ = std::jthread([this] { live(); });
}

SteppedRig::~SteppedRig() {
  ends_ = true;
  left_ = kAll;
  rig_.cycle.end_after(0);
  goes_.release();
}

void SteppedRig::advance(std::int64_t periods) {
  if (periods <= 0) return;
  if (!why_ended_) {
    left_ = periods;
    goes_.release();
    rests_.acquire();
  }
  if (why_ended_) throw std::runtime_error(*why_ended_);
}

/// The rig's thread: runs while the caller waits in advance(), and waits in after_a_period() while the caller runs.
void SteppedRig::live() {
  goes_.acquire();
  if (ends_) return;
  try {
    why_ended_ = rig_.run(kAll).value_or("the rig has ended");
  } catch (const std::exception& error) {
    why_ended_ = error.what();
  }
  rests_.release();
}

void SteppedRig::after_a_period() {
  if (ends_) return;
  if (++steered_ % kWishEvery == 0) steer();
  if (--left_ > 0) return;
  rests_.release();
  goes_.acquire();
}

void SteppedRig::steer() {
  const auto map = map_of(rig_.setup.scene);
  for (std::size_t h = 0; h < hands_.size(); ++h) {
    const auto& mechanics = (h == 0 ? rig_.left : rig_.right).device.mechanics();
    hands_[h]->wish(mechanics.script_time_s(), map.to_device(wishes_[h].p_W_m), wishes_[h].dead_man, wishes_[h].grip);
  }
}

std::string out_of_reach(const scene::Scene& scene, const sim::Vec3& p_W_m) {
  const auto map = map_of(scene);
  if (p_W_m.allFinite() && map.linkage.reaches(map.to_device(p_W_m))) return {};
  const sim::Vec3& o = map.origin_W_m;
  char text[200];
  std::snprintf(text, sizeof text, "found (%g, %g, %g) m, out of the device's reach; allowed: nearer to (%g, %g, %g) m",
                p_W_m.x(), p_W_m.y(), p_W_m.z(), o.x(), o.y(), o.z());
  return text;
}

}  // namespace ligature::lab
