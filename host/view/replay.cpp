#include "host/view/replay.hpp"

#include <cstdio>
#include <filesystem>

#include "host/stop_signal.hpp"
#include "host/view/knot_watch.hpp"
#include "host/view/live.hpp"
#include "host/view/player.hpp"

namespace ligature::host::view {

void replay(const ReplayOptions& options) {
  const LogMap map(options.log);
  const LogSurvey survey(map);
  Picture picture;
  Player player(map, survey, picture);
  // Playing moves nothing but a picture, so everybody who may see it may scrub it, and no token is needed.
  const Access access{};
  picture.set("view", {{"mode", "replay"},
                       {"version", LIGATURE_VERSION},
                       {"file", std::filesystem::path(options.log).filename().string()},
                       {"may_command", false}});
  const auto on_message = [&](std::uint64_t, const nlohmann::json& message) {
    return player.request(message, Picture::Clock::now());
  };
  bool has_marks = false;
  auto state = player.state();
  const auto on_tick = [&](bool& more) {
    more = !stop_requested();
    player.advance(Picture::Clock::now());
    if (!has_marks && survey.progress() >= 1.0) {
      has_marks = true;
      picture.set("marks", survey.marks());
    }
    auto now = player.state();
    now["survey"] = survey.progress();
    if (now != state) picture.set("replay", state = std::move(now));
    return std::multimap<std::uint64_t, nlohmann::json>();
  };
  Server server(options.server, access, picture, {on_message, on_tick});
  std::printf("open %s\n", url_of(options.server, server.port()).c_str());
  std::fflush(stdout);
  const KnotWatch knots(picture);
  server.run();
}

}  // namespace ligature::host::view
