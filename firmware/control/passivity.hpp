#pragma once
// Passivity control of one hand: an account of the energy that the hand has put into the device (a lower bound), and a
// force that never takes out more than the account holds.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "firmware/control/any_pose.hpp"
#include "firmware/control/kinematics.hpp"
#include "firmware/control/sent_torques.hpp"

namespace ligature::control {

/// What the drives of a hand report about the period that ended with a sample.
struct Acted {
  static constexpr double kNotTold = std::numeric_limits<double>::quiet_NaN();
  Vec3 torque_Nm{kNotTold, kNotTold, kNotTold};  ///< torque made, by joint; NaN if the message has none
  std::array<bool, 3> limited{};                 ///< the drive made less torque than commanded
  /// The drive's own count of SYNCs for which it has repeated an older torque because RPDOs were lost; 0: none. Used
  /// for drives whose message does not contain the torque.
  std::array<int, 3> held{};
};

/// A measured pose and its resolution.
struct PortSample {
  JointAngles q_rad{};
  Vec3 p_m = Vec3::Zero();             ///< position of the tip
  double count_rad = 0.0;              ///< encoder step of the joints; 0: exact
  Vec3 lever_m = Vec3::Zero();         ///< |dp/dq_j|
  Vec3 rate_rad_per_s = Vec3::Zero();  ///< joint velocities, to interpolate between two counts
  Acted acted{};
  Mat3 tip_N_per_Nm = Mat3::Identity();  ///< J^-T: tip force from joint torques
};

/// Energy account of one hand's port (the device's tip), and the controller that keeps the account above -kFloor_J.
/// Derivation: docs/passivity.md.
///
/// Account. A torque sent in tick k acts unchanged from SYNC k+1 to SYNC k+2. So the motors' work is exact except for
/// half an encoder count, h. With E(n): account after sample n, tau_j: torque that the drive of joint j reports, dq_j:
/// the joint's motion since the last sample,
///   E(n) = E(n-1) - sum_j tau_j dq_j
/// After a lost RPDO, a drive repeats the torque before. After lost samples, dq_j spans several periods; the sum is
/// still exact if the torque was constant. Otherwise the joint is assumed to have moved evenly, and for an unknown
/// torque the worst possible value is booked. A drive that protects its winding may change the torque within a period;
/// then the worse of the commanded and the reported torque is booked. At each change of torque, half counts can hide up
/// to 2 h |tau_j(n) - tau_j(n-1)| of either sign; no reserve is kept for this. Energy above kCredit_J is discarded,
/// because otherwise an hour of harmless friction could pay for a minute of instability. The account starts at the
/// scene's energy_credit_J.
///
/// Controller. A torque that was sent cannot be taken back: one torque is still on its way when the next one is
/// decided, and the hand may reverse meanwhile. In the j-th period after the last sample, a hand whose acceleration is
/// at most a (in the device record) moves the tip by dx + e, where dx is the motion in the last period and |e| <= j a
/// T^2 + c (T: period, c: one count). So the largest loss, that is energy given to the hand, by a force F in that
/// period is
///   out_j(F) = max(0, F . dx + |F| (j a T^2 + c)).
/// A force is sent only if E stays above -kFloor_J after three losses: by all torques under way, by the force itself,
/// and by its reduction to zero in steps of the device's force_step_N. So every force that is sent can be removed
/// without a jump. A force for which E is too small is first damped against the motion (damping = shortage / (T v^2),
/// at most kMaxDamping_N_s_per_m, only at a speed v above kSlow_m_per_s), then reduced. If the account cannot pay even
/// for one period of the smallest force within a step, all force is removed at once. O(1), no allocation.
///
/// Lost frames. After a lost RPDO, further losses are anticipated: joints may make any mixture of the torques under
/// way, and the torque sent may act for two periods. Without a sample, the force continues as long as the account can
/// pay for it. In both cases, from the third period on, the acceleration bound is reduced to kLater times a, and only
/// the part of a force above kSlight_N is multiplied by the uncertainty e.
class Passivity {
 public:
  static constexpr double kFloor_J = 1e-6;
  /// Energy that 3.3 N store in a spring of 270 N/m, or 0.88 N in one of 19 N/m
  static constexpr double kCredit_J = 0.02;
  /// Largest damping that a device of this class renders stably at 1 kHz
  static constexpr double kMaxDamping_N_s_per_m = 5.0;
  static constexpr std::int64_t kWary = 10'000;  ///< ticks after a lost RPDO in which another loss is anticipated
  /// Factor on the acceleration bound after two periods without a sample
  static constexpr double kLater = 0.3;
  /// After lost frames: number of further periods of the present motion for which the account must be able to pay
  static constexpr double kMore = 3.0;
  /// A force of this size, N, needs no energy for the uncertainty of the hand's motion while frames are lost; otherwise
  /// no force could begin
  static constexpr double kSlight_N = 0.006;
  /// Speed in counts per period, below which a joint's position is estimated between two counts
  static constexpr double kSlowCounts = 0.25;
  static constexpr double kSlow_m_per_s = 5e-3;  ///< below this speed the velocity is mostly quantisation noise
  /// In no pose may a change of torque change the tip force by more than this factor times the step limit (0.52 N), so
  /// that the limit holds even if encoders are wrong
  static constexpr double kAnyPose = 1.04;

