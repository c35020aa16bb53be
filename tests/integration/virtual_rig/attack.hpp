#pragma once
// A random attack on the rig in virtual time: hands that pull hard, and random faults meanwhile.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "firmware/control/plant.hpp"
#include "host/lab/rig/virtual_rig.hpp"
#include "tests/support/random.hpp"

namespace ligature {

/// Parameters of a run; the seed determines all of them and their timing.
struct AttackPlan {
  explicit AttackPlan(std::uint64_t seed);
  /// Only the pulling hands, ten times as stiff as the shipped ones, without faults.
  [[nodiscard]] static AttackPlan pulls(std::uint64_t seed);

  struct Foreign {  ///< frames that another client sends on a hand's bus
    int hand = 0;
    std::int64_t from = 0, ticks = 0;
    int a_tick = 1;
    can::Frame frame;
    std::string what;
  };
  /// From tick `from` on, `a_tick` frames of the highest priority per tick.
  [[nodiscard]] static Foreign flood(int hand, std::int64_t from, std::int64_t ticks, int a_tick);
  struct Order {
    std::int64_t tick = 0;
    rt::CommandKind kind = rt::CommandKind::kNone;
  };

  std::uint64_t seed = 0;
  double coupling = 1.0;  ///< coupling stiffness relative to the shipped one
  std::array<double, 2> tightness{0.5, 0.5}, period_s{0.7, 0.8}, amplitude_m{0.03, 0.03};
  std::array<sim::Vec3, 2> along;  ///< direction of each hand's pull, a unit vector
  bool jumps = false;
  double lead_s = 0.0;      ///< an adversarial hand pushes this far ahead, in time, along the tip's velocity; 0: none
  double let_go_s = 1e9;    ///< when both dead-men are released, since the script's start
  double frame_loss = 0.0;  ///< share of process data frames lost, in either direction
  std::array<std::optional<scene::FaultScript>, 2> faults;
  std::vector<Foreign> foreign;
  std::vector<Order> orders;
  std::int64_t swap_at = -1;  ///< when the force scale or the scene is changed
  bool swap_scene = false;
  std::int64_t cut_at = -1, stall_at = -1, stall_ticks = 0;

  [[nodiscard]] bool loses_frames() const;
  [[nodiscard]] std::string text() const;

 private:
  void choose_hands(test::Random& random);
  void choose_faults(test::Random& random);
  void choose_foreign(test::Random& random);
  void choose_orders(test::Random& random);
};

inline constexpr std::int64_t kAttackTicks = 2200;

/// A virtual rig in which the events of an AttackPlan occur.
class AttackedRig {
 public:
  explicit AttackedRig(const AttackPlan& plan);
  /// @return why the rig did not start, as some attacks cause.
  std::optional<std::string> run();

  lab::VirtualRig rig;

 private:
  void befall();

  AttackPlan plan_;
  control::PlantHandover plants_;
  std::unique_ptr<control::Plant> swapped_;
};

}  // namespace ligature
