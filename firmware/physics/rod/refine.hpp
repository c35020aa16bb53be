#pragma once
// Nodes where they are needed: a fixed number of them, moved along the thread by splitting here and merging there.

#include <cstdint>
#include <span>
#include <vector>

#include "firmware/physics/rod/contact.hpp"

namespace ligature::physics::rod {

/// A dyadic mesh: every segment is unit x 2^k long, unit being the finest wanted (about a diameter), 0 <= k <= kLevels.
/// Wanted length of a segment, the least of
///   0.35 / curvature,
///   0.4 sqrt(EI / T) at a contact, T its force or the tension: the length over which a pulled thread bends away,
///   the wanted length of a place nearby + 0.2 x distance (grading),
///   that of the place it lies against, however lightly, when it lies still; twice that while it slides slowly,
/// and never below a unit. Where the longest segment, relative to what is wanted, is much worse off than a merged pair
/// elsewhere would be, that pair is merged and the segment split. Nothing jumps:
/// - a new node lies on the chord of its segment, so the thread's shape, gaps and stretch are untouched;
/// - a merge shares the node's momentum out, and only nearly straight, free nodes away from contacts are merged;
/// - a merge is refused when anything is so near that the two segments could pass or touch it on their way to the chord
///   (merge_is_clear);
/// - bending moments and tension stay what they were: what the new polygon would change is kept as a stress-free offset
///   (State::rest_bend, rest_strain) that fades within some ticks, sooner where the thread moves;
/// - a split leaves the smooth curve where it is (smooth.hpp): corners are cut as far as before, which fades likewise.
class Refine {
 public:
  /// Lays out n nodes: units for the finest length wanted_m, coarse segments, then splits of the longest; of the
  /// longest for its curvature, where that is given, at places equally far apart along the whole thread.
  /// @return false when n is too small or too large for the length.
  bool start(const Material& material, double wanted_m, State& state, std::span<const double> curvature_per_m = {});

  /// Before update(): how far nodes went in a tick, and so how much of their offsets is left. A thread that `drifts`
  /// falls or flies as a whole: that is no way along anything.
  void slide(const State& state, double tick_s, bool drifts) noexcept;
  /// The same: fading may raise the energy by no more than allowance_J. `born` is the part of State::rest_bend that
  /// does not fade, or empty. @return by how much it does, or less than that: what is lower by it is given away.
  double hold_back(const Material& material, const State& state, std::span<const Vec> born,
                   double allowance_J) noexcept;
  [[nodiscard]] std::span<const double> fade() const noexcept { return fade_; }

  /// Offsets become what is left of them.
  void fade_offsets(State& state) const noexcept;

  /// One tick's worth of changes, an eighth of its work at most. @return true when nodes moved. O(n); no allocation.
  bool update(const Material& material, State& state, const Forces& forces, ContactSet& contacts,
              const std::vector<Body>& bodies, Work& work) noexcept;

  /// After update() returned true and the mesh was rebuilt: offsets that keep moments and tensions.
  void keep_stress(const Material& material, State& state) noexcept;

  static constexpr int kLevels = 4;
  static constexpr double kFade = 0.8;  ///< of the offsets, per tick, where nothing moves
  static constexpr int kChangesPerTick = 6;

 private:
  void want(const Material& material, const State& state, const Forces& forces, const ContactSet& contacts) noexcept;
  void grade(const Mesh& mesh) noexcept;
  void want_at_rest(const State& state, const ContactSet& contacts) noexcept;
  [[nodiscard]] int worst_segment() const noexcept;
  /// Node whose merged pair is least too long, below `most` times what is wanted. @return -1 when there is none.
  [[nodiscard]] int cheapest_merge(double most) const noexcept;
  /// The same among those that may be merged; the others are struck off on the way.
  int best_merge(const Material& material, const State& state, const std::vector<Body>& bodies, double most) noexcept;
  void merge(const Material& material, State& state, int node) noexcept;
  void split(const Material& material, State& state, int segment) noexcept;

  double unit_m_ = 0.0;
  std::vector<std::int32_t> at_;     // node positions in units
  std::vector<double> wanted_;       // per segment, m
  std::vector<char> free_;           // node may be merged
  std::vector<Vec> moment_;          // Q of every vertex
  std::vector<double> fade_;         // of what is kept at a node, in this tick
  std::vector<double> strain_fade_;  // and in a segment
  std::vector<double> tension_;
};

/// May segments node - 1 and node become their chord? Every point of them then moves by at most h, the distance of the
/// node from the chord's material middle. So what is farther than h from both cannot be passed; asked for is h + the
/// distance of touch, so that no contact begins with an overlap either. Neighbours along the thread, which are always
/// near, need more than h alone. O(n), a bounding sphere for most.
[[nodiscard]] bool merge_is_clear(const Material& material, const State& state, const std::vector<Body>& bodies,
                                  std::size_t node) noexcept;

}  // namespace ligature::physics::rod
