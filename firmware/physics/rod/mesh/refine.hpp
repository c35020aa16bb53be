#pragma once
// Remeshing: a fixed number of nodes is moved along the thread, by merging two segments here and splitting one there.

#include <cstdint>
#include <span>
#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/contact/contact_set.hpp"
#include "firmware/physics/rod/tuning.hpp"

namespace ligature::physics::rod {

/// A dyadic mesh: every segment has the length unit x 2^k, 0 <= k <= kLevels, where unit is about a diameter.
/// The wanted length of a segment is at least a unit; else the smallest of
///   0.35 / curvature,
///   0.4 sqrt(EI / T) at a contact, the length over which a pulled thread bends; T the larger of force and tension,
///   the wanted length at another place + 0.2 x the distance to it (grading),
///   the wanted length of the segment it touches, if the contact is at rest; twice that while it slides slowly.
/// Each change merges one pair of segments and splits another segment: the one that is longest relative to its wanted
/// length, if its ratio is clearly worse than that of the merged pair. Effects on the state:
/// - a split puts its node on the chord, so shape, gaps and stretch stay the same;
/// - a merge distributes the node's momentum to its neighbours; held, loaded and touching nodes are not merged;
/// - a merge is refused when something is so near that the segments could touch or cross it on the way to the chord
///   (merge_is_clear);
/// - bending moments and tensions are kept: the difference that the new polygon makes is stored as a stress-free
///   offset (State::rest_bend, rest_strain), which fades within some ticks, faster where the thread moves;
/// - a split keeps the smooth curve (smooth.hpp) by changed State::cut_before, cut_after, which fade likewise.
class Refine {
 public:
  /// Initial mesh of n nodes: the coarsest segments, then the longest one is halved until there are n nodes. With
  /// curvature_per_m, sampled at equal distances along the thread, longest means relative to the wanted length there.
  /// @param wanted_m  approximate unit, m. @return false when n is too small or too large for the thread's length.
  bool start(const Material& material, double wanted_m, State& state, std::span<const double> curvature_per_m = {});

  /// Before update(): computes the factors by which the stress-free offsets fade in this tick, from the nodes' speeds.
  /// With `drifts` the mean velocity does not count, as for a thread that falls or flies as a whole.
  void slide(const State& state, double tick_s, bool drifts) noexcept;
  /// After slide(): weakens the fading where needed so that it raises the elastic energy by no more than allowance_J.
  /// `born` is the part of State::rest_bend that does not fade, or empty. @return upper bound of the energy change, J.
  double hold_back(const Material& material, const State& state, std::span<const Vec> born,
                   double allowance_J) noexcept;
  [[nodiscard]] std::span<const double> fade() const noexcept { return fade_; }

  /// Multiplies the stress-free offsets by the factors that slide() and hold_back() have computed.
  void fade_offsets(State& state) const noexcept;

  /// Merges and splits segments for one tick, with at most an eighth of the tick's work budget. @return true when nodes
  /// moved. O(n); no allocation.
  bool update(const Material& material, State& state, const Forces& forces, ContactSet& contacts,
              const std::vector<Body>& bodies, Work& work) noexcept;

  /// Call after update() returned true and the mesh was rebuilt: sets the offsets so that moments and tensions stay.
  void keep_stress(const Material& material, State& state) noexcept;

  static constexpr int kLevels = 4;
  LIGATURE_MEMBERS(Refine, unit_m, at, wanted, free, moment, fade, strain_fade, tension)

 private:
  void want(const Material& material, const State& state, const Forces& forces, const ContactSet& contacts) noexcept;
  void grade(const Mesh& mesh) noexcept;
  void want_at_rest(const State& state, const ContactSet& contacts) noexcept;
  [[nodiscard]] int worst_segment() const noexcept;
  /// The node whose two segments, merged into one, would have the smallest ratio of length to wanted length. @return -1
  /// when no ratio is below `most`.
  [[nodiscard]] int cheapest_merge(double most) const noexcept;
  /// As cheapest_merge(), but only nodes that pass merge_is_clear(); the others are marked as not free.
  int best_merge(const Material& material, const State& state, const std::vector<Body>& bodies, double most) noexcept;
  void merge(const Material& material, State& state, int node) noexcept;
  void split(const Material& material, State& state, int segment) noexcept;

  double unit_m_ = 0.0;
  std::vector<std::int32_t> at_;     // material coordinates of nodes, in mesh units
  std::vector<double> wanted_;       // per segment, m
  std::vector<char> free_;           // may this node be removed by a merge?
  std::vector<Vec> moment_;          // bending moment Q of every vertex
  std::vector<double> fade_;         // factors of the offsets at nodes, in this tick
  std::vector<double> strain_fade_;  // factors of the strain offsets of segments
  std::vector<double> tension_;
};

/// Can segments node - 1 and node be replaced by their chord without touching anything? Each of their points then moves
/// by at most h, the distance between the node and the chord's point with the same material coordinate. So anything
/// farther away than h cannot be crossed. The test demands h + the distance of touch, so that no overlap arises either.
/// For neighbours along the thread, which are always near, it demands only h. O(n); a bounding sphere excludes most
/// segments.
[[nodiscard]] bool merge_is_clear(const Material& material, const State& state, const std::vector<Body>& bodies,
                                  std::size_t node) noexcept;

}  // namespace ligature::physics::rod
