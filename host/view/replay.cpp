#include "host/view/replay.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "host/console/stop_signal.hpp"
#include "host/view/comparison.hpp"
#include "host/view/json_text.hpp"
#include "host/view/knot_watch.hpp"
#include "host/view/live.hpp"
#include "host/view/player.hpp"
#include "host/view/recordings.hpp"
#include "host/view/rig_json.hpp"

namespace ligature::host::view {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// One recording while it is shown: its file, and what plays it into the picture.
struct Showing {
  LogMap map;
  LogSurvey survey;
  Player player;
  Comparison comparison;
  json state;
  bool has_marks = false;

  Showing(const fs::path& log, Picture& picture, const fs::path& folder)
      : map(log.string()), survey(map), player(map, survey, picture), comparison(survey, picture, folder) {
    picture.set("view", {{"mode", "replay"},
                         {"version", LIGATURE_VERSION},
                         {"file", log.filename().string()},
                         {"may_command", false},
                         {"names", names_json()}});
    picture.set("marks", survey.marks());
  }
};

/// Plays a recording, and the one that a page chooses instead of it.
class Projector {
 public:
  /// @param folder whose recordings a page may choose; empty: none.
  Projector(const fs::path& log, Picture& picture, fs::path folder)
      : picture_(picture), folder_(std::move(folder)), showing_(std::make_unique<Showing>(log, picture, folder_)) {}

  Comparison& comparison() { return showing_->comparison; }

  json request(const json& message) {
    if (message.contains("open")) return open(text_of(message, "open"), id_of(message));
    if (message.contains("record")) return list(id_of(message));
    if (message.contains("compare")) return showing_->comparison.request(message);
    return showing_->player.request(message, Picture::Clock::now());
  }

  void advance(Picture::Clock::time_point clock) {
    Showing& s = *showing_;
    s.player.advance(clock);
    s.comparison.follow(s.player.position_s(), clock);
    if (!s.has_marks && s.survey.progress() >= 1.0) {
      s.has_marks = true;
      picture_.set("marks", s.survey.marks());
      // jumps to the same time again, because the history of the traces is complete now
      if (s.player.position_s() > Player::kLeadIn_s) s.player.seek(s.player.position_s(), clock);
    }
    auto now = s.player.state();
    now["survey"] = s.survey.progress();
    if (now != s.state) picture_.set("replay", s.state = std::move(now));
  }

 private:
  json open(const std::string& name, const json& id) {
    const auto answer = [&](bool accepted, const std::string& text) {
      return json{{"id", id}, {"command", "open"}, {"accepted", accepted}, {"text", text}};
    };
    const auto names = folder_.empty() ? std::vector<std::string>() : recording_names(folder_);
    if (std::ranges::find(names, name) == names.end())
      return answer(false, "allowed: a recording in the same folder, chosen on this machine");
    try {
      auto next = std::make_unique<Showing>(folder_ / name, picture_, folder_);
      showing_ = std::move(next);
      showing_->player.seek(0.0, Picture::Clock::now());
      return answer(true, name);
    } catch (const std::exception& error) {
      return answer(false, error.what());
    }
  }

  [[nodiscard]] json list(const json& id) const {
    json told = {{"id", id}, {"command", "record list"}, {"accepted", true}, {"text", folder_.string()}};
    told["files"] = folder_.empty() ? json::array() : recordings_in(folder_);
    return told;
  }

  Picture& picture_;
  fs::path folder_;
  std::unique_ptr<Showing> showing_;
};

}  // namespace

void replay(const ReplayOptions& options) {
  Picture picture;
  // Viewers on this machine may choose any recording of the folder; remote viewers see only the one that is shown.
  auto folder = fs::path(options.log).parent_path();
  if (folder.empty()) folder = ".";
  Projector projector(options.log, picture, is_loopback(options.server) ? folder : fs::path());
  if (!options.compare.empty()) projector.comparison().open(options.compare, options.align);
  const auto on_message = [&](std::uint64_t, const json& message) { return projector.request(message); };
  const auto on_tick = [&](bool& more) {
    more = !console::stop_requested();
    projector.advance(Picture::Clock::now());
    return std::multimap<std::uint64_t, json>();
  };
  // Playback commands no rig, so that every viewer may control it without a token.
  const Access access{};
  Server server(options.server, access, picture, {on_message, on_tick});
  std::printf("open %s\n", url_of(options.server, server.port()).c_str());
  std::fflush(stdout);
  const KnotWatch knots(picture);
  server.run();
}

}  // namespace ligature::host::view
