#pragma once
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "host/view/log_map.hpp"
#include "host/view/log_survey.hpp"
#include "host/view/picture.hpp"

namespace ligature::host::view {

/// Plays a log into a picture at 0.1 to 10 times real time; can pause and jump.
class Player {
 public:
  static constexpr double kSlowest = 0.1, kFastest = 10.0, kLeadIn_s = 12.0;

  Player(const LogMap& map, const LogSurvey& survey, Picture& picture)
      : map_(map), survey_(survey), picture_(picture) {}

  /// Handles a page's request: {"play": true}, {"speed": 2} or {"seek_s": 12.5}; anything else is refused.
  /// @return null, or an answer with the reason for a refusal.
  nlohmann::json request(const nlohmann::json& message, Picture::Clock::time_point now);

  /// Plays on by the time passed since the last call.
  void advance(Picture::Clock::time_point now);

  void seek(double t_s, Picture::Clock::time_point now);

  /// Moves to time t, for a player that follows another one: plays on when t is slightly later, otherwise jumps.
  void follow(double t_s, Picture::Clock::time_point now);

  [[nodiscard]] double position_s() const { return position_s_; }
  [[nodiscard]] bool is_playing() const { return playing_; }
  [[nodiscard]] nlohmann::json state() const;

 private:
  void play_until(std::size_t end, Picture::Clock::time_point now);

  const LogMap& map_;
  const LogSurvey& survey_;
  Picture& picture_;
  std::size_t next_ = 0;  // index of the next entry to play
  double position_s_ = 0.0, speed_ = 1.0;
  bool playing_ = true, has_begun_ = false;
  Picture::Clock::time_point last_ = Picture::Clock::now();
  std::vector<std::byte> payload_;
};

}  // namespace ligature::host::view
