#include "sim_device/tying/played_hand.hpp"

#include <algorithm>
#include <cmath>

namespace ligature::sim {
namespace {

constexpr double kCatchUp_s = 0.25;  // time constant with which excess delay decays
constexpr double kFastest = 1.5;

}  // namespace

void PlayedHand::look(double t_s, Time started_at, std::span<const WishedTick> fresh) {
  if (!std::isfinite(t_s)) return;  // not started: the drives have never been enabled
  cursor_s_ = std::max(played_s(t_s), keys_.empty() ? t_s - kDelay_s : kLongAgo_s);
  look_s_ = t_s;
  const bool begins = keys_.empty();
  for (const WishedTick& wish : fresh) {
    const double due_s = 1e-9 * (static_cast<double>(wish.due_ns) - static_cast<double>(started_at.count()));
    if (!(due_s > newest_s()) || due_s > t_s + kLongestSilence_s) continue;  // a repeated tick, or one of another clock
    const HandWish& hand = wish.hands[hand_];
    keys_.push_back({due_s, map_.to_device(hand.p_W), hand.v_W / map_.scale, hand.grip});
    if (wish.is_done) end_s_ = std::min(end_s_, due_s + kDelay_s);
  }
  if (begins && !keys_.empty()) cursor_s_ = std::min(cursor_s_, keys_.front().t_s);  // the first batch may be late, too
  const auto next = std::ranges::upper_bound(keys_, cursor_s_, {}, &Key::t_s);
  if (next - keys_.begin() > 1) keys_.erase(keys_.begin(), next - 1);
  pace_ = std::clamp(1.0 + (t_s - kDelay_s - cursor_s_) / kCatchUp_s, 0.0, kFastest);
}

/// The due time of the wishes that are played at time t_s, both since the start.
double PlayedHand::played_s(double t_s) const noexcept {
  return std::min(cursor_s_ + pace_ * (t_s - look_s_), newest_s());
}

Intent PlayedHand::at(double t_s) const noexcept {
  Intent now;
  now.p_DH = start_D_m_;
  now.dead_man = t_s <= newest_s() + kLongestSilence_s;
  if (keys_.empty()) return now;
  const double s = played_s(t_s);
  const auto next = std::ranges::upper_bound(keys_, s, {}, &Key::t_s);
  const Key& a = next == keys_.begin() ? *next : *(next - 1);
  now.p_DH = a.p_D;
  now.grip = a.grip;
  if (next == keys_.begin() || next == keys_.end()) return now;
  const Key& b = *next;  // cubic Hermite interpolation from a (u = 0) to b (u = 1)
  const double h = b.t_s - a.t_s, u = (s - a.t_s) / h, w = 1.0 - u;
  now.p_DH = w * w * ((1.0 + 2.0 * u) * a.p_D + h * u * a.v_D) + u * u * ((1.0 + 2.0 * w) * b.p_D - h * w * b.v_D);
  now.v_DH = pace_ * (6.0 * u * w / h * (b.p_D - a.p_D) + w * (1.0 - 3.0 * u) * a.v_D + u * (1.0 - 3.0 * w) * b.v_D);
  return now;
}

}  // namespace ligature::sim
