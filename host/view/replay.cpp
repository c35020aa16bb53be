#include "host/view/replay.hpp"

#include <cstdio>
#include <filesystem>

#include "host/console/stop_signal.hpp"
#include "host/view/comparison.hpp"
#include "host/view/knot_watch.hpp"
#include "host/view/live.hpp"
#include "host/view/player.hpp"
#include "host/view/rig_json.hpp"

namespace ligature::host::view {

void replay(const ReplayOptions& options) {
  const LogMap map(options.log);
  const LogSurvey survey(map);
  Picture picture;
  Player player(map, survey, picture);
  // Playback commands no rig, so that every viewer may control it without a token.
  const Access access{};
  picture.set("view", {{"mode", "replay"},
                       {"version", LIGATURE_VERSION},
                       {"file", std::filesystem::path(options.log).filename().string()},
                       {"may_command", false},
                       {"names", names_json()}});
  // Viewers on this machine may choose any recording of the folder; remote viewers see only the one that is shown.
  const auto folder = std::filesystem::path(options.log).parent_path();
  Comparison comparison(survey, picture,
                        !is_loopback(options.server) ? ""
                        : folder.empty()             ? std::filesystem::path(".")
                                                     : folder);
  if (!options.compare.empty()) comparison.open(options.compare, options.align);
  const auto on_message = [&](std::uint64_t, const nlohmann::json& message) {
    if (message.contains("compare")) return comparison.request(message);
    return player.request(message, Picture::Clock::now());
  };
  bool has_marks = false;
  auto state = player.state();
  const auto on_tick = [&](bool& more) {
    more = !console::stop_requested();
    const auto clock = Picture::Clock::now();
    player.advance(clock);
    comparison.follow(player.position_s(), clock);
    if (!has_marks && survey.progress() >= 1.0) {
      has_marks = true;
      picture.set("marks", survey.marks());
      // jumps to the same time again, because the history of the traces is complete now
      if (player.position_s() > Player::kLeadIn_s) player.seek(player.position_s(), clock);
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
