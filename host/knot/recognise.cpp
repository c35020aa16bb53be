#include "host/knot/recognise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/knot/alexander.hpp"
#include "host/knot/closure.hpp"
#include "host/knot/corner_cutter.hpp"
#include "host/knot/jones.hpp"
#include "host/knot/knot_table.hpp"
#include "host/knot/projection.hpp"

namespace ligature::knot {
namespace {

constexpr std::size_t kExact = 29;     // largest number of crossings for which every invariant is exact
constexpr std::size_t kTangled = 300;  // with more corners left, shaking does not lead to a name in reasonable time

KnotResult unknown() { return {"unknown", "none", 0, {}, {}, 0, {}}; }

/// Names a composite knot by its factors, when the diagram splits into them; else nothing.
std::optional<KnotName> name_by_factors(const Diagram& d) {
  const auto factors = visible_factors(d);
  if (factors.size() < 2) return std::nullopt;
  KnotName sum{"0_1", "none"};
  for (const auto& f : factors) {
    const auto name = name_of(alexander(f), jones(f), f.crossings());
    if (!name) return std::nullopt;
    sum = sum_of(sum, *name);
  }
  return sum;
}

KnotResult from_diagram(const Diagram& d) {
  KnotResult r = unknown();
  r.crossings = d.crossings();
  if (d.crossings() > kExact) return r;
  r.alexander = alexander(d);
  r.determinant = determinant(r.alexander);
  r.jones = jones(d);
  auto name = name_by_factors(d);
  if (!name) name = name_of(r.alexander, r.jones, r.crossings);
  if (!name) {
    r.candidates = candidates(r.alexander, r.jones, r.crossings);
    return r;
  }
  // A sum of a knot and its own mirror image is amphichiral, although its parts have different hands.
  if (name->handedness == "mixed" && r.jones == mirrored(r.jones)) name->handedness = "amphichiral";
  r.type = name->type;
  r.handedness = name->handedness;
  return r;
}

/// Best result so far for one closed polygon.
struct Seen {
  KnotResult best = unknown();
  std::size_t fewest = static_cast<std::size_t>(-1);  // crossings of the best diagram so far
  /// A single candidate is the knot, so that a simpler diagram would add nothing.
  bool is_certain() const { return best.type != "unknown" || best.candidates.size() == 1; }
};

/// Projects the polygon; while the result is not certain, shakes and simplifies it and projects again.
void shake_and_look(Polygon polygon, Draw draw, Seen& seen) {
  constexpr int kRounds = 12, kShakes = 8, kViews = 40;
  for (int round = 0; round < kRounds; ++round) {
    if (polygon.corners().size() < 6) {  // a knot needs at least six edges
      seen.best = from_diagram({});
      return;
    }
    if (polygon.corners().size() > kTangled) return;
    if (const auto diagram = simplest_view(polygon.corners(), kViews); diagram && diagram->crossings() < seen.fewest) {
      seen.fewest = diagram->crossings();
      seen.best = from_diagram(*diagram);
      if (seen.is_certain()) return;
    }
    for (int k = 0; k < kShakes; ++k) polygon.shake(draw);
    polygon.cut_corners();
  }
}

/// Names the knot of a closed polygon. A sequence of random moves can get stuck before it finds a diagram with a name.
/// So that the result does not depend on one seed, sequences with other seeds are tried: a few for every polygon, and
/// all if the best diagram has at most kNear crossings.
KnotResult recognise_ring(std::vector<Point> ring) {
  constexpr std::uint64_t kCourses = 12, kAtLeast = 3;
  constexpr std::size_t kNear = 14;  // named knots have at most 8 crossings, sums and candidates 10
  Polygon polygon(std::move(ring));
  polygon.cut_corners();
  Seen seen;
  for (std::uint64_t course = 1; course <= kCourses; ++course) {
    shake_and_look(polygon, Draw(course), seen);
    if (seen.is_certain() || (course >= kAtLeast && seen.fewest > kNear)) break;
  }
  return seen.best;
}

/// Closing paths to try for an open thread: both ends led outwards from the centre, then both in a common direction.
std::vector<std::vector<Point>> ways_home(std::span<const Point> thread) {
  constexpr int kCommon = 8;
  std::vector<std::vector<Point>> ways{
      way_home(thread, outward(thread, thread.front()), outward(thread, thread.back()))};
  for (int k = 0; k < kCommon; ++k) {
    const Point d = spread_direction((k * 3) % kCommon, kCommon);
    ways.push_back(way_home(thread, d, d));
  }
  return ways;
}

/// Closes the thread in each way; the results vote. The thread is simplified only once, while it is still open. A bar
/// is the straight line by which a closing path leaves an end of the thread. The simplification crosses no bar, so
/// every closure keeps its knot.
KnotResult recognise_open(std::vector<Point> thread) {
  constexpr std::size_t kEnough = 3;
  const auto ways = ways_home(thread);
  std::vector<Bar> bars;
  for (const auto& way : ways) bars.insert(bars.end(), {{false, way.front()}, {true, way.back()}});
  thread = with_corners_cut(std::move(thread), false, bars);

  std::vector<KnotResult> votes;
  const auto count = [&](const KnotResult& a) {
    return std::count_if(votes.begin(), votes.end(), [&a](const KnotResult& b) {
      return a.type == b.type && a.handedness == b.handedness && a.alexander == b.alexander;
    });
  };
  for (const auto& way : ways) {
    auto ring = thread;
    ring.insert(ring.end(), way.begin(), way.end());
    votes.push_back(recognise_ring(std::move(ring)));
    if (votes.size() == kEnough && count(votes[0]) == static_cast<std::ptrdiff_t>(kEnough)) break;
  }
  // max_element returns the first of equals: in a tie the outward closure's result wins.
  return *std::max_element(votes.begin(), votes.end(),
                           [&](const KnotResult& a, const KnotResult& b) { return count(a) < count(b); });
}

/// Moves the points into the unit cube, so that squares and products neither overflow nor underflow.
/// @return false when rounding of the coordinates is too coarse to resolve strands: doubles near 1e14 are multiples of
/// 1/64, so a thread of one metre at such coordinates has lost its shape.
bool normalise(std::vector<Point>& points) {
  constexpr double kLeastExtent = 1e-290;  // smaller extents are near the subnormal numbers; 0: all points coincide
  constexpr double kCoarsest = 1e-8;       // limit on rounding / extent; strands are resolved down to 1e-9 of it
  Point low = points.front(), high = low;
  for (const auto& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double half_extent = (0.5 * high - 0.5 * low).maxCoeff();  // halved first: the difference could overflow
  const double largest = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  if (half_extent < kLeastExtent) return false;
  if (largest / half_extent * std::numeric_limits<double>::epsilon() > kCoarsest) return false;
  for (auto& p : points) p = (0.5 * p - 0.5 * low) / half_extent;
  return true;
}

/// For a closed line that runs to and fro along one straight line: how often it turns back at its far end; 0 when it
/// leaves the line. One turn means bridge number 1, the unknot [Schubert 1954]. With more turns the strands coincide,
/// and the knot is undefined.
int turns_on_a_line(const std::vector<Point>& ring) {
  constexpr double kOff = 1e-8;
  const auto far = std::max_element(ring.begin(), ring.end(), [&](const Point& a, const Point& b) {
    return (a - ring.front()).squaredNorm() < (b - ring.front()).squaredNorm();
  });
  const double length = (*far - ring.front()).norm();
  if (length == 0.0) return 0;
  const Point axis = (*far - ring.front()) / length;
  std::vector<double> at;
  for (const auto& p : ring) {
    const Point d = p - ring.front();
    if ((d - axis.dot(d) * axis).norm() > kOff) return 0;
    if (at.empty() || std::abs(axis.dot(d) - at.back()) > kOff) at.push_back(axis.dot(d));
  }
  int turns = 0;
  for (std::size_t i = 0, n = at.size(); i < n; ++i) turns += at[i] > at[(i + n - 1) % n] && at[i] >= at[(i + 1) % n];
  return turns;
}

}  // namespace

KnotResult recognise(std::span<const std::array<double, 3>> points, bool closed) {
  std::vector<Point> thread;
  for (const auto& p : points) {
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) return unknown();
    thread.emplace_back(p[0], p[1], p[2]);
  }
  if (thread.size() < 4) return from_diagram({});
  if (!normalise(thread)) return unknown();
  if (closed && turns_on_a_line(thread) > 1) return unknown();
  jitter(thread);
  return closed ? recognise_ring(std::move(thread)) : recognise_open(std::move(thread));
}

}  // namespace ligature::knot
