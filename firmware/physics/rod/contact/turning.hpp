#pragma once
// Friction that rolls the thread: at a contact, friction exerts a torque on a segment, and a segment that turns about
// its axis moves its surface.

#include <vector>

#include "firmware/physics/rod/model/spin.hpp"

namespace ligature::physics::rod {

struct Contact;

/// Contacts of segments that roll. A segment of radius r and tangent t that turns at the rate w (rad/s) moves its
/// surface, at a contact with normal n, at the velocity w t x (-r n), on either side of the contact. So the slip
/// velocity gains
///   w g,  with g = -r t x n,
/// and the impulse p gives the segment the torque impulse g . p. g is perpendicular to n, so only friction is affected.
/// Each impulse updates the rates of all segments in range at once and exactly (Spin::push()), so a sweep is
/// Gauss-Seidel in the rates too.
class Turning {
 public:
  void reserve(int rows) { rows_.reserve(static_cast<std::size_t>(rows)); }

  /// Computes g (class comment) for each of `contacts`. @param radius_m radius of the thread. @pre spin.assemble() was
  /// called.
  void prepare(const Contact* contacts, int count, int segments, double radius_m, Spin& spin) noexcept;
  /// Reduces Contact::inv_w (effective mass) by the segments' response in roll, so that tangential steps cannot
  /// overshoot.
  void shorten_steps(Contact* contacts) const noexcept;

  /// Contribution of the segments' rotation to the relative velocity of row k.
  [[nodiscard]] Vec slip(int k) const noexcept {
    const Row& row = rows_[k];
    return spin_->rate(row.segment[0]) * row.g[0] + spin_->rate(row.segment[1]) * row.g[1];
  }
  void push(int k, Vec impulse) noexcept {
    const Row& row = rows_[k];
    for (int e = 0; e < row.count; ++e) spin_->push(row.segment[e], dot(row.g[e], impulse), first_, last_);
  }
  void save() noexcept { spin_->save(first_, last_); }
  void restore() noexcept { spin_->restore(first_, last_); }

  /// Additional cost of a pass, in instructions (work.hpp).
  [[nodiscard]] long price(int rows) const noexcept { return rows * (60 + 8L * (last_ - first_ + 1)); }

 private:
  struct Row {
    std::int32_t segment[2] = {0, 0};
    int count = 1;
    double answer = 0.0;  // upper bound of the slip velocity per unit of friction impulse, 1/kg
    Vec g[2];
  };
  Spin* spin_ = nullptr;
  std::vector<Row> rows_;
  int first_ = 0, last_ = 0;  // range of the segments that have contacts
};

}  // namespace ligature::physics::rod
