#pragma once
// A contact, the bodies that the thread can touch, and what is kept of all contacts from substep to substep.

#include <cstdint>
#include <tuple>
#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/rod/contact/pair_search.hpp"
#include "firmware/physics/rod/solve/contact_newton.hpp"

namespace ligature::physics::rod {

/// A rigid capsule in the world: a peg or a gripper. (The floor plane is Rod::floor_m.)
struct Body {
  Vec p0{}, p1{};  ///< axis, m
  double radius_m = 0.0;
  Vec velocity{};
  double friction = 0.3;
  Vec spin{};  ///< of a drum: unit vector along the axis, times the speed at which the surface turns, m/s
  LIGATURE_MEMBERS(Body, p0, p1, radius_m, velocity, friction, spin)
};

/// Pointer into a list of the same object. In a copy of the object it is null, because it would point into the
/// original's list.
template <class T>
class Borrowed {
 public:
  Borrowed() = default;
  Borrowed(const Borrowed&) noexcept {}
  Borrowed& operator=(const Borrowed& other) noexcept {
    if (this != &other) at_ = nullptr;
    return *this;
  }
  Borrowed(Borrowed&&) noexcept = default;
  Borrowed& operator=(Borrowed&&) noexcept = default;
  ~Borrowed() = default;
  Borrowed& operator=(T* at) noexcept { return at_ = at, *this; }
  [[nodiscard]] T& operator*() const noexcept { return *at_; }
  [[nodiscard]] T* operator->() const noexcept { return at_; }
  [[nodiscard]] explicit operator bool() const noexcept { return at_ != nullptr; }

 private:
  T* at_ = nullptr;
};

/// One contact. The relative velocity of its two points is u = sum_k w_k v[node_k] - surface (v: velocities of all
/// nodes); the impulse p acts on node k as w_k p. In a contact of the thread with itself, nodes 0 to 3 are the ends of
/// the two segments; further nodes are those on which the points of the smooth curves also depend (smooth.hpp).
struct Contact {
  static constexpr int kMostNodes = ContactNewton::kMostNodes;
  std::int32_t node[kMostNodes] = {};
  double w[kMostNodes] = {};
  Vec n{};                  ///< unit normal: u . n > 0 separates
  Vec surface{};            ///< velocity of the body's surface, m/s
  Vec p{};                  ///< impulse, N s; p . n >= 0
  Vec u_free{};             ///< u if no contact had an impulse
  double gap_m = 0.0;       ///< surface distance, negative: overlap
  double target = 0.0;      ///< smallest admissible normal velocity, m/s
  double inv_w = 0.0;       ///< 1 / (J C^-1 J^T): effective mass with the sweeps' matrix C (contact_metric.hpp), kg
  double soft = 0.0;        ///< normal compliance: u_n + soft p_n >= target, 1/kg
  double inv_soft_w = 0.0;  ///< 1 / (J C^-1 J^T + soft)
  double mu = 0.0;
  std::int32_t first = 0, last = 0;     ///< lowest and highest node index
  std::int32_t count = 4;               ///< nodes in use
  double reach_m = 0.0;                 ///< distance of the centrelines at which the pair touches
  double distance_m = 0.0;              ///< distance of the chords, for the guard
  bool loaded = false;                  ///< has carried an impulse in this substep
  Borrowed<Vec> keep;                   ///< storage of the impulse between substeps
  Borrowed<Candidate> pair;             ///< its pair in the list, if the thread touches itself
  Borrowed<char> stuck;                 ///< storage between substeps: did static friction hold?
  std::int32_t place[kMostNodes] = {};  ///< indices of the nodes in SweptVelocities
  float weight[kMostNodes] = {};        ///< w in single precision
  /// The members that an image saves (image.hpp): all but the pointers, which are valid only within one substep.
  [[nodiscard]] static auto members(Contact& self) noexcept {
    auto& [node, w, n, surface, p, u_free, gap_m, target, inv_w, soft, inv_soft_w, mu, first, last, count, reach_m,
           distance_m, loaded, keep, pair, stuck, place, weight] = self;
    return std::tie(node, w, n, surface, p, u_free, gap_m, target, inv_w, soft, inv_soft_w, mu, first, last, count,
                    reach_m, distance_m, loaded, place, weight);
  }

  [[nodiscard]] bool is_pair() const noexcept { return count >= 4; }
};

/// Data that a ContactSet keeps from substep to substep. A copy takes over all of it.
class ContactMemory {
 public:
  /// Thread-thread pairs that may touch; rebuilt by BroadPhase.
  std::vector<Candidate> pairs;
  std::vector<PairGroup> groups;
  std::vector<Vec> floor_impulse;  ///< per node
  std::vector<Vec> body_impulse;   ///< per body and segment
  std::vector<char> floor_stuck, body_stuck;
  LIGATURE_MEMBERS(ContactMemory, pairs, groups, floor_impulse, body_impulse, floor_stuck, body_stuck, contacts,
                   per_second, rows)

 protected:
  std::vector<Contact> contacts_;  // of the last substep: rows first, then contacts that are not solved
  double per_second_ = 0.0;
  int rows_ = 0;
};

}  // namespace ligature::physics::rod
