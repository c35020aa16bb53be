#include "firmware/app/scene_desk.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <thread>
#include <utility>

#include "firmware/app/admit_command.hpp"
#include "firmware/platform/realtime.hpp"

namespace ligature::app {
namespace {

namespace fs = std::filesystem;

constexpr double kAdmission_s = 0.3;
constexpr std::size_t kMostScenes = 100;

std::vector<std::string> scene_files(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ".toml" && entry.is_regular_file(none)) names.push_back(entry.path().filename());
  std::ranges::sort(names);
  if (names.size() > kMostScenes) names.resize(kMostScenes);
  return names;
}

std::string shortest(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

/// "0.5" is a TOML number, "2" an integer: both are read as numbers.
std::string assignment(const std::string& key, double value) { return key + "=" + shortest(value); }

}  // namespace

std::string rehearse(const physics::Simulation& thread) {
  constexpr int kTicks = 400;
  constexpr double kTorn = 5.0;
  physics::Simulation copy = thread;
  const auto n = copy.nodes_W().size();
  const physics::Vec3 start[2] = {copy.nodes_W()[n / 3], copy.nodes_W()[2 * n / 3]};
  const double reach_m = 0.2 * (start[1] - start[0]).norm();
  for (int tick = 0; tick < kTicks; ++tick) {
    const double swing = std::sin(6.283185307179586 * tick / kTicks);
    const physics::Vec3 pull(reach_m * swing, 0.0, 0.0);
    copy.tick({physics::ToolInput{start[0] - pull, physics::Vec3::Zero(), true},
               physics::ToolInput{start[1] + pull, physics::Vec3::Zero(), true}});
    if (!copy.diagnostics().finite || copy.diagnostics().max_stretch > kTorn)
      return "the thread would become unstable (rehearsal of " + std::to_string(kTicks) + " ticks, tick " +
             std::to_string(tick) + ")";
  }
  return {};
}

SceneDesk::SceneDesk(const RunOptions& options, const Plan& plan, int core)
    : options_(options),
      device_(plan.device),
      core_(core),
      launch_(options, plan.scene),
      now_{options.scene, {}, plan.scene, plan.scene} {
  const fs::path given = options.scenes.empty() ? fs::path(options.scene).parent_path() : fs::path(options.scenes);
  options_.scenes = given.empty() ? "." : given.string();
  scenes_ = scene_files(options_.scenes);
}

/// "knot.toml", or "knot.toml suture.model=paper-2 suture.nodes=35": the scene with another model or number of nodes.
std::string SceneDesk::prepare_scene(const std::string& wish) {
  std::istringstream words(wish);
  std::string name;
  words >> name;
  std::vector<std::string> live;
  for (std::string word; words >> word; live.push_back(word)) {
    if (key_of(word) != "suture.model" && key_of(word) != "suture.nodes")
      return "found '" + word + "' after the scene, allowed suture.model=MODEL and suture.nodes=N";
  }
  scenes_ = scene_files(options_.scenes);
  if (std::ranges::find(scenes_, name) == scenes_.end()) {
    std::string allowed;
    for (const auto& s : scenes_) allowed += (allowed.empty() ? "" : ", ") + s;
    return "no such scene, allowed " + (allowed.empty() ? "none: " + options_.scenes + " has no scene" : allowed);
  }
  words_ = "scene " + name + " loaded";
  for (const auto& l : live) words_ += (&l == &live.front() ? " with " : " ") + l;
  if (const auto held = launch_.held(live); !held.empty()) words_ += "; launch options hold: " + held;
  next_ = {(fs::path(options_.scenes) / name).string(), std::move(live), {}, {}};
  return {};
}

/// What may be changed, within the launch's limits.
std::vector<LiveParameter> SceneDesk::parameters() const {
  auto list = live_parameters(now_.from_file, now_.scene);
  for (auto& p : list) p.highest = std::min(p.highest, launch_.highest(p.key).value_or(p.highest));
  return list;
}

std::string SceneDesk::prepare_parameter(const std::string& key, double value) {
  const auto list = parameters();
  const auto found = std::ranges::find(list, key, &LiveParameter::key);
  if (found == list.end()) {
    std::string allowed;
    for (const auto& p : list) allowed += (allowed.empty() ? "" : ", ") + p.key;
    return "no such parameter, allowed " + allowed;
  }
  if (!(value >= found->lowest && value <= found->highest)) {
    const auto bound = launch_.highest(key);
    return key + ": found " + shortest(value) + ", allowed " + shortest(found->lowest) + " .. " +
           shortest(found->highest) +
           (bound == found->highest ? " by the launch option --set " + assignment(key, *bound) : "");
  }
  next_ = now_;
  const std::string assigned = assignment(key, value);
  std::erase_if(next_.live, [&](const std::string& o) { return key_of(o) == key; });
  next_.live.push_back(assigned);
  words_ = assigned;
  return {};
}

std::optional<ligature_msg::ack_t> SceneDesk::request(const ligature_msg::command_t& command, bool may_push) {
  const bool is_scene = command.kind == ligature_msg::command_t::KIND_LOAD_SCENE;
  const auto refused = [&](const std::string& why) {
    ligature_msg::ack_t ack{};
    ack.id = command.id;
    ack.reason = why;
    return ack;
  };
  if (busy_) return command.id == asked_.id ? std::nullopt : std::optional(refused("another change is under way"));
  if (is_scene && may_push) return refused("force may flow: disarm first, a scene is loaded in OFF or IDLE only");
  const std::string text = command.text.substr(0, 100);
  if (const auto why = is_scene ? prepare_scene(text) : prepare_parameter(text, command.value); !why.empty())
    return refused(why);
  asked_ = command;
  busy_ = true;
  building_ = std::async(std::launch::async, [this, setup = next_, is_scene] { return build(setup, !is_scene); });
  return std::nullopt;
}

std::variant<SceneDesk::Built, std::string> SceneDesk::build(Setup setup, bool keeps_motion) const {
  platform::flush_denormals();
  auto planned = make_plan(setup.file, launch_.with(setup.live, setup.file), device_);
  if (const auto* refusal = std::get_if<Refusal>(&planned)) return refusal->text;
  Plan& plan = std::get<Plan>(planned);
  if (const auto why = rehearse(plan.thread); !why.empty()) return why;
  const Measure measure = measure_on(core_, options_.budget_percent);
  const auto excess = objection_of(measure(plan.scene, kAdmission_s), plan.scene, measure);
  if (excess && !options_.force) return excess->text;
  setup.scene = plan.scene;
  if (!keeps_motion) setup.from_file = plan.scene;
  auto plant =
      std::make_unique<control::Plant>(control::Plant{std::move(plan.thread), plan.scene.hands, keeps_motion, false});
  return Built{std::move(plant), std::move(setup), std::move(plan.toml)};
}

SceneDesk::Outcome SceneDesk::answer(const std::string& why, std::optional<Changed> changed) const {
  Outcome outcome{{}, std::move(changed)};
  outcome.ack.id = asked_.id;
  outcome.ack.accepted = outcome.changed ? 1 : 0;
  outcome.ack.reason = why;
  return outcome;
}

std::optional<SceneDesk::Outcome> SceneDesk::poll() {
  if (building_.valid() && building_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    auto result = building_.get();
    if (const auto* why = std::get_if<std::string>(&result)) {
      busy_ = false;
      return answer(*why);
    }
    lent_ = std::move(std::get<Built>(result));
    handover_.offer(lent_->plant.get());
  }
  const control::Plant* back = handover_.collect();
  if (back == nullptr || !lent_) return std::nullopt;
  busy_ = false;
  const Built done = *std::exchange(lent_, std::nullopt);
  if (!back->taken) return answer("force may flow: disarm first, a scene is loaded in OFF or IDLE only");
  now_ = done.setup;
  return answer(words_,
                Changed{now_.file, done.toml, words_, now_.scene.hands.max_force_N, now_.scene.suture.radius_m});
}

ligature_msg::offer_t SceneDesk::offer() const {
  ligature_msg::offer_t offer{};
  offer.scenes = scenes_;
  for (const auto& p : parameters()) {
    ligature_msg::parameter_t parameter{};
    parameter.key = p.key, parameter.name = p.name, parameter.unit = p.unit;
    parameter.value = p.value, parameter.lowest = p.lowest, parameter.highest = p.highest;
    offer.parameters.push_back(parameter);
  }
  return offer;
}

}  // namespace ligature::app
