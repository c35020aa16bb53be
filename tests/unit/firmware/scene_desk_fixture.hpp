#pragma once
// A SceneDesk with some scenes in a folder, and a loop that takes what the desk offers.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "firmware/app/scene_desk.hpp"
#include "firmware/platform/sanitized.hpp"

namespace ligature::app {

namespace fs = std::filesystem;
using ligature_msg::command_t;

class SceneDeskTest : public ::testing::Test {
 protected:
  SceneDeskTest() {
    fs::create_directories(folder);
    write("small.toml", "[suture]\nnodes = 10\n[world]\nfixed = [{node = 0, position_m = [0.0, 0.0, 5.5]}]\n");
    write("longer.toml",
          "[suture]\nnodes = 20\nradius_m = 0.04\n[world]\nfixed = [{node = 0, position_m = [0.0, 0.0, 5.5]}]\n");
    write("wrong.toml", "[suture]\nnodes = 1\n");
    write("huge.toml", "[suture]\nnodes = 5000\nlength_m = 50.0\nradius_m = 0.003\n");
    options.scene = (folder / "small.toml").string();
    options.program = LIGATURE_FIRMWARE;
#ifdef LIGATURE_SANITIZED
    options.force = true;  // a sanitizer slows the program down, so admission would fail
#endif
  }
  ~SceneDeskTest() override { fs::remove_all(folder); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }

  static command_t load(const std::string& name, std::int64_t id = 1) {
    command_t c{};
    c.id = id, c.kind = command_t::KIND_LOAD_SCENE, c.text = name;
    return c;
  }
  static command_t set(const std::string& key, double value, std::int64_t id = 1) {
    command_t c{};
    c.id = id, c.kind = command_t::KIND_SET_PARAMETER, c.text = key, c.value = value;
    return c;
  }
  SceneDesk desk() const { return SceneDesk(options, std::get<Plan>(make_plan(options))); }

  /// Acts as the loop until the desk has answered. @param takes whether the loop accepts what the desk offers.
  SceneDesk::Outcome outcome(SceneDesk& desk, bool takes = true) {
    for (;;) {
      if (auto* plant = desk.handover().take()) {
        plant->taken = takes;
        plant->first_tick = 1234;
        hands = plant->hands;
        nodes = static_cast<int>(plant->thread.nodes_W().size());
        desk.handover().give_back(plant);
      }
      if (auto o = desk.poll()) return *o;
      std::this_thread::yield();
    }
  }

  const fs::path folder = fs::temp_directory_path() / ("ligature-desk-" + std::to_string(getpid()));
  RunOptions options;
  scene::Hands hands;  // as handed to the loop last
  int nodes = 0;
};

}  // namespace ligature::app
