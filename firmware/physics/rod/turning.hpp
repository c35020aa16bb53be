#pragma once
// Contacts that turn the segments they touch: the surface of a rolling thread moves, and friction there is a torque.

#include <vector>

#include "firmware/physics/rod/spin.hpp"

namespace ligature::physics::rod {

struct Contact;

/// At a contact with normal n a segment's surface moves with v + w t x (-r n), whichever side it is on: the slip gains
///   w g,  g = -r t x n,   and the impulse p gives the segment the torque impulse g . p.
/// g is across n, so only friction knows of it. Rates answer every push exactly, along the whole thread (Spin::push): a
/// sweep is Gauss-Seidel in them too.
class Turning {
 public:
  void reserve(int rows) { rows_.reserve(static_cast<std::size_t>(rows)); }

  /// One row for each of `contacts`. @param radius_m of the thread. The spin must be assembled.
  void prepare(const Contact* contacts, int count, int segments, double radius_m, Spin& spin) noexcept;
  /// Makes their tangential steps so small that they cannot over-shoot with the segments' answers added.
  void shorten_steps(Contact* contacts) const noexcept;

  /// What spinning adds to the relative velocity of row k.
  [[nodiscard]] Vec slip(int k) const noexcept {
    const Row& row = rows_[static_cast<std::size_t>(k)];
    return spin_->rate(row.segment[0]) * row.g[0] + spin_->rate(row.segment[1]) * row.g[1];
  }
  void push(int k, Vec impulse) noexcept {
    const Row& row = rows_[static_cast<std::size_t>(k)];
    for (int e = 0; e < row.count; ++e) spin_->push(row.segment[e], dot(row.g[e], impulse), first_, last_);
  }
  void save() noexcept { spin_->save(first_, last_); }
  void restore() noexcept { spin_->restore(first_, last_); }

  /// What a pass costs more, in instructions (work.hpp).
  [[nodiscard]] long price(int rows) const noexcept { return rows * (60 + 8L * (last_ - first_ + 1)); }

 private:
  struct Row {
    std::int32_t segment[2] = {0, 0};
    int count = 1;
    double answer = 0.0;  // how fast a unit of friction turns them, at most
    Vec g[2];
  };
  Spin* spin_ = nullptr;
  std::vector<Row> rows_;
  int first_ = 0, last_ = 0;  // segments
};

}  // namespace ligature::physics::rod
