#pragma once
// Changes of scene and parameters while the rig runs: they are checked, built and measured here, then handed over to
// the loop.

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

/// A change that the loop has accepted.
struct Changed {
  std::string file, toml, text;  ///< text: one line for people
  double max_force_N, radius_m;
  bool admitted;
  std::int64_t first_tick;
};

/// Comment that is appended to the text of a scene which runs only because of --force: "
/// # --force: <excess>
/// ". Empty if the scene was admitted (`excess` empty).
[[nodiscard]] std::string forced(const std::string& excess);

/// Handles commands that change scene or parameters, one at a time. The telemetry thread calls it; another thread
/// builds. The scene file is read once. A child process first builds and rehearses the scene: its state must stay
/// finite and, with --no-loss and without --force, its knot must lose no time. Only then is the scene built in this
/// process and handed over. None of this runs on the loop's core or at its priority. The loop checks the rig's state
/// once more before it accepts a change. Simulations that the loop gives back are destroyed here.
class SceneDesk {
 public:
  /// @param plan  the scene with which the program starts
  /// @param excess  why that scene is not admitted; empty: it is
  /// @param always  whether `excess` holds for every scene, because the loop itself is too slow
  SceneDesk(const RunOptions& options, const Plan& plan, const std::string& excess = {}, bool always = false);
  ~SceneDesk() { ending_ = true; }  // the future's destructor waits for the builder, which checks ending_
  SceneDesk(const SceneDesk&) = delete;
  SceneDesk& operator=(const SceneDesk&) = delete;

  [[nodiscard]] control::PlantHandover& handover() noexcept { return handover_; }

  [[nodiscard]] static bool is_for(const ligature_msg::command_t& command) noexcept {
    return command.kind == ligature_msg::command_t::KIND_LOAD_SCENE ||
           command.kind == ligature_msg::command_t::KIND_SET_PARAMETER;
  }

  /// Begins a change. @param may_push whether force may flow, as far as telemetry knows. @return a refusal, or nothing:
  /// then poll() gives the answer later.
  [[nodiscard]] std::optional<ligature_msg::ack_t> request(const ligature_msg::command_t& command, bool may_push);

  /// Result of a request: the answer, and the change if one was made.
  struct Outcome {
    ligature_msg::ack_t ack;
    std::optional<Changed> changed;
  };
  [[nodiscard]] std::optional<Outcome> poll();

  /// Whether a requested change is not answered yet; the loop may already have received it.
  [[nodiscard]] bool is_busy() const noexcept { return busy_; }

  [[nodiscard]] ligature_msg::offer_t offer() const;

 private:
  struct Setup {  // a scene with its overrides, as the loop runs it
    std::string file;
    std::vector<std::string> live;  // overrides by commands; those of the launch apply in addition
    scene::Scene from_file, scene;
    std::string excess;  // why it is not admitted; empty: it is
  };
  struct Built {
    std::unique_ptr<control::Plant> plant;
    Setup setup;
    std::string toml;
  };
  void find_scenes();
  [[nodiscard]] std::string prepare_scene(const std::string& wish);
  [[nodiscard]] std::vector<LiveParameter> parameters() const;
  [[nodiscard]] std::string prepare_parameter(const std::string& key, double value);
  [[nodiscard]] long work_of_this_machine(const Plan& plan) const;
  [[nodiscard]] std::variant<Built, std::string> build(Setup setup, bool keeps_motion) const;
  [[nodiscard]] std::variant<Built, std::string> built();
  [[nodiscard]] Outcome answer(const std::string& why, std::optional<Changed> changed = {}) const;

  RunOptions options_;
  device::Device device_;
  std::string loop_excess_;  // why no scene is admitted (loop too slow); empty: no such reason
  // Contact budget that this machine can afford, instructions per tick; 0: not measured, because the launch's model has
  // none
  long work_;
  Launch launch_;
  std::vector<std::string> scenes_;
  std::vector<ligature_msg::preview_t> previews_;  // of the same scenes
  Setup now_;
  control::PlantHandover handover_;

  ligature_msg::command_t asked_{};
  std::string words_;  // text of the pending request
  Setup next_;
  std::atomic<bool> ending_{false};
  std::future<std::variant<Built, std::string>> building_;
  std::optional<Built> lent_;  // plant handed to the loop and not yet given back
  bool busy_ = false;
};

}  // namespace ligature::app
