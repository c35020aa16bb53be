#pragma once
// Pulls a scene's loose knot tight with two hands, tick by tick.

#include <array>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "firmware/physics/rod/rod_simulation.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::test {

using physics::Hand;
using physics::ToolInput;
using physics::rod::RodSimulation;

class Tightening {
 public:
  explicit Tightening(const std::vector<std::string>& overrides = {}, const char* scene = "suture-3-0-knot.toml")
      : sim_(make(overrides, scene)) {
    tools_[0].p_WT = sim_.nodes_W().front();
    tools_[1].p_WT = sim_.nodes_W().back();
    tools_[0].grip = tools_[1].grip = true;
  }
  RodSimulation& sim() { return sim_; }
  std::array<ToolInput, 2>& tools() { return tools_; }
  void move(double speed) {
    for (std::size_t h = 0; h < 2; ++h) {
      tools_[h].v_WT.x() = h == 0 ? -speed : speed;
      tools_[h].p_WT.x() += 1e-3 * tools_[h].v_WT.x();
    }
  }
  void tick(double speed) {
    move(speed);
    sim_.tick(tools_);
  }
  static double force(const RodSimulation& sim) {
    return 0.5 * (sim.hand(Hand::kLeft).f_W.x() - sim.hand(Hand::kRight).f_W.x());
  }

 private:
  static RodSimulation make(const std::vector<std::string>& overrides, const char* scene) {
    auto read = scene::load_scene(std::string(LIGATURE_SOURCE_DIR) + "/scenes/" + scene, overrides);
    if (auto* error = std::get_if<scene::Error>(&read)) throw std::runtime_error(error->text);
    auto made = RodSimulation::make(std::get<scene::Scene>(read));
    if (auto* why = std::get_if<std::string>(&made)) throw std::runtime_error(*why);
    return std::get<RodSimulation>(std::move(made));
  }
  RodSimulation sim_;
  std::array<ToolInput, 2> tools_{};
};

}  // namespace ligature::test
