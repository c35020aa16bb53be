#pragma once
// A simulation as a Python object.

#include <Python.h>

#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>

#include "firmware/physics/simulation.hpp"
#include "host/lab/outcome.hpp"
#include "python/src/float_mode.hpp"
#include "python/src/inputs.hpp"

namespace ligature::python {

/// Protects the simulation while a run has released the GIL: other Python threads must not change it before the run
/// ends.
class Sim {
 public:
  explicit Sim(const Scene& scene) : scene_(std::make_shared<const Scene>(scene)), simulation_(make(scene)) {}
  Sim(const Sim& other) = default;

  /// @throws std::runtime_error while a run in another Python thread uses it.
  Sim& idle() {
    if (busy_.is_set) throw std::runtime_error("this simulation is running in another thread");
    return *this;
  }

  void tick(const std::array<physics::ToolInput, 2>& tools) {
    const DefaultFloats floats;
    simulation_.tick(tools);
    ++ticks_;
    refresh();
  }
  void reset() {
    const DefaultFloats floats;
    simulation_.reset();
    ticks_ = 0;
    refresh();
  }
  void set_state(std::span<const physics::Vec3> p_W, std::span<const physics::Vec3> v_W) {
    const DefaultFloats floats;
    simulation_.set_state(p_W, v_W);
    refresh();
  }
  [[nodiscard]] std::vector<std::byte> save() const { return simulation_.save(ticks_); }
  /// @throws Refusal when the image is of another scene, or damaged.
  void load(std::span<const std::byte> image) {
    const auto ticks = simulation_.load(image);
    if (const auto* why = std::get_if<std::string>(&ticks)) throw lab::Refusal("image: " + *why);
    ticks_ = std::get<std::int64_t>(ticks);
    refresh();
  }
  void add_ticks(std::int64_t ticks) {
    ticks_ += ticks;
    refresh();
  }

  /// NumPy views of these arrays are kept up to date after the first call.
  [[nodiscard]] std::span<const physics::Vec3> nodes_W() {
    shows_nodes_ = true;
    return simulation_.nodes_W();
  }
  [[nodiscard]] std::span<const physics::Vec3> velocities_W() {
    shows_velocities_ = true;
    return simulation_.velocities_W();
  }

  [[nodiscard]] const Scene& scene() const { return *scene_; }
  [[nodiscard]] physics::Simulation& simulation() { return simulation_; }
  [[nodiscard]] std::int64_t ticks() const { return ticks_; }

  /// Marks the simulation as busy during a run; created and destroyed with the GIL held.
  class Busy {
   public:
    explicit Busy(Sim& sim) : sim_(sim) { sim_.busy_.is_set = true; }
    ~Busy() { sim_.busy_.is_set = false; }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

   private:
    Sim& sim_;
  };

 private:
  struct Flag {  // not copied: a copy is not busy
    Flag() = default;
    Flag(const Flag&) {}
    bool is_set = false;
  };

  static physics::Simulation make(const Scene& scene) {
    const DefaultFloats floats;
    auto made = physics::Simulation::make(scene.scene);
    if (const auto* why = std::get_if<std::string>(&made)) throw lab::Refusal(scene.path + ": " + *why);
    return std::get<physics::Simulation>(std::move(made));
  }

  void refresh() {
    if (shows_nodes_) static_cast<void>(simulation_.nodes_W());
    if (shows_velocities_) static_cast<void>(simulation_.velocities_W());
  }

  std::shared_ptr<const Scene> scene_;
  physics::Simulation simulation_;
  std::int64_t ticks_ = 0;
  bool shows_nodes_ = false, shows_velocities_ = false;
  Flag busy_;
};

}  // namespace ligature::python