  Passivity(const device::Device& device, double period_s, bool active, double credit_J) noexcept;

  /// Call when the SYNC of `tick` has been sent.
  void begin(std::int64_t tick) noexcept {
    sent_.begin(tick);
    look_under_way(tick);
  }

  /// Adds the work done since the last sample to the account.
  void observe(std::int64_t tick, const PortSample& sample) noexcept;

  /// The force that may be sent in `tick`: as far from `before_N` (the force sent last) towards `wish_N` as the account
  /// and the step limit allow. This function only computes; sent() records what was sent.
  /// The account pays for a force if it covers the force's loss in the next period and in all further periods until the
  /// force has been reduced to zero step by step. If it pays for no force within a step, the smallest force within a
  /// step is sent, whatever the wish. If it does not cover even the next period of this smallest force, the force is
  /// zero at once, and released() is true.
  /// @param tick the present tick, at least that of the last observe()
  /// @param torque maps a tip force to the joint torques that would be sent, in whole quanta
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
    // Check whether not even the next period can be paid for.
    released_ = active_ && shortage_J(tick, tip_N_per_Nm_ * torque(least_N), false) > 0.0;
    return released_ ? Vec3(Vec3::Zero()) : least_N;
  }
  [[nodiscard]] Vec3 control(std::int64_t tick, const Vec3& wish_N, const Vec3& v, const Vec3& before_N) noexcept {
    return control(tick, wish_N, v, before_N, [](const Vec3& f_N) { return f_N; });
  }
  /// Whether sending these torques changes the tip's force at the next SYNC by at most force_step_N. Until then each
  /// joint may make the torque that its drive last reported, or any torque sent since, because each RPDO may be lost.
  /// The change is checked in the measured pose and, with the factor kAnyPose, in any pose of the workspace, in case
  /// encoders are wrong. Repeating the last torques is always allowed.
  [[nodiscard]] bool is_a_step(const Vec3& torque_Nm) const noexcept;
  /// Whether the account can pay for exactly this tip force in `tick`.
  [[nodiscard]] bool allows(std::int64_t tick, const Vec3& f_N) const noexcept {
    return !active_ || f_N.isZero(0.0) || shortage_J(tick, f_N) <= 0.0;
  }
  /// Records the torques sent in `tick`, and the tip force that they make.
  void sent(std::int64_t tick, const Vec3& torque_Nm, const Vec3& f_N) noexcept;

  /// Moves energy between the accounts of two hands that hold the same thread, because the thread carries energy from
  /// one hand to the other. An account that cannot pay for its wish gets what the other account can spare. The sum of
  /// both is unchanged.
  static void lend(std::int64_t tick, Passivity& a, const Vec3& wish_a_N, Passivity& b, const Vec3& wish_b_N) noexcept;

  /// Adds an energy allowance for a guided move; included in received_J().
  void grant(double energy_J) noexcept;
  /// End of the guided move: takes back the unused allowance.
  void revoke() noexcept;

  /// Resets the account to its start value. An encoder that jumped may have booked work that was never done, a debt
  /// which the hand could not pay back. @pre no force flows or is under way.
  void restart() noexcept {
    energy_J_ = credit_J_;
    received_J_ = granted_J_ = 0.0;
  }

