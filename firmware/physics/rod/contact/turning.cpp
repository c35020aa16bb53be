#include "firmware/physics/rod/contact/turning.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/physics/rod/contact/contact_set.hpp"

namespace ligature::physics::rod {

void Turning::prepare(const Contact* contacts, int count, int segments, double radius_m, Spin& spin) noexcept {
  spin_ = &spin;
  rows_.clear();
  first_ = segments - 1, last_ = 0;
  for (int k = 0; k < count; ++k) {
    const Contact& c = contacts[k];
    Row row;
    double weight = 1.0;
    row.segment[0] = row.segment[1] = std::min(c.node[0], segments - 1);
    if (c.is_pair()) {
      row.segment[1] = c.node[2];
      row.count = 2;
    } else if (c.count == 1 && c.node[0] > 0 && c.node[0] < segments) {  // a node: half for each of its two segments
      row.segment[1] = c.node[0] - 1;
      row.count = 2;
      weight = 0.5;
    }
    double root = 0.0;  // square root of row.answer
    for (int e = 0; e < row.count; ++e) {
      row.g[e] = (-weight * radius_m) * cross(spin.tangent(row.segment[e]), c.n);
      root += std::sqrt(spin.answer(row.segment[e]) * dot(row.g[e], row.g[e]));
      first_ = std::min(first_, row.segment[e]);
      last_ = std::max(last_, row.segment[e]);
    }
    row.answer = root * root;
    rows_.push_back(row);
  }
}

void Turning::shorten_steps(Contact* contacts) const noexcept {
  for (const Row& row : rows_) {
    contacts->inv_w = 1.0 / (1.0 / contacts->inv_w + row.answer);
    ++contacts;
  }
}

}  // namespace ligature::physics::rod
