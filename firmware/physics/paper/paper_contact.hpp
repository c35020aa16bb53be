#pragma once

#include "firmware/physics/members.hpp"
#include "firmware/physics/paper/broad_phase.hpp"
#include "firmware/physics/paper/repulsion.hpp"
#include "firmware/physics/paper/thread.hpp"

namespace ligature::physics {

/// The paper's self-contact (section V.A, equations (1)-(3) and (18)-(22)), for comparison: every overlapping pair gets
/// an impulse for repulsion and friction, and is then shifted apart. Because it acts only after an overlap has arisen,
/// fast strands pass through each other; the implicit solver (contact.hpp) avoids that.
struct PaperContactSettings {
  Repulsion repulsion;
  double stick = 10.0, slip = 10.0;
  int skip = 2;
  bool capped = true;  ///< no attraction, and friction at most stops the slip; false: as printed in the paper
  LIGATURE_MEMBERS(PaperContactSettings, repulsion, stick, slip, skip, capped)
};

class PaperContact {
 public:
  PaperContact() = default;
  PaperContact(const ThreadModel& model, const PaperContactSettings& settings);

  /// For each overlapping pair in turn: applies the contact impulse to velocities and the separation to positions.
  void solve(const ThreadModel& model, ThreadState& state) noexcept;

  /// Clears the reported values.
  void forget() noexcept {
    active_ = 0;
    min_gap_m_ = 0.0;
    pairs_.overflow = false;
  }
  [[nodiscard]] int active() const noexcept { return active_; }
  [[nodiscard]] double min_gap_m() const noexcept { return min_gap_m_; }
  [[nodiscard]] bool cap_hit() const noexcept { return pairs_.overflow; }
  LIGATURE_MEMBERS(PaperContact, settings, spheres, pairs, active, min_gap_m)

 private:
  void respond(const ThreadModel& model, ThreadState& state, const SegmentPair& pair) noexcept;

  PaperContactSettings settings_;
  SegmentSpheres spheres_;
  PairList pairs_;
  int active_ = 0;
  double min_gap_m_ = 0.0;
};

}  // namespace ligature::physics
