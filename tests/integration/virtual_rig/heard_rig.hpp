#pragma once
// The virtual rig with two hands that tie (sim_device/tying). As if it were a process of its own, each hand has its own
// plan. A plan sees only the messages that telemetry sends: batches of 20 ticks, and 60 shapes of the thread a second.

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "firmware/telemetry/messages.hpp"
#include "host/lab/rig/virtual_rig.hpp"
#include "sim_device/tying/tying_plan.hpp"
#include "tests/support/knot_in.hpp"
#include "tests/support/random.hpp"

namespace ligature::lab::test {

using ligature::test::knot_in;
using ligature::test::Random;

/// Disturbances between the rig and the two plans.
struct Way {
  double latest_s = 0.01;   ///< largest delay of a message; each message has a random delay at each hand
  double lost_share = 0.0;  ///< share of the messages that is lost at each hand
  std::uint64_t seed = 1;
};

class HeardRig {
 public:
  HeardRig(const RigSetup& setup, const std::string& knot, std::uint32_t seed, const Way& way = {})
      : way_(way), ears_{Ear(setup, knot, seed, 0), Ear(setup, knot, seed, 1)}, rig(setup, hands()) {
    rig.each_tick = [this] { tell(); };
  }

  /// Runs until both hands have released the dead-man. @return type and handedness of the knot, or why there is none.
  std::string tie(std::int64_t most_ticks) {
    if (const auto why = rig.run(most_ticks, true)) return *why;
    if (!rig.is_done()) return "not done: " + ears_[0].plan.tier().doing();
    return knot_in(rig.thread.nodes_W());
  }

  [[nodiscard]] const sim::TyingPlan& plan(std::size_t hand) const { return ears_[hand].plan; }
  /// Largest distance between the positions that the two plans give the same hand at the same tick, m.
  [[nodiscard]] double parted_m() const { return parted_m_; }

 private:
  using Message = std::variant<ligature_msg::thread_t, ligature_msg::tick_batch_t>;

  struct Ear {
    Ear(const RigSetup& setup, const std::string& knot, std::uint32_t seed, std::size_t which)
        : plan(std::get<sim::KnotTier>(sim::KnotTier::make(setup.scene, knot, seed)), setup.scene),
          played(
              std::make_unique<sim::PlayedHand>(sim::WorkspaceMap(setup.scene.hands, setup.body[which].plant.linkage),
                                                which, plan.tier().wish()[which].p_W)),
          hand(played.get()) {}
    sim::TyingPlan plan;
    std::unique_ptr<sim::PlayedHand> played;  // moved into the rig
    sim::PlayedHand* hand;
    std::deque<std::pair<Nanoseconds, Message>> on_the_way{};
    std::vector<sim::WishedTick> fresh{}, all{};
  };

  VirtualRig::Intentions hands() { return {std::move(ears_[0].played), std::move(ears_[1].played)}; }

  void tell() {
    for (; told_ < rig.records.size(); ++told_) {
      batch_.ticks.push_back(telemetry::to_message(rig.records[told_]));
      if (batch_.ticks.size() == 20) send(std::exchange(batch_, {}));
    }
    if (rig.time >= shape_due_ && rig.outlets->shape.refresh()) {
      shape_due_ = rig.time + std::chrono::microseconds(16'667);
      send(telemetry::to_message(rig.outlets->shape.front(), 0.0, 0));
    }
    deliver(ears_[0], rig.left.device.mechanics());
    deliver(ears_[1], rig.right.device.mechanics());
    while (!ears_[0].all.empty() && !ears_[1].all.empty()) compare();
  }

  void send(const Message& message) {
    for (Ear& ear : ears_) {
      if (random_.happens(way_.lost_share)) continue;
      Nanoseconds at = rig.time + Nanoseconds(static_cast<std::int64_t>(1e9 * random_.in(0.0, way_.latest_s)));
      if (!ear.on_the_way.empty()) at = std::max(at, ear.on_the_way.back().first);  // LCM keeps the order of one sender
      ear.on_the_way.emplace_back(at, message);
    }
  }

  void deliver(Ear& ear, const sim::Mechanics& mechanics) {
    ear.fresh.clear();
    for (; !ear.on_the_way.empty() && ear.on_the_way.front().first <= rig.time; ear.on_the_way.pop_front()) {
      const Message& message = ear.on_the_way.front().second;
      if (const auto* thread = std::get_if<ligature_msg::thread_t>(&message)) ear.plan.take(*thread);
      if (const auto* batch = std::get_if<ligature_msg::tick_batch_t>(&message)) ear.plan.take(*batch, ear.fresh);
    }
    ear.hand->look(mechanics.script_time_s(), mechanics.started_at(), ear.fresh);
    ear.all.insert(ear.all.end(), ear.fresh.begin(), ear.fresh.end());
  }

  void compare() {
    auto &a = ears_[0].all, &b = ears_[1].all;
    const std::int64_t due = std::max(a.front().due_ns, b.front().due_ns);
    for (auto* list : {&a, &b}) std::erase_if(*list, [due](const auto& wish) { return wish.due_ns < due; });
    if (a.empty() || b.empty()) return;
    if (a.front().due_ns != b.front().due_ns) return compare();
    for (std::size_t h = 0; h < 2; ++h)
      parted_m_ = std::max(parted_m_, (a.front().hands[h].p_W - b.front().hands[h].p_W).norm());
    a.erase(a.begin());
    b.erase(b.begin());
  }

  Way way_;
  Random random_{way_.seed};
  std::array<Ear, 2> ears_;
  ligature_msg::tick_batch_t batch_{};
  std::size_t told_ = 0;
  Nanoseconds shape_due_{0};
  double parted_m_ = 0.0;

 public:
  VirtualRig rig;  // after ears_: it takes over their hands
};

}  // namespace ligature::lab::test
