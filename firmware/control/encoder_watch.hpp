#pragma once
// Detects an encoder that freezes or begins to count backwards. It must do so at that moment, because later the
// readings look plausible.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "firmware/control/faults.hpp"
#include "firmware/control/mirrored_turn.hpp"

namespace ligature::control {

/// Checks one hand's three encoders. A hand is a mass on a spring, so no joint changes its speed abruptly from one
/// period to the next. A faulty encoder does: it begins to count backwards (mirrored_turn.hpp), or it freezes. Two
/// tests find a frozen encoder.
///
/// Frozen in motion. In a window of kWindow samples the joint moved evenly (within one count of a straight line) at
/// kBrisk or faster. In the next window its reading does not change by a single count, while another joint moves on at
/// unchanged speed. A joint may simply have stopped, so the fault is reported only if the reading stays constant until
/// the other joints have travelled kTravel. A gap between samples restarts this test.
///
/// Frozen at rest. The reading has not changed by a count, although the joint's torque has varied by kPushed of the
/// rated torque and the other joints have travelled kElsewhere. Only a clenched hand that pulls hard is that stiff
/// (docs/measurements/fault-matrix.md).
///
/// Near its stops a joint may really stand still, so it is not tested there. A reversal at rest is found only by a
/// guided move (move_check.hpp), or because the pose becomes impossible. O(kWindow), no allocation.
class EncoderWatch {
 public:
  static constexpr std::size_t kJoints = 3, kWindow = 24, kLength = 128;
  /// Thresholds in counts per period. kMoving: least speed of another joint that moves on. kBrisk: least speed of the
  /// suspected joint. kSame: largest change of the other joint's speed.
  static constexpr double kMoving = 0.34, kBrisk = 0.8, kSame = 0.17;
  static constexpr double kTravel = 60.0;      ///< counts, about 3 mm at the tip
  static constexpr double kElsewhere = 300.0;  ///< counts
  static constexpr int kRested = 100;          ///< samples; a hand that turns round needs fewer
  /// Share of the rated torque. For an Omni this is 0.4 N at the tip, four times its friction.
  static constexpr double kPushed = 0.2;

  /// Adds a sample, in counts.
  /// @param gap whole periods since the last sample
  /// @param free for each joint: whether it is far from its stops
  /// @param torque acting on each joint, as a share of the rated torque
  /// @return the fault found; the caller latches it
  [[nodiscard]] JointFault add(const std::array<double, kJoints>& counts, std::int64_t gap,
                               const std::array<bool, kJoints>& free,
                               const std::array<double, kJoints>& torque = {}) noexcept {
    if (const std::size_t stands = stands_under_torque(counts, free, torque); stands < kJoints)
      return fault_of_joint(Fault::kEncoderFrozen, stands);
    if (gap != 1) count_ = 0, suspect_ = kJoints;
    newest_ = (newest_ + 1) % kLength;
    for (std::size_t j = 0; j < kJoints; ++j) x_[j][newest_] = counts[j];
    count_ = std::min(count_ + 1, kLength);
    if (count_ >= 2 * kWindow && is_frozen(free)) return fault_of_joint(Fault::kEncoderFrozen, suspect_);
    const Reversal found = reversal(free);
    return found.strength >= 1.0 ? fault_of_joint(Fault::kAxisReversed, found.joint) : JointFault{};
  }

  /// How strongly the newest samples look like an encoder that has begun to count backwards; from 1 on, this counts as
  /// a fault. `strength` is the speed at the suspected turn (MirroredTurn::speed()) divided by the least speed at which
  /// the test is reliable; the largest over all joints and window lengths, found at `joint`.
  struct Reversal {
    double strength = 0.0;
    std::size_t joint = 0;
  };
  [[nodiscard]] Reversal reversal(const std::array<bool, kJoints>& free) const noexcept {
    Reversal most;
    for (std::size_t j = 0; j < kJoints; ++j) {
      for (const MirroredTurn::Look& look : MirroredTurn::kLooks) {
        if (!free[j] || count_ < 2 * look.half) continue;
        const double share = MirroredTurn::speed([&](std::size_t ago) { return at(j, ago); }, look) / look.moving;
        if (share > most.strength && (look.alone || other_moves_on(j))) most = {share, j};
      }
    }
    return most;
  }

 private:
  struct Line {
    double slope = 0.0;
    bool straight = false;
  };

