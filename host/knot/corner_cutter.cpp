#include "host/knot/corner_cutter.hpp"

#include <Eigen/Geometry>
#include <cstdint>

namespace ligature::knot {
namespace {

using Box = Eigen::AlignedBox3d;
using Slot = std::int32_t;
constexpr Slot kNone = -1;
constexpr std::size_t kBlock = 16;

/// One pass over the polyline. Corners keep their slot number; a removed corner leaves an empty slot.
class Pass {
 public:
  Pass(std::span<const Point> corners, bool closed, std::span<const Bar> bars)
      : corners_(corners), closed_(closed), bars_(bars), left_(corners.size()) {
    const auto n = static_cast<Slot>(corners.size());
    for (Slot i = 0; i < n; ++i) {
      before_.push_back(i > 0 ? i - 1 : closed ? n - 1 : kNone);
      after_.push_back(i + 1 < n ? i + 1 : closed ? 0 : kNone);
    }
    gone_.resize(corners.size(), false);
    boxes_.resize((corners.size() + kBlock - 1) / kBlock);
    for (Slot i = 0; i < n; ++i) enclose(i);
  }

  /// @return the remaining corners.
  std::vector<Point> run() {
    const std::size_t fewest = closed_ ? 3 : 2;
    for (Slot b = 0; b < static_cast<Slot>(corners_.size()) && left_ > fewest; ++b) {
      const Slot a = before(b), c = after(b);
      if (a == kNone || c == kNone || is_pierced(a, b, c)) continue;
      after_[index(a)] = c;
      before_[index(c)] = a;
      gone_[index(b)] = true;
      --left_;
      enclose(a);
    }
    std::vector<Point> rest;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      if (!gone_[i]) rest.push_back(corners_[i]);
    }
    return rest;
  }

 private:
  static std::size_t index(Slot slot) { return static_cast<std::size_t>(slot); }
  [[nodiscard]] const Point& at(Slot slot) const { return corners_[index(slot)]; }
  [[nodiscard]] Slot before(Slot slot) const { return slot == kNone ? kNone : before_[index(slot)]; }
  [[nodiscard]] Slot after(Slot slot) const { return slot == kNone ? kNone : after_[index(slot)]; }

  /// Extends the box of this slot's block by the edge that starts at the slot.
  void enclose(Slot start) {
    Box& box = boxes_[index(start) / kBlock];
    box.extend(at(start));
    if (after(start) != kNone) box.extend(at(after(start)));
  }

  [[nodiscard]] bool is_pierced(Slot a, Slot b, Slot c) const {
    const Triangle triangle{at(a), at(b), at(c)};
    Box near(triangle.a);
    near.extend(triangle.b).extend(triangle.c);
    const Point margin = 1e-8 * near.sizes();
    near.extend(Point(near.min() - margin)).extend(Point(near.max() + margin));
    // Not tested: the two edges that would be replaced, and the two that touch the triangle only at its corners.
    const Slot skipped[] = {before(a), a, b, c};
    for (std::size_t block = 0; block < boxes_.size(); ++block) {
      if (boxes_[block].intersects(near) && meets_block(triangle, block, skipped)) return true;
    }
    return meets_bar(triangle, a == 0, index(c) + 1 == corners_.size());
  }

  [[nodiscard]] bool meets_block(const Triangle& triangle, std::size_t block, const Slot (&skipped)[4]) const {
    const auto end = static_cast<Slot>(std::min(corners_.size(), (block + 1) * kBlock));
    Slot known = kNone;  // corner whose height above the triangle is known from the edge before
    double height = 0.0;
    for (auto k = static_cast<Slot>(block * kBlock); k < end; ++k) {
      const Slot next = after_[index(k)];
      if (gone_[index(k)] || next == kNone) continue;
      const double from = k == known ? height : triangle.height(at(k));
      height = triangle.height(at(next));
      known = next;
      if (!triangle.is_met(at(k), at(next), from, height)) continue;
      if (k != skipped[0] && k != skipped[1] && k != skipped[2] && k != skipped[3]) return true;
    }
    return false;
  }

  /// A bar that starts at a corner of the triangle touches it only there and is not tested.
  [[nodiscard]] bool meets_bar(const Triangle& triangle, bool has_front, bool has_back) const {
    for (const Bar& bar : bars_) {
      if (bar.from_front ? has_front : has_back) continue;
      const Point& from = bar.from_front ? corners_.front() : corners_.back();
      if (triangle.is_met(from, bar.to, triangle.height(from), triangle.height(bar.to))) return true;
    }
    return false;
  }

  std::span<const Point> corners_;
  bool closed_;
  std::span<const Bar> bars_;
  std::size_t left_;
  std::vector<Slot> before_, after_;
  std::vector<bool> gone_;
  std::vector<Box> boxes_;
};

}  // namespace

std::vector<Point> with_corners_cut(std::vector<Point> line, bool closed, std::span<const Bar> bars) {
  for (std::size_t before = line.size() + 1; line.size() < before;) {
    before = line.size();
    line = Pass(line, closed, bars).run();
  }
  return line;
}

}  // namespace ligature::knot
