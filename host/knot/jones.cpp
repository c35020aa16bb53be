#include "host/knot/jones.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <utility>

namespace ligature::knot {
namespace {

using Edge = int;
// ends of open strands: maps each end to the other end of its strand, in both directions
using Pairing = std::map<Edge, Edge>;

/// The four edges at a crossing, counter-clockwise from the incoming under-strand.
using Corner = std::array<Edge, 4>;

std::vector<Corner> corners_of(const Diagram& d) {
  const int edges = static_cast<int>(d.passes.size());
  assert(edges > 0 && d.passes.size() == 2 * d.crossings());
  std::vector<std::array<int, 2>> at(d.crossings());  // pass index: under, over
  for (int i = 0; i < edges; ++i) {
    const auto& p = d.passes[static_cast<std::size_t>(i)];
    at[p.crossing][p.over ? 1 : 0] = i;
  }
  std::vector<Corner> corners;
  for (std::size_t c = 0; c < d.crossings(); ++c) {
    const int u = at[c][0], o = at[c][1], u_out = (u + 1) % edges, o_out = (o + 1) % edges;
    if (d.signs[c] > 0)
      corners.push_back({u, o_out, u_out, o});
    else
      corners.push_back({u, o, u_out, o_out});
  }
  return corners;
}

/// Joins edges x and y by an arc. @return whether that closes a loop. Each edge is joined twice, and is open in
/// between.
bool join(Pairing& open, Edge x, Edge y) {
  if (x == y) return true;
  const auto end_of = [&](Edge e) {
    const auto it = open.find(e);
    if (it == open.end()) return e;
    const Edge far = it->second;
    open.erase(it);
    return far;
  };
  const Edge a = end_of(x);
  if (a == y) {
    open.erase(y);
    return true;
  }
  const Edge b = end_of(y);
  open[a] = b;
  open[b] = a;
  return false;
}

/// p times (-A^2 - A^-2), the bracket's factor for a closed loop.
Laurent with_loop(const Laurent& p) {
  Laurent r;
  add(r, p, -1, 2);
  add(r, p, -1, -2);
  return r;
}

/// p / (-A^2 - A^-2). The division is exact, because every state contains a loop.
Laurent without_loop(Laurent p) {
  Laurent q;
  while (!p.c.empty()) {
    const Laurent lead{p.low + 2, {-p.c.front()}};
    add(q, lead, 1, 0);
    add(p, with_loop(lead), -1, 0);
  }
  return q;
}

/// The unprocessed crossing that touches most open strands: this keeps the number of open strands small.
std::size_t next_corner(const std::vector<Corner>& corners, const std::vector<bool>& done, const Pairing& open) {
  std::size_t best = corners.size();
  int most = -1;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    if (done[c]) continue;
    int touching = 0;
    for (const Edge e : corners[c]) touching += open.contains(e) ? 1 : 0;
    if (touching > most) most = touching, best = c;
  }
  return best;
}

Laurent bracket(const Diagram& d) {
  const auto corners = corners_of(d);
  std::map<Pairing, Laurent> states{{{}, {0, {1}}}};
  std::vector<bool> done(corners.size(), false);
  for (std::size_t step = 0; step < corners.size(); ++step) {
    const std::size_t c = next_corner(corners, done, states.begin()->first);
    done[c] = true;
    const auto& [a, b, e, f] = corners[c];
    std::map<Pairing, Laurent> after;
    const auto smooth = [&](Pairing open, Laurent value, std::array<Edge, 4> ends, int power) {
      for (const std::size_t k : {std::size_t{0}, std::size_t{2}}) {
        if (join(open, ends[k], ends[k + 1])) value = with_loop(value);
      }
      add(after[std::move(open)], value, 1, power);
    };
    for (const auto& [open, value] : states) {
      smooth(open, value, {a, b, e, f}, 1);
      smooth(open, value, {a, f, b, e}, -1);
    }
    states = std::move(after);
  }
  return without_loop(states.begin()->second);
}

}  // namespace

Laurent jones(const Diagram& d) {
  if (d.crossings() == 0) return {0, {1}};
  const int w = writhe(d);
  Laurent in_A;
  add(in_A, bracket(d), w % 2 == 0 ? 1 : -1, -3 * w);
  Laurent v;
  for (std::size_t k = 0; k < in_A.c.size(); ++k) {  // for a knot all exponents are multiples of 4
    if (in_A.c[k] != 0) add(v, {0, {in_A.c[k]}}, 1, -(in_A.low + static_cast<int>(k)) / 4);
  }
  return v;
}

}  // namespace ligature::knot
