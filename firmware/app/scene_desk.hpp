#pragma once
// Changes of scene and of parameters while the rig runs: judged, built and measured here, taken over by the loop.

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "firmware/app/launch.hpp"
#include "firmware/app/live_parameters.hpp"
#include "firmware/app/rig_setup.hpp"
#include "firmware/control/plant.hpp"
#include "ligature_msg/ack_t.hpp"
#include "ligature_msg/command_t.hpp"
#include "ligature_msg/offer_t.hpp"

namespace ligature::app {

/// A change that the loop has taken over.
struct Changed {
  std::string file, toml, text;  ///< text: one line for people
  double max_force_N, radius_m;
  bool admitted;
  std::int64_t first_tick;
};

/// What the text of a scene says when it is not admitted and --force runs it: "\n# --force: ..", or nothing.
[[nodiscard]] std::string forced(const std::string& excess);

/// The telemetry thread's; a thread of its own builds, one change at a time. A scene is read once; a child process
/// builds it, lets it prove in a rehearsal that it stays finite and, with --no-loss, that its knot loses no time
/// (unless
/// --force); only then it is built here and handed over. None of that runs on the loop's core, nor with its priority.
/// The loop judges the state once more. Whatever comes back is destroyed here.
class SceneDesk {
 public:
  /// @param plan of the start, as it will be run.
  /// @param excess why it is not admitted; empty: it is. @param always  so with any scene: it is the loop that is too
  /// slow.
  SceneDesk(const RunOptions& options, const Plan& plan, const std::string& excess = {}, bool always = false);
  ~SceneDesk() { ending_ = true; }  // and waits for a builder that is told so
  SceneDesk(const SceneDesk&) = delete;
  SceneDesk& operator=(const SceneDesk&) = delete;

  [[nodiscard]] control::PlantHandover& handover() noexcept { return handover_; }

  [[nodiscard]] static bool is_for(const ligature_msg::command_t& command) noexcept {
    return command.kind == ligature_msg::command_t::KIND_LOAD_SCENE ||
           command.kind == ligature_msg::command_t::KIND_SET_PARAMETER;
  }

  /// @param may_push whether force may flow now, as far as is known. @return a refusal, or nothing: poll() answers.
  [[nodiscard]] std::optional<ligature_msg::ack_t> request(const ligature_msg::command_t& command, bool may_push);

  /// What has become of the request: its answer, and the change when there was one.
  struct Outcome {
    ligature_msg::ack_t ack;
    std::optional<Changed> changed;
  };
  [[nodiscard]] std::optional<Outcome> poll();

  /// Whether a change is asked for and not yet answered; the loop may have it.
  [[nodiscard]] bool is_busy() const noexcept { return busy_; }

  [[nodiscard]] ligature_msg::offer_t offer() const;

 private:
  struct Setup {  // what the loop runs
    std::string file;
    std::vector<std::string> live;  // overrides of commands; those of the launch hold beside them
    scene::Scene from_file, scene;
    std::string excess;  // why it is not admitted; empty: it is
  };
  struct Built {
    std::unique_ptr<control::Plant> plant;
    Setup setup;
    std::string toml;
  };
  [[nodiscard]] std::string prepare_scene(const std::string& wish);
  [[nodiscard]] std::vector<LiveParameter> parameters() const;
  [[nodiscard]] std::string prepare_parameter(const std::string& key, double value);
  [[nodiscard]] long work_of_this_machine(const Plan& plan) const;
  [[nodiscard]] std::variant<Built, std::string> build(Setup setup, bool keeps_motion) const;
  [[nodiscard]] Outcome answer(const std::string& why, std::optional<Changed> changed = {}) const;

  RunOptions options_;
  device::Device device_;
  std::string loop_excess_;  // of any scene
  long work_;  // what this machine affords for contact; 0: not known, the launch's model has no such bound
  Launch launch_;
  std::vector<std::string> scenes_;
  Setup now_;
  control::PlantHandover handover_;

  ligature_msg::command_t asked_{};
  std::string words_;  // of what is asked
  Setup next_;
  std::atomic<bool> ending_{false};
  std::future<std::variant<Built, std::string>> building_;
  std::optional<Built> lent_;  // with the loop
  bool busy_ = false;
};

}  // namespace ligature::app
