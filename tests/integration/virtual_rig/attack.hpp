#pragma once
// A random attack on the rig in virtual time: hands that pull hard, and what a seed makes go wrong meanwhile.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "firmware/control/plant.hpp"
#include "host/lab/rig/virtual_rig.hpp"
#include "tests/support/random.hpp"

namespace ligature {

/// What a run is made of. All of it, and its order, comes from the seed.
struct AttackPlan {
  explicit AttackPlan(std::uint64_t seed);
  /// The hands alone, ten times as stiff as shipped, and nothing that goes wrong.
  [[nodiscard]] static AttackPlan pulls(std::uint64_t seed);

  struct Foreign {  ///< frames that another client of a hand's bus sends
    int hand = 0;
    std::int64_t from = 0, ticks = 0;
    int a_tick = 1;
    can::Frame frame;
    std::string what;
  };
  /// From tick `from` on, so many frames of the highest priority a tick.
  [[nodiscard]] static Foreign flood(int hand, std::int64_t from, std::int64_t ticks, int a_tick);
  struct Order {
    std::int64_t tick = 0;
    rt::CommandKind kind = rt::CommandKind::kNone;
  };

  std::uint64_t seed = 0;
  double coupling = 1.0;  ///< times the shipped one
  std::array<double, 2> tightness{0.5, 0.5}, period_s{0.7, 0.8}, amplitude_m{0.03, 0.03};
  std::array<sim::Vec3, 2> along;  ///< a unit vector each
  bool jumps = false;
  double lead_s = 0.0;      ///< of hands that push on, 0: none
  double let_go_s = 1e9;    ///< of both dead-men, since the script's start
  double frame_loss = 0.0;  ///< of process data, either way
  std::array<std::optional<scene::FaultScript>, 2> faults;
  std::vector<Foreign> foreign;
  std::vector<Order> orders;
  std::int64_t swap_at = -1;  ///< another force scale, or another scene
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

/// The rig under that plan. run() runs it.
class AttackedRig {
 public:
  explicit AttackedRig(const AttackPlan& plan);
  /// @return why it did not start; some attacks keep a rig from starting.
  std::optional<std::string> run();

  lab::VirtualRig rig;

 private:
  void befall();

  AttackPlan plan_;
  control::PlantHandover plants_;
  std::unique_ptr<control::Plant> swapped_;
};

}  // namespace ligature
