#include "host/lab/published/two_hands.hpp"

#include <algorithm>
#include <cmath>

#include "host/lab/validate/proceed.hpp"

namespace ligature::published {

using physics::Hand;
using validate::Vec3;

void TwoHands::take(const Vec3& left, const Vec3& right) {
  let_go();
  tools_[0] = {left, Vec3::Zero(), true};
  tools_[1] = {right, Vec3::Zero(), true};
  // Jaws grip the nearest node and would then pull it to the tool. So the tool is first put at this node; then the
  // thread does not move.
  for (auto& tool : tools_) {
    const auto x = sim_.nodes_W();
    tool.p_WT = *std::min_element(x.begin(), x.end(), [at = tool.p_WT](const Vec3& a, const Vec3& b) {
      return (a - at).squaredNorm() < (b - at).squaredNorm();
    });
  }
}

void TwoHands::let_go() {
  tools_ = validate::no_hands();
  rest(1);
}

void TwoHands::tick(const Vec3& left, const Vec3& right) {
  tools_[0].v_WT = left, tools_[1].v_WT = right;
  for (auto& tool : tools_) tool.p_WT += tick_s_ * tool.v_WT;
  validate::proceed(sim_, tools_);
}

void TwoHands::rest(int ticks) {
  for (int k = 0; k < ticks; ++k) tick(Vec3::Zero(), Vec3::Zero());
}

bool TwoHands::pull_to(double force_N, const std::array<Vec3, 2>& directions, double speed_m_per_s, int most_ticks) {
  constexpr double kGain_m_per_N_s = 0.1;  // far below 1 / (stiffness of thread and hands x tick): no oscillation
  const double near_N = std::max(0.005, 0.005 * force_N);
  for (int k = 0; k < most_ticks; ++k) {
    std::array<Vec3, 2> v;
    double worst_N = 0.0;
    for (std::size_t h = 0; h < 2; ++h) {
      const double missing = force_N - this->force_N(h, directions[h]);
      worst_N = std::max(worst_N, std::abs(missing));
      v[h] = std::clamp(kGain_m_per_N_s * missing, -speed_m_per_s, speed_m_per_s) * directions[h];
    }
    if (worst_N < near_N) return true;
    tick(v[0], v[1]);
  }
  return false;
}

double TwoHands::force_N(std::size_t h, const Vec3& direction) const {
  return -sim_.hand(h == 0 ? Hand::kLeft : Hand::kRight).f_W.dot(direction);
}

double TwoHands::distance_m() const { return (sim_.hand(Hand::kRight).p_WG - sim_.hand(Hand::kLeft).p_WG).norm(); }

}  // namespace ligature::published
