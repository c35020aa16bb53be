#pragma once
// One device port must never give out more energy than it was given: a lower bound of it, and a force that it can pay
// for.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "firmware/control/any_pose.hpp"
#include "firmware/control/kinematics.hpp"
#include "firmware/control/sent_torques.hpp"

namespace ligature::control {

/// What a hand's drives say of the period that ended with a sample.
struct Acted {
  static constexpr double kNotTold = std::numeric_limits<double>::quiet_NaN();
  Vec3 torque_Nm{kNotTold, kNotTold, kNotTold};  ///< made, by joint
  std::array<bool, 3> limited{};                 ///< the drive made less than it was asked for
  std::array<int, 3> held{};                     ///< SYNCs that a drive without torque in its message got nothing new
};

/// A pose, and how sharply it is seen.
struct PortSample {
  JointAngles q_rad{};
  Vec3 p_m = Vec3::Zero();             ///< of the tip
  double count_rad = 0.0;              ///< of the joints' encoders; 0: exact
  Vec3 lever_m = Vec3::Zero();         ///< |dp/dq_j|
  Vec3 rate_rad_per_s = Vec3::Zero();  ///< for where between two counts a joint is likely to be
  Acted acted{};
  Mat3 tip_N_per_Nm = Mat3::Identity();  ///< J^-T: joint torques to tip force
};

/// Account of a port and controller over it.
///
/// Observer. A torque sent in tick k acts from SYNC k+1 to SYNC k+2 and is constant in between (zero-order hold), so
/// the motors' work is exact but for the encoder's half count h:
///   E(n) = E(n-1) - sum_j tau_j dq_j
/// with the torque that the drive says it made: a lost RPDO leaves the one before. Where a sample was lost, dq covers
/// several periods, still exact as long as the torque was the same in all of them; else the joint is taken to have
/// moved evenly, and where a torque is not known the worst of what it may have been is booked. A drive that guards its
/// winding may change its torque within a period: the worst of sent and told. Where a slow joint is between two counts
/// is guessed by its velocity. Half counts h hide up to 2 h |tau_j(n) - tau_j(n-1)| of either sign at each change, for
/// which no room is kept. Credit above kCredit_J is forgotten (else an hour of harmless friction would pay for a minute
/// of instability). The start is 0 plus the scene's energy_credit_J.
///
/// Controller. Torques sent are spent money: one is on its way when the next is decided, and the hand may turn round. A
/// hand that gives the tip at most the acceleration a moves it, in the j-th period after the last sample, by dx + e
/// with |e| <= j a T^2 + c (dx: the last period's motion, c: one count). What force F can lose there is
///   out_j(F) = max(0, F . dx + |F| (j a T^2 + c)),
/// and a force is sent only when E stays above -kFloor_J after the losses of all torques under way, its own, and those
/// of the way from it to zero in steps of the device's force_step_N. So a force that was paid for can be taken
/// back without a jump. One that cannot be paid for is first damped against the motion (alpha = shortage / (T v^2), at
/// most kMaxDamping, v at least kSlow), then as much of it is sent as can. O(1), no allocation. The bound on
/// acceleration is the device record's; where a hand is so much wilder that not even a period of the least force within
/// a step can be paid for, all of it is let go.
///
/// Lost frames. Once RPDOs have been lost, the next loss is foreseen: of what is under way any mixture, joint by joint,
/// may act, and the one sent may act twice. Without a sample the force goes on as long as it is paid for. In either
/// case the hand's acceleration from the third period on is taken as kLater of a, and only of what exceeds kSlight_N.
class Passivity {
 public:
  static constexpr double kFloor_J = 1e-6;
  static constexpr double kCredit_J = 0.02;             ///< a 3.3 N spring of 270 N/m, or a 0.88 N one of 19 N/m
  static constexpr double kMaxDamping_N_s_per_m = 5.0;  ///< what a device of the class can render at 1 kHz
  static constexpr std::int64_t kWary = 10'000;         ///< ticks after a lost RPDO in which the next one is foreseen
  static constexpr double kLater = 0.3;          ///< of the hand's acceleration, after two periods without a sample
  static constexpr double kMore = 3.0;           ///< periods of the present motion foreseen beyond those two
  static constexpr double kSlight_N = 0.006;     ///< for so little nothing is foreseen, else no force could begin
  static constexpr double kSlowCounts = 0.25;    ///< a period; below, a joint is guessed to be between counts
  static constexpr double kSlow_m_per_s = 5e-3;  ///< below, a velocity is mostly counts
  static constexpr double kAnyPose = 1.04;       ///< of the step limit, for encoders that lie: 0.52 N

  Passivity(const device::Device& device, double period_s, bool active, double credit_J) noexcept;

  /// SYNC of `tick` has gone out; observe() and sent() say so, too.
  void begin(std::int64_t tick) noexcept {
    sent_.begin(tick);
    look_under_way(tick);
  }

