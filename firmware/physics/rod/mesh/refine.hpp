#pragma once
// Remeshing: moves nodes along the thread to where short segments are needed, by merging two segments in one place and
// splitting one in another. The number of nodes stays the same.

#include <cstdint>
#include <span>
#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/contact/contact_set.hpp"
#include "firmware/physics/rod/tuning.hpp"

namespace ligature::physics::rod {

/// A dyadic mesh: every segment has the length unit x 2^k, 0 <= k <= kLevels, where unit is about a diameter. The
/// wanted length of a segment is at least a unit, and otherwise the smallest of
///   0.35 / curvature,
///   0.4 sqrt(EI / T) at a contact: the length over which a pulled thread bends (EI: bending stiffness, T: the
///       larger of contact force and tension),
///   the wanted length at another place + 0.2 x the distance to that place (grading),
///   the wanted length of the segment that it touches, if the contact is at rest. If that is a unit, both get 0.7
///       units: no segment becomes so short, but these are split before others.
/// Each change splits the segment that is longest relative to its wanted length, and merges the pair of segments that
/// would be shortest relative to theirs, if this clearly improves the worst ratio. Effects on the state:
/// - a split puts its node on the chord, so shape, gaps and stretch stay the same;
/// - a split keeps the smooth curve (smooth.hpp) by changes of State::cut_before and cut_after, which fade;
/// - a merge distributes the node's momentum to its neighbours; held, loaded and touching nodes are not merged;
/// - a merge is refused if something is so near that the segments could touch or cross it on the way to their chord
///   (merge_is_clear());
/// - bending moments and tensions are kept: the difference that the new polygon makes is stored as a stress-free offset
///   (State::rest_bend, rest_strain). The offsets fade within some ticks; those of bends faster where the thread moves.
class Refine {
 public:
  /// Makes the initial mesh of n nodes: starts with the coarsest segments, and halves the longest one until there are n
  /// nodes. With curvature_per_m (sampled at equal distances along the thread), "longest" is relative to the wanted
  /// length there.
  /// @param wanted_m  approximate unit, m. @return false if n is too small or too large for the thread's length.
  bool start(const Material& material, double wanted_m, State& state, std::span<const double> curvature_per_m = {});

  /// Call before update(). Computes from the nodes' speeds the factors by which the stress-free offsets fade in this
  /// tick. With `drifts`, the mean velocity does not count, because the thread falls or flies as a whole.
  void slide(const State& state, double tick_s, bool drifts) noexcept;
  /// Call after slide(). Weakens the fading where needed, so that it raises the elastic energy by at most allowance_J.
  /// `born` is the part of State::rest_bend that does not fade, or empty. @return upper bound of the energy change, J.
  double hold_back(const Material& material, const State& state, std::span<const Vec> born,
                   double allowance_J) noexcept;
  [[nodiscard]] std::span<const double> fade() const noexcept { return fade_; }

  /// Multiplies the stress-free offsets by the factors that slide() and hold_back() have computed.
  void fade_offsets(State& state) const noexcept;

  /// Merges and splits segments for one tick, as far as its work budget lasts.
  /// @return true when nodes moved. O(n); no allocation.
  bool update(const Material& material, State& state, const Forces& forces, ContactSet& contacts,
              const std::vector<Body>& bodies, Work& work) noexcept;

  /// Call after update() returned true and the mesh was rebuilt: sets the offsets so that bending moments and tensions
  /// stay the same.
  void keep_stress(const Material& material, State& state) noexcept;

  static constexpr int kLevels = 4;
  LIGATURE_MEMBERS(Refine, unit_m, at, wanted, free, moment, fade, strain_fade, tension)

 private:
  void want(const State& state, const Forces& forces, const ContactSet& contacts) noexcept;
  void grade(const Mesh& mesh) noexcept;
  void want_at_rest(const State& state, const ContactSet& contacts) noexcept;
  [[nodiscard]] int worst_segment() const noexcept;
  /// The node whose two segments, merged into one, would have the smallest ratio of length to wanted length. @return -1
  /// when no ratio is below `most`.
  [[nodiscard]] int cheapest_merge(double most) const noexcept;
  void merge(const Material& material, State& state, int node) noexcept;
  void split(State& state, int segment) noexcept;

  double unit_m_ = 0.0;
  std::vector<std::int32_t> at_;     // material coordinates of nodes, in mesh units
  std::vector<double> wanted_;       // per segment, m
  std::vector<char> free_;           // may this node be removed by a merge?
  std::vector<Vec> moment_;          // bending moment Q of every vertex
  std::vector<double> fade_;         // factors of the offsets at nodes, in this tick
  std::vector<double> strain_fade_;  // factors of the strain offsets of segments
  std::vector<double> tension_;
};

/// Can the segments node - 1 and node be replaced by their common chord without touching anything? Each of their points
/// then moves by at most h, the distance between the node and the chord's point with the same material coordinate. So
/// nothing farther away than h can be crossed. The test demands a distance of h plus the distance of touch, so that no
/// overlap arises either; for neighbours along the thread, which are always near, it demands only h. O(n); a bounding
/// sphere excludes most segments.
[[nodiscard]] bool merge_is_clear(const Material& material, const State& state, const std::vector<Body>& bodies,
                                  std::size_t node) noexcept;

}  // namespace ligature::physics::rod