  /// @param active false: the account is still computed, but never limits the force. @pre no force flows.
  void set_active(bool active) noexcept { active_ = active; }

  /// Balance of the account: energy put in by this hand, minus energy returned to it, plus what lend() and grant()
  /// added.
  [[nodiscard]] double energy_J() const noexcept { return energy_J_; }
  /// Energy added by lend() and grant() since the start
  [[nodiscard]] double received_J() const noexcept { return received_J_; }
  [[nodiscard]] double dissipated_J() const noexcept { return dissipated_J_; }
  [[nodiscard]] double injected_N_s_per_m() const noexcept { return injected_; }
  [[nodiscard]] bool acts() const noexcept { return acts_; }
  [[nodiscard]] bool stepped() const noexcept { return stepped_; }  ///< the wish was more than one step away
  /// All force was removed: the hand exceeds the acceleration bound, or frames are lost
  [[nodiscard]] bool released() const noexcept { return released_; }
  /// Whether lost frames are anticipated in this tick.
  [[nodiscard]] bool is_wary(std::int64_t tick) const noexcept { return tick > sampled_ || tick < lossy_until_; }

 private:
  static constexpr double kSpend_J = 0.95 * kFloor_J;
  static constexpr double kRounding_J = 5e-6;  // extra cost by rounding of torques: one quantum times 1 mm
  /// Range of joint torques, from low to high in each joint.
  struct Box {
    Vec3 low_Nm = Vec3::Zero(), high_Nm = Vec3::Zero();
    void take(const Vec3& torque_Nm) noexcept {
      low_Nm = low_Nm.cwiseMin(torque_Nm), high_Nm = high_Nm.cwiseMax(torque_Nm);
    }
    [[nodiscard]] Vec3 middle_Nm() const noexcept { return 0.5 * (low_Nm + high_Nm); }
    /// Maximum of a convex function of the tip force over the range of torques; it lies at a corner of the range.
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

  /// Smallest force that one step from `before_N` can reach. Tries two paths and takes the smaller result: straight
  /// towards zero, or first towards the middle of the torques under way and then towards zero.
  template <class Near>
  [[nodiscard]] Vec3 least_of(const Vec3& before_N, Near near) const noexcept {
    const Vec3 straight_N = farthest(before_N, shorter(before_N, step_N_), near);
    const Vec3 amid_N = farthest(before_N, tip_N_per_Nm_ * under_way_.middle_Nm(), near);
    const Vec3 between_N = farthest(amid_N, shorter(amid_N, step_N_), near);
    return between_N.norm() < straight_N.norm() ? between_N : straight_N;
  }

  /// The point between `from` and `to` that is nearest to `to` and satisfies `paid`, by bisection; `from` must satisfy
  /// it.
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

  double period_s_, reach_m_, step_N_;  // reach: acceleration bound times T^2
  AnyPose any_pose_;
  bool active_;
  double credit_J_, energy_J_, received_J_ = 0.0, granted_J_ = 0.0, dissipated_J_ = 0.0, injected_ = 0.0;
  // Errors of step_m_, m. count_m_: resolution of the encoders. doubt_m_: after lost samples step_m_ is a mean over
  // several periods instead of the motion in the last one
  double count_m_ = 0.0, doubt_m_ = 0.0;
  bool acts_ = false, stepped_ = false, released_ = false;
  Mat3 tip_N_per_Nm_ = Mat3::Identity(), Nm_per_tip_N_ = Mat3::Identity();
  std::int64_t sampled_ = -1, lossy_until_ = -1;
  Vec3 q_rad_ = Vec3::Zero();                            // at the last sample, interpolated between counts
  Vec3 p_m_ = Vec3::Zero(), step_m_ = Vec3::Zero();      // step: motion in the period before the last sample
  Vec3 low_Nm_ = Vec3::Zero(), high_Nm_ = Vec3::Zero();  // range of torques that acted in that period
  std::array<bool, 3> guarded_{};                        // joints whose drive limited its torque in that period
  SentTorques sent_;
  Box under_way_;                                 // torques that may act until the next SYNC
  double under_way_J_ = 0.0, under_way_N_ = 0.0;  // largest energy loss by under_way_, and its largest tip force
};

}  // namespace ligature::control