  /// A new sample: books the work since the last one.
  void observe(std::int64_t tick, const PortSample& sample) noexcept;

  /// The force that may be sent in tick `tick`, >= the last observed, on the way from `before_N` (sent last) to
  /// `wish_N`. Only looks; sent() books it. Energy comes before the law. Where the way back in steps cannot be paid
  /// for any more, it is gone; where not even the next period of it can, all force is let go: released() says so.
  /// @param torque tip force -> the joint torques that go out for it; whole quanta
  template <class Torque>
  [[nodiscard]] Vec3 control(std::int64_t tick, const Vec3& wish_N, const Vec3& v_m_per_s, const Vec3& before_N,
                             Torque torque) noexcept {
    injected_ = 0.0;
    released_ = false;
    const auto near = [&](const Vec3& f_N) { return is_a_step(torque(f_N)); };
    const auto paid = [&](const Vec3& f_N) {
      const Vec3 torque_Nm = torque(f_N);
      return is_a_step(torque_Nm) && allows(tick, tip_N_per_Nm_ * torque_Nm);
    };
    Vec3 next_N = farthest(before_N, wish_N, near);
    stepped_ = next_N != wish_N;
    acts_ = !paid(next_N);
    if (!acts_) return next_N;
    const Vec3 least_N = least_of(before_N, near);
    if (paid(least_N))
      return farthest(least_N, farthest(before_N, damped(tick, next_N, v_m_per_s, before_N), near), paid);
    if (near(Vec3::Zero())) return farthest(Vec3::Zero(), least_N, paid);
    // Not even until the next decision.
    released_ = active_ && shortage_J(tick, tip_N_per_Nm_ * torque(least_N), false) > 0.0;
    return released_ ? Vec3(Vec3::Zero()) : least_N;
  }
  [[nodiscard]] Vec3 control(std::int64_t tick, const Vec3& wish_N, const Vec3& v, const Vec3& before_N) noexcept {
    return control(tick, wish_N, v, before_N, [](const Vec3& f_N) { return f_N; });
  }
  /// Whether the tip's force changes by force_step_N at most when these torques act at the next SYNC, whatever acts
  /// until then: what a drive last said that it made, or anything sent since, joint by joint, for each RPDO may be
  /// lost. In the pose that the encoders say, and by kAnyPose of it in any pose of the workspace, in case they lie. The
  /// same torques again are no step.
  [[nodiscard]] bool is_a_step(const Vec3& torque_Nm) const noexcept;
  /// Whether exactly this tip force may be sent in `tick`.
  [[nodiscard]] bool allows(std::int64_t tick, const Vec3& f_N) const noexcept {
    return !active_ || f_N.isZero(0.0) || shortage_J(tick, f_N) <= 0.0;
  }
  /// What went out in `tick`, and the tip force it makes.
  void sent(std::int64_t tick, const Vec3& torque_Nm, const Vec3& f_N) noexcept;

  /// While both hands hold the thread it carries energy from one to the other: the port that is short of what its wish
  /// costs gets what the other can spare. Their sum stays what both hands have put in.
  static void lend(std::int64_t tick, Passivity& a, const Vec3& wish_a_N, Passivity& b, const Vec3& wish_b_N) noexcept;

  /// For a move that the rig makes by itself, and no other: so much may be given out. Counts as received.
  void grant(double energy_J) noexcept;
  /// Its end: what is left of it goes back.
  void revoke() noexcept;

  /// As at the start. An encoder that jumped has booked work that nobody did, and no hand could ever pay that back.
  /// @pre no force flows, nor is any under way.
  void restart() noexcept {
    energy_J_ = credit_J_;
    received_J_ = granted_J_ = 0.0;
  }

  /// Off: the account is kept, nothing is held back. @pre no force flows.
  void set_active(bool active) noexcept { active_ = active; }

  /// Put in by this hand less what it got back, plus what the other hand's account or a grant gave.
  [[nodiscard]] double energy_J() const noexcept { return energy_J_; }
  [[nodiscard]] double received_J() const noexcept { return received_J_; }  ///< by lend() and grant(), since the start
  [[nodiscard]] double dissipated_J() const noexcept { return dissipated_J_; }
  [[nodiscard]] double injected_N_s_per_m() const noexcept { return injected_; }
  [[nodiscard]] bool acts() const noexcept { return acts_; }
  [[nodiscard]] bool stepped() const noexcept { return stepped_; }    ///< the wish was more than a step away
  [[nodiscard]] bool released() const noexcept { return released_; }  ///< a hand wilder than the record allows
  /// Whether lost frames are foreseen in this tick.
  [[nodiscard]] bool is_wary(std::int64_t tick) const noexcept { return tick > sampled_ || tick < lossy_until_; }

