#include "host/lab/rerun/recorded_run.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "host/console/progress.hpp"
#include "host/flight_reader.hpp"
#include "host/lab/loading.hpp"
#include "host/lab/outcome.hpp"
#include "host/log_reader.hpp"
#include "host/messages.hpp"
#include "protocol/scene/recorded_scene.hpp"

namespace ligature::lab {
namespace {

constexpr const char* kSince = "recorded since status_t.protocol_version 2 (CHANGELOG.md, 'rerun')";

struct Session {
  std::int64_t ticks = 0, first = -1;
  /// some tick defines the thread's state (start of the run, reset or new scene): a rerun can begin there
  bool says_how_it_lay = false;
  std::optional<ligature_msg::tick_t> last;
  std::map<std::int64_t, RecordedSceneText> scenes;
  double period_s = 0.0;
  std::string firmware_version;
};

class Survey {
 public:
  void take(const ligature_msg::tick_batch_t& batch) {
    Session& s = of(batch.session);
    for (const auto& tick : batch.ticks) {
      ++s.ticks;
      const bool anew =
          s.last && (tick.thread_resets > s.last->thread_resets || tick.thread_scenes > s.last->thread_scenes);
      s.says_how_it_lay = s.says_how_it_lay || tick.tick == 0 || anew;
      if (s.first < 0 || tick.tick < s.first) s.first = tick.tick;
      s.last = tick;
    }
  }
  void take(const ligature_msg::status_t& m) {
    Session& s = of(m.session);
    s.period_s = m.period_s;
    s.firmware_version = m.firmware_version;
    s.scenes.try_emplace(m.scene_first_tick, RecordedSceneText{m.scene_first_tick, m.scene_file, m.scene_toml});
  }
  /// The sessions that have ticks, in order of appearance.
  [[nodiscard]] std::vector<std::pair<std::int64_t, const Session*>> sessions() const {
    std::vector<std::pair<std::int64_t, const Session*>> found;
    for (const auto id : order_)
      if (sessions_.at(id).ticks > 0) found.emplace_back(id, &sessions_.at(id));
    return found;
  }

 private:
  Session& of(std::int64_t id) {
    const auto [at, is_new] = sessions_.try_emplace(id);
    if (is_new) order_.push_back(id);
    return at->second;
  }
  std::map<std::int64_t, Session> sessions_;
  std::vector<std::int64_t> order_;
};

Survey read(const std::string& log) {
  if (host::is_flight_file(log))
    throw Refusal(log +
                  ": is a flight recorder file, which holds no shapes; allowed an LCM log of 'ligature-host record'");
  console::Progress progress("survey");
  host::LogReader reader(log, &progress);
  Survey survey;
  while (const host::LogEvent* event = reader.next()) {
    if (event->channel == host::kTicksChannel) {
      if (const auto batch = host::decode<ligature_msg::tick_batch_t>(event->data)) survey.take(*batch);
    } else if (event->channel == host::kStatusChannel) {
      if (const auto status = host::decode<ligature_msg::status_t>(event->data)) survey.take(*status);
    }
  }
  return survey;
}

}  // namespace

RecordedRun survey(const std::string& log, int number) {
  const Survey all = read(log);
  const auto sessions = all.sessions();
  if (sessions.empty()) throw Refusal(log + ": holds no tick with the thread's tools, which are " + kSince);
  const auto count = std::to_string(sessions.size());
  if (number == 0 && sessions.size() > 1)
    throw Refusal(log + ": holds " + count + " runs of the firmware; say which by --session 1 .. " + count);
  if (number < 0 || number > static_cast<int>(sessions.size()))
    throw Refusal("--session: found " + std::to_string(number) + ", allowed 1 .. " + count);
  const auto& [id, s] = sessions[static_cast<std::size_t>(std::max(number, 1) - 1)];
  RecordedRun run{id, s->ticks, sessions.size(), s->period_s, s->firmware_version, {}};
  for (const auto& [tick, scene] : s->scenes) {
    if (scene.toml.empty())
      throw Refusal(log + ": holds no text of its scene (status_t.scene_toml), which is " + kSince);
    run.scenes.push_back(scene);
  }
  if (run.scenes.empty()) throw Refusal(log + ": holds no status of that run, so nothing says which scene it was");
  if (!s->says_how_it_lay)
    throw Refusal(
        log + ": begins at tick " + std::to_string(s->first) +
        " of its run, and no reset and no other scene says later how the thread lay; record from the firmware's "
        "start on, or reset the thread while recording");
  return run;
}

std::vector<PlayedScene> scenes_of(const std::string& log, const RecordedRun& run,
                                   const std::vector<std::string>& overrides) {
  std::vector<PlayedScene> scenes;
  for (const auto& recorded : run.scenes) {
    auto parsed = scene::parse_recorded(recorded.toml, recorded.file, overrides);
    if (const auto* error = std::get_if<scene::Error>(&parsed)) throw Refusal(log + ": " + error->text);
    auto& scene = std::get<scene::Scene>(parsed);
    if (scene.time.tick_s != run.period_s)
      throw Refusal(log + ": key 'time.tick_s': found " + std::to_string(scene.time.tick_s) +
                    ", allowed the recording's period, " + std::to_string(run.period_s));
    (void)make_or_refuse(scene, recorded.file);
    scenes.push_back({recorded.first_tick, std::move(scene)});
  }
  return scenes;
}

}  // namespace ligature::lab
