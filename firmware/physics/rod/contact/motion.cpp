#include "firmware/physics/rod/contact/motion.hpp"

#include <cmath>
#include <utility>

namespace ligature::physics::rod {
namespace {

// Running maximum of P_b - P_a over all a < b, for values P that are given one after the other.
struct Rise {
  double least = 0.0, most = 0.0;
  void next(double p) noexcept {
    most = std::max(most, p - least);
    least = std::min(least, p);
  }
};

// Maximum of a per-segment value in every block of kBlock segments.
void blocks_of(const std::vector<double>& of, std::vector<double>& blocks) noexcept {
  const std::size_t n = of.size();
  for (std::size_t k = 0, i = 0; i < n; ++k) {
    double most = 0.0;
    for (const std::size_t last = std::min(i + Motion::kBlock, n); i < last; ++i) most = of[i] > most ? of[i] : most;
    blocks[k] = most;
  }
}

}  // namespace

void Motion::reserve(int nodes) {
  for (auto* array : {&speed_, &drift_, &speed_before_, &drift_before_, &speed_allowed_, &drift_allowed_, &travel_,
                      &strayed_, &link_}) {
    array->assign(static_cast<std::size_t>(nodes), 0.0);
  }
  for (auto* array : {&block_speed_, &block_travel_}) array->assign(static_cast<std::size_t>(nodes) / kBlock + 1, 0.0);
}

void Motion::measure(const Vec* v) noexcept {
  std::swap(speed_, speed_before_);
  std::swap(drift_, drift_before_);
  const std::size_t n = speed_.size();
  double *speed = speed_.data(), *link = link_.data(), *drift = drift_.data();
  std::size_t k = 0;
  Lanes most2{};
  for (; k + 4 < n; k += 4) {
    const Lanes own = squares(v[k], v[k + 1], v[k + 2], v[k + 3]);
    const Lanes apart = squares(v[k + 1] - v[k], v[k + 2] - v[k + 1], v[k + 3] - v[k + 2], v[k + 4] - v[k + 3]);
    store(speed + k, own);
    store(link + k, apart);
    most2 = own > most2 ? own : most2;
  }
  double most = std::max(std::max(most2[0], most2[1]), std::max(most2[2], most2[3]));
  for (; k < n; ++k) {
    const Vec apart = k + 1 < n ? v[k + 1] - v[k] : Vec{};
    speed[k] = dot(v[k], v[k]);
    link[k] = dot(apart, apart);
    most = std::max(most, speed[k]);
  }
  fastest_ = std::sqrt(most);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    speed[i] = std::sqrt(speed[i] > speed[i + 1] ? speed[i] : speed[i + 1]);
    link[i] = std::sqrt(link[i]);
  }
  speed[n - 1] = 0.0;  // there is no segment n - 1
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    drift[i] = sum;
    sum += link[i];
  }
  blocks_of(speed_, block_speed_);
}

void Motion::advance(double step_s) noexcept {
  furthest_ += step_s * fastest_;
  const std::size_t n = speed_.size();
  double *travel = travel_.data(), *strayed = strayed_.data();
  const double *speed = speed_.data(), *drift = drift_.data();
  for (std::size_t i = 0; i < n; ++i) {
    travel[i] += step_s * speed[i];
    strayed[i] += step_s * drift[i];
  }
  blocks_of(travel_, block_travel_);
}

void Motion::restart() noexcept {
  furthest_ = 0.0;
  std::fill(travel_.begin(), travel_.end(), 0.0);
  std::fill(strayed_.begin(), strayed_.end(), 0.0);
  std::fill(block_travel_.begin(), block_travel_.end(), 0.0);
  std::copy(speed_.begin(), speed_.end(), speed_allowed_.begin());
  std::copy(drift_.begin(), drift_.end(), drift_allowed_.begin());
}

// There are two upper bounds of how much gaps have closed since the list was made: one by the speeds of both segments,
// one by the drift between them (class comment of Motion). The list is used up as soon as either bound exceeds
// `spare_m` beyond its own allowance. That is stricter than needed: the smaller bound would be enough.
bool Motion::used_up(double spare_m, double horizon_s, double ahead_s) const noexcept {
  if (2.0 * (furthest_ + ahead_s * fastest_) <= spare_m) return false;
  double one = 0.0;
  Rise rise;
  for (std::size_t i = 0; i < speed_.size(); ++i) {
    one = std::max(one, travel_[i] + ahead_s * speed_[i] - horizon_s * speed_allowed_[i]);
    rise.next(strayed_[i] + ahead_s * drift_[i] - horizon_s * drift_allowed_[i]);
  }
  return 2.0 * one > spare_m || rise.most > spare_m;
}

double Motion::share_within(double spare_m, double horizon_s, double dt_s) const noexcept {
  for (double share = 1.0; share >= 1.0 / 1024.0; share *= 0.5)
    if (!used_up(spare_m, horizon_s, share * dt_s)) return share;
  return 0.0;
}

bool Motion::outran(double spare_m, double dt_s) const noexcept {
  if (2.0 * dt_s * fastest_ <= spare_m) return false;
  double one = 0.0;
  Rise rise;
  for (std::size_t i = 0; i < speed_.size(); ++i) {
    one = std::max(one, speed_[i] - 2.0 * speed_before_[i]);
    rise.next(drift_[i] - 2.0 * drift_before_[i]);
  }
  return dt_s * 2.0 * one > spare_m || dt_s * rise.most > spare_m;
}

}  // namespace ligature::physics::rod
