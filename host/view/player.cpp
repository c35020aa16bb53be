#include "host/view/player.hpp"

#include <algorithm>
#include <cmath>

namespace ligature::host::view {

using nlohmann::json;

json Player::request(const json& message, Picture::Clock::time_point now) {
  const auto refuse = [&](const char* why) {
    return json{{"id", nullptr}, {"command", "replay"}, {"accepted", false}, {"text", why}};
  };
  if (const auto play = message.find("play"); play != message.end() && play->is_boolean()) {
    playing_ = play->get<bool>();
    if (playing_ && position_s_ >= map_.duration_s()) seek(0.0, now);
    return nullptr;
  }
  if (const auto speed = message.find("speed"); speed != message.end() && speed->is_number()) {
    const auto wanted = speed->get<double>();
    if (!(wanted >= kSlowest && wanted <= kFastest)) return refuse("allowed speeds: 0.1 .. 10");
    speed_ = wanted;
    return nullptr;
  }
  if (const auto t = message.find("seek_s"); t != message.end() && t->is_number()) {
    if (!std::isfinite(t->get<double>())) return refuse("not a time");
    seek(t->get<double>(), now);
    return nullptr;
  }
  return refuse("a recording takes play, speed and seek_s");
}

void Player::seek(double t_s, Picture::Clock::time_point now) {
  position_s_ = std::clamp(t_s, 0.0, map_.duration_s());
  has_begun_ = true;
  last_ = now;
  const double from_s = std::max(0.0, position_s_ - kLeadIn_s);
  picture_.start_again(survey_.history(from_s));
  next_ = from_s > 0.0 ? map_.after(from_s) : 0;
  play_until(map_.after(position_s_), now);
}

void Player::advance(Picture::Clock::time_point now) {
  const double passed_s = std::chrono::duration<double>(now - last_).count();
  last_ = now;
  if (playing_) {
    position_s_ = std::min(position_s_ + std::min(passed_s, 0.25) * speed_, map_.duration_s());
    play_until(map_.after(position_s_), now);
    if (position_s_ >= map_.duration_s()) playing_ = false;
  }
  picture_.hold(now);
}

void Player::follow(double t_s, Picture::Clock::time_point now) {
  constexpr double kLongestStep_s = 5.0;
  const double to_s = std::clamp(t_s, 0.0, map_.duration_s());
  if (!has_begun_ || to_s < position_s_ || to_s > position_s_ + kLongestStep_s) return seek(to_s, now);
  position_s_ = to_s;
  play_until(map_.after(to_s), now);
}

void Player::play_until(std::size_t end, Picture::Clock::time_point now) {
  for (; next_ < end; ++next_) {
    const auto& entry = map_.entries()[next_];
    if (map_.read(entry, payload_)) picture_.take(wire_name(entry.channel), payload_, now);
  }
}

json Player::state() const {
  return {{"position_s", position_s_}, {"duration_s", map_.duration_s()}, {"playing", playing_}, {"speed", speed_}};
}

}  // namespace ligature::host::view