  /// What has happened since a joint's reading last changed: the range of the joint's torque (`low` to `high`), and the
  /// travel of the other joints (`elsewhere`).
  struct Rest {
    double count = 0.0, low = 0.0, high = 0.0, elsewhere = 0.0;
    int samples = 0;
  };
  /// Test "frozen at rest". @return the joint, or kJoints
  [[nodiscard]] std::size_t stands_under_torque(const std::array<double, kJoints>& counts,
                                                const std::array<bool, kJoints>& free,
                                                const std::array<double, kJoints>& torque) noexcept {
    double travel = 0.0;
    for (std::size_t j = 0; j < kJoints; ++j) travel += std::abs(counts[j] - last_[j]);
    if (!seen_) travel = 0.0;
    std::size_t stands = kJoints;
    for (std::size_t j = 0; j < kJoints; ++j) {
      Rest& r = rest_[j];
      if (!seen_ || counts[j] != r.count || !free[j]) r = {counts[j], torque[j], torque[j], 0.0, 0};
      r.low = std::min(r.low, torque[j]);
      r.high = std::max(r.high, torque[j]);
      r.elsewhere += travel;
      ++r.samples;
      if (r.high - r.low < kPushed || r.elsewhere < kElsewhere || r.samples < kRested) continue;
      stands = std::min(stands, j);
      r = {counts[j], torque[j], torque[j], 0.0, 0};  // reported; the test starts again from here
    }
    last_ = counts;
    seen_ = true;
    return stands;
  }

  [[nodiscard]] double at(std::size_t joint, std::size_t ago) const noexcept {
    return x_[joint][(newest_ + kLength - ago) % kLength];
  }

  /// Straight line through the first and the last sample of a window of kWindow samples, whose last one is `ago`
  /// samples old. `straight` tells whether all samples between lie within one count of the line.
  [[nodiscard]] Line line(std::size_t joint, std::size_t ago) const noexcept {
    constexpr double kSteps = kWindow - 1;
    const double first = at(joint, ago + kWindow - 1);
    Line l{(at(joint, ago) - first) / kSteps, true};
    for (std::size_t i = 1; i < kWindow - 1; ++i) {
      const double off = at(joint, ago + kWindow - 1 - i) - (first + l.slope * static_cast<double>(i));
      l.straight = l.straight && std::abs(off) <= 1.0 + 1e-9;
    }
    return l;
  }

  /// Whether another joint has the same speed in the earlier and the later window.
  [[nodiscard]] bool other_moves_on(std::size_t joint) const noexcept {
    for (std::size_t k = 0; k < kJoints; ++k) {
      if (k == joint) continue;
      const Line before = line(k, kWindow), after = line(k, 0);
      if (std::abs(before.slope) >= kMoving && std::abs(after.slope - before.slope) <= kSame) return true;
    }
    return false;
  }

  /// Test "frozen in motion". First suspects a joint that stops abruptly; then reports it if the other joints travel
  /// far enough while its reading stays the same. @param free joints that are not at a stop
  [[nodiscard]] bool is_frozen(const std::array<bool, kJoints>& free) noexcept {
    if (suspect_ < kJoints) {
      if (at(suspect_, 0) != at(suspect_, 1)) {
        suspect_ = kJoints;
        return false;
      }
      for (std::size_t k = 0; k < kJoints; ++k) travel_ += std::abs(at(k, 0) - at(k, 1));
      return travel_ >= kTravel;
    }
    for (std::size_t j = 0; j < kJoints; ++j) {
      if (!free[j] || !is_constant(j)) continue;  // most joints are excluded here, which saves time
      const Line before = line(j, kWindow);
      if (before.straight && std::abs(before.slope) >= kBrisk && other_moves_on(j)) {
        suspect_ = j;
        travel_ = 0.0;
      }
    }
    return false;
  }

  [[nodiscard]] bool is_constant(std::size_t joint) const noexcept {
    for (std::size_t i = 1; i < kWindow; ++i) {
      if (at(joint, i) != at(joint, 0)) return false;
    }
    return true;
  }

  std::array<Rest, kJoints> rest_{};
  std::array<double, kJoints> last_{};
  bool seen_ = false;
  std::array<std::array<double, kLength>, kJoints> x_{};
  std::size_t newest_ = 0, count_ = 0, suspect_ = kJoints;
  double travel_ = 0.0;
};

}  // namespace ligature::control