 private:
  static constexpr double kSpend_J = 0.95 * kFloor_J;
  static constexpr double kRounding_J = 5e-6;  // what a torque's rounding may cost more: one quantum times 1 mm
  /// Joint torques, each between its two ends.
  struct Box {
    Vec3 low_Nm = Vec3::Zero(), high_Nm = Vec3::Zero();
    void take(const Vec3& torque_Nm) noexcept {
      low_Nm = low_Nm.cwiseMin(torque_Nm), high_Nm = high_Nm.cwiseMax(torque_Nm);
    }
    [[nodiscard]] Vec3 middle_Nm() const noexcept { return 0.5 * (low_Nm + high_Nm); }
    /// Of a convex measure of the tip force.
    template <class Measure>
    [[nodiscard]] double worst(const Mat3& tip_N_per_Nm, Measure measure) const noexcept {
      double most = measure(Vec3(tip_N_per_Nm * low_Nm));
      for (unsigned corner = 1; corner < 8 && low_Nm != high_Nm; ++corner) {
        Vec3 torque_Nm = low_Nm;
        for (Eigen::Index j = 0; j < 3; ++j)
          if ((corner >> j & 1U) != 0) torque_Nm[j] = high_Nm[j];
        most = std::max(most, measure(Vec3(tip_N_per_Nm * torque_Nm)));
      }
      return most;
    }
  };

  void look_under_way(std::int64_t tick) noexcept;
  [[nodiscard]] double most_given_J(Eigen::Index joint, std::int64_t tick, double dq_rad,
                                    const PortSample& sample) noexcept;
  [[nodiscard]] double loss_J(const Vec3& f_N, std::int64_t start, std::int64_t periods, double counts) const noexcept;
  [[nodiscard]] double blind_loss_J(const Vec3& f_N, std::int64_t start, std::int64_t periods) const noexcept;
  [[nodiscard]] double along_J(const Vec3& f_N) const noexcept;
  [[nodiscard]] double shortage_J(std::int64_t tick, const Vec3& f_N, bool and_back = true) const noexcept;
  [[nodiscard]] Vec3 damped(std::int64_t tick, const Vec3& wish_N, const Vec3& v, const Vec3& before_N) noexcept;
  [[nodiscard]] static Vec3 shorter(const Vec3& f_N, double by_N) noexcept {
    const double size = f_N.norm();
    return size > by_N ? Vec3(f_N * (1.0 - by_N / size)) : Vec3(Vec3::Zero());
  }

  /// The shortest a step away: straight back, or where a force turns, between those that may be acting and back.
  template <class Near>
  [[nodiscard]] Vec3 least_of(const Vec3& before_N, Near near) const noexcept {
    const Vec3 straight_N = farthest(before_N, shorter(before_N, step_N_), near);
    const Vec3 amid_N = farthest(before_N, tip_N_per_Nm_ * under_way_.middle_Nm(), near);
    const Vec3 between_N = farthest(amid_N, shorter(amid_N, step_N_), near);
    return between_N.norm() < straight_N.norm() ? between_N : straight_N;
  }

  /// Of the way from `from` to `to`, as far as can be paid for.
  template <class Paid>
  [[nodiscard]] static Vec3 farthest(const Vec3& from, const Vec3& to, Paid paid) noexcept {
    if (paid(to)) return to;
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 18; ++i) {
      const double middle = 0.5 * (low + high);
      (paid(from + middle * (to - from)) ? low : high) = middle;
    }
    return from + low * (to - from);
  }

  [[nodiscard]] double step_along_N(const Vec3& along) const noexcept;

  double period_s_, reach_m_, step_N_;  // reach: a T^2
  AnyPose any_pose_;
  bool active_;
  double credit_J_, energy_J_, received_J_ = 0.0, granted_J_ = 0.0, dissipated_J_ = 0.0, injected_ = 0.0;
  double count_m_ = 0.0, doubt_m_ = 0.0;  // of step_m_: by counts, by what lies between samples
  bool acts_ = false, stepped_ = false, released_ = false;
  Mat3 tip_N_per_Nm_ = Mat3::Identity(), Nm_per_tip_N_ = Mat3::Identity();
  std::int64_t sampled_ = -1, lossy_until_ = -1;
  Vec3 q_rad_ = Vec3::Zero();                            // at the sample: guessed
  Vec3 p_m_ = Vec3::Zero(), step_m_ = Vec3::Zero();      // step: motion in a period before the sample
  Vec3 low_Nm_ = Vec3::Zero(), high_Nm_ = Vec3::Zero();  // what acted in that period
  std::array<bool, 3> guarded_{};                        // then
  SentTorques sent_;
  Box under_way_;                                 // what may be acting until the next SYNC
  double under_way_J_ = 0.0, under_way_N_ = 0.0;  // what that may lose, and the largest force of it
};

}  // namespace ligature::control
