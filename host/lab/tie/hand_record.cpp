#include "host/lab/tie/hand_record.hpp"

#include <cmath>

#include "protocol/scene/monotone_cubic.hpp"

namespace ligature::lab {
namespace {

using Keys = std::vector<scene::GripKey>;

double distance_m(const scene::Vec& a, const scene::Vec& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Index of the recorded position between two keys that is farthest from the interpolation, if that is more than the
/// tolerance; else `from`.
std::size_t worst_between(const Keys& wishes, std::size_t from, std::size_t to, const Keys& keys, double tolerance_m) {
  std::size_t worst = from;
  double most_m = tolerance_m;
  for (std::size_t k = from + 1; k < to; ++k) {
    const double off_m = distance_m(scene::sample(keys, wishes[k].time_s).p_W_m, wishes[k].p_W_m);
    if (off_m > most_m) worst = k, most_m = off_m;
  }
  return worst;
}

Keys chosen(const Keys& wishes, const std::vector<std::size_t>& kept) {
  Keys keys;
  keys.reserve(kept.size());
  for (const std::size_t k : kept) keys.push_back(wishes[k]);
  scene::pass_through(keys);
  return keys;
}

Keys thinned(const Keys& wishes, double tolerance_m) {
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < wishes.size(); ++k) {
    const bool is_end = k == 0 || k + 1 == wishes.size();
    if (is_end || wishes[k].grip != wishes[k - 1].grip) kept.push_back(k);
  }
  for (;;) {
    const Keys keys = chosen(wishes, kept);
    std::vector<std::size_t> more;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      more.push_back(kept[i]);
      if (i + 1 == kept.size()) break;
      const auto worst = worst_between(wishes, kept[i], kept[i + 1], keys, tolerance_m);
      if (worst != kept[i]) more.push_back(worst);
    }
    if (more.size() == kept.size()) return keys;
    kept = std::move(more);
  }
}

}  // namespace

bool HandRecord::is_within_reach(const sim::Vec3& p_W) const { return map_.linkage.reaches(map_.to_device(p_W)); }

/// The position as written: rounded to 1e-5 device metres, and moved within the arm's reach.
sim::Vec3 HandRecord::written(const sim::Vec3& wish_W) const {
  constexpr int kHalvings = 20;
  const double unit_m = 1e-5 * map_.scale;
  const sim::Vec3 home_W = map_.to_world(map_.linkage.home_D_m());
  const auto at = [&](double share) -> sim::Vec3 {
    return ((home_W + share * (wish_W - home_W)) / unit_m).array().round() * unit_m;
  };
  if (is_within_reach(at(1.0))) return at(1.0);
  double out = 0.0;  // fraction of the way from home to the wanted position
  for (int k = 1; k < kHalvings; ++k) {
    const double step = std::ldexp(1.0, -k);
    if (is_within_reach(at(out + step))) out += step;
  }
  return at(out);
}

void HandRecord::add(double t_s, const std::array<sim::HandWish, 2>& wish) {
  constexpr double kTick_s = 1e-3;
  for (std::size_t h = 0; h < 2; ++h) {
    const sim::Vec3 p_W = written(wish[h].p_W);
    const scene::GripKey key{std::round(t_s / kTick_s) * kTick_s, {p_W.x(), p_W.y(), p_W.z()}, wish[h].grip};
    if (wishes_[h].empty() || key.time_s > wishes_[h].back().time_s) wishes_[h].push_back(key);
  }
}

scene::GripperScript HandRecord::script(double tolerance_m) const {
  scene::GripperScript script;
  script.motion = scene::Motion::kMonotoneCubic;
  for (std::size_t h = 0; h < 2; ++h) script.keys[h] = thinned(wishes_[h], tolerance_m);
  return script;
}

}  // namespace ligature::lab
