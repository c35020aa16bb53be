#include "firmware/app/scene_desk.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <thread>
#include <utility>

#include "firmware/app/admission.hpp"
#include "firmware/app/rehearsal_process.hpp"
#include "firmware/app/scene_preview.hpp"
#include "firmware/platform/realtime.hpp"
#include "protocol/scene/text_file.hpp"

namespace ligature::app {
namespace {

namespace fs = std::filesystem;

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

/// "key=value" as a TOML assignment. A whole value prints as an integer, which readers of floats accept as well.
std::string assignment(const std::string& key, double value) { return key + "=" + shortest(value); }

}  // namespace

std::string forced(const std::string& excess) { return excess.empty() ? excess : "\n# --force: " + excess + "\n"; }

SceneDesk::SceneDesk(const RunOptions& options, const Plan& plan, const std::string& excess, bool always)
    : options_(options),
      device_(plan.device),
      loop_excess_(always ? excess : ""),
      work_(plan.thread.work()),
      launch_(options, plan.scene),
      now_{options.scene, {}, plan.scene, plan.scene, excess} {
  const fs::path given = options.scenes.empty() ? fs::path(options.scene).parent_path() : fs::path(options.scenes);
  options_.scenes = given.empty() ? "." : given.string();
  find_scenes();
}

/// Lists the scenes of the folder, and makes a preview of each one.
void SceneDesk::find_scenes() {
  scenes_ = scene_files(options_.scenes);
  previews_.clear();
  for (const auto& name : scenes_) previews_.push_back(preview_of(fs::path(options_.scenes) / name, launch_.with({})));
}

/// Prepares next_ from `wish`: the name of a scene, optionally with another model or number of nodes, such as
/// "knot.toml suture.model=paper-2 suture.nodes=35". @return why not, or empty.
std::string SceneDesk::prepare_scene(const std::string& wish) {
  std::istringstream words(wish);
  std::string name;
  words >> name;
  std::vector<std::string> live;
  for (std::string word; words >> word; live.push_back(word)) {
    if (key_of(word) != "suture.model" && key_of(word) != "suture.nodes")
      return "found '" + word + "' after the scene, allowed suture.model=MODEL and suture.nodes=N";
  }
  find_scenes();
  if (std::ranges::find(scenes_, name) == scenes_.end()) {
    std::string allowed;
    for (const auto& s : scenes_) allowed += (allowed.empty() ? "" : ", ") + s;
    return "no such scene, allowed " + (allowed.empty() ? "none: " + options_.scenes + " has no scene" : allowed);
  }
  words_ = "scene " + name + " loaded";
  for (const auto& l : live) words_ += (&l == &live.front() ? " with " : " ") + l;
  if (const auto held = launch_.held(live); !held.empty()) words_ += "; launch options hold: " + held;
  next_ = {(fs::path(options_.scenes) / name).string(), std::move(live), {}, {}, {}};
  return {};
}

/// The parameters that may change, with ranges cut to the launch's limits.
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
  try {
    building_ = std::async(std::launch::async, [this, setup = next_, is_scene] { return build(setup, !is_scene); });
  } catch (const std::exception& error) {
    return refused("no thread can be started for the change (" + std::string(error.what()) + ")");
  }
  asked_ = command;
  busy_ = true;
  return std::nullopt;
}

/// Contact budget that this machine can afford. It was measured at the launch; if the launch's model had no budget, it
/// is measured now, outside the loop.
long SceneDesk::work_of_this_machine(const Plan& plan) const {
  if (plan.thread.work() == 0 || work_ > 0) return plan.thread.work() == 0 ? 0 : work_;
  return admit(plan.scene, {.device = plan.device}).thread.work;
}

/// Rehearses the scene in a child process that may crash; if that succeeds, builds it in this process.
std::variant<SceneDesk::Built, std::string> SceneDesk::build(Setup setup, bool keeps_motion) const {
  platform::flush_denormals();
  const auto read = scene::read_text(setup.file, scene::kMostScene_bytes);
  if (const auto* error = std::get_if<scene::Error>(&read)) return error->text;
  const auto& text = std::get<std::string>(read);
  const auto verdict = rehearse_elsewhere({.program = options_.program,
                                           .file = setup.file,
                                           .text = text,
                                           .overrides = launch_.with(setup.live),
                                           .no_loss_m_per_s = keeps_motion ? 0.0 : options_.no_loss_m_per_s},
                                          ending_);
  if (!verdict.refusal.empty()) return verdict.refusal;
  if (!verdict.excess.empty() && !options_.force) return verdict.excess;
  auto planned = plan_of(setup.file, text, launch_.with(setup.live, setup.file, text), device_);
  if (const auto* refusal = std::get_if<Refusal>(&planned)) return refusal->text;
  Plan& plan = std::get<Plan>(planned);
  give_work(plan, work_of_this_machine(plan));
  setup.scene = plan.scene;
  if (!keeps_motion) setup.from_file = plan.scene, setup.excess = loop_excess_.empty() ? verdict.excess : loop_excess_;
  auto plant =
      std::make_unique<control::Plant>(control::Plant{std::move(plan.thread), plan.scene.hands, keeps_motion, false});
  plan.toml += forced(setup.excess);
  return Built{std::move(plant), std::move(setup), std::move(plan.toml)};
}

SceneDesk::Outcome SceneDesk::answer(const std::string& why, std::optional<Changed> changed) const {
  Outcome outcome{{}, std::move(changed)};
  outcome.ack.id = asked_.id;
  outcome.ack.accepted = outcome.changed ? 1 : 0;
  outcome.ack.reason = why;
  return outcome;
}

/// What build() has returned, or why it threw.
std::variant<SceneDesk::Built, std::string> SceneDesk::built() {
  try {
    return building_.get();
  } catch (const std::exception& error) {  // mostly out of memory; the scene in force goes on
    return "the scene cannot be built (" + std::string(error.what()) + ")";
  }
}

std::optional<SceneDesk::Outcome> SceneDesk::poll() {
  if (building_.valid() && building_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    auto result = built();
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
  const Built done = std::exchange(lent_, std::nullopt).value();
  if (!back->taken)
    return answer(back->keeps_motion ? "the running thread has another model or number of nodes: load the scene anew"
                                     : "force may flow: disarm first, a scene is loaded in OFF or IDLE only");
  now_ = done.setup;
  return answer(words_, Changed{now_.file, done.toml, words_, now_.scene.hands.max_force_N, now_.scene.suture.radius_m,
                                now_.excess.empty(), done.plant->first_tick});
}

ligature_msg::offer_t SceneDesk::offer() const {
  ligature_msg::offer_t offer{};
  offer.scenes = scenes_;
  offer.previews = previews_;
  for (const auto& p : parameters()) {
    ligature_msg::parameter_t parameter{};
    parameter.key = p.key, parameter.name = p.name, parameter.unit = p.unit;
    parameter.value = p.value, parameter.lowest = p.lowest, parameter.highest = p.highest;
    offer.parameters.push_back(parameter);
  }
  return offer;
}

}  // namespace ligature::app
