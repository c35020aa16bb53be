#pragma once
// What the command line says about the scene: it holds for the whole run, whatever scene a command loads.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/app/options.hpp"
#include "protocol/scene/recorded_scene.hpp"

namespace ligature::app {

/// Every `--set`, in order, then --override-passivity.
[[nodiscard]] std::vector<std::string> launch_overrides(const RunOptions& options);

class Launch {
 public:
  /// @param launched the scene that the run began with, overrides included.
  Launch(const RunOptions& options, const scene::Scene& launched);

  /// The launch's overrides, then those of commands; of the same key only the command's. Commands can name no limit but
  /// hands.force_scale, which highest() bounds.
  [[nodiscard]] std::vector<std::string> with(const std::vector<std::string>& live) const;

  /// The same, and with the force limit of the scene, read from `file`, where that is lower than the launch's.
  [[nodiscard]] std::vector<std::string> with(const std::vector<std::string>& live, const std::string& file,
                                              const std::string& text) const;

  /// The most that a command may set a limit to; nothing when the launch does not bound it.
  [[nodiscard]] std::optional<double> highest(std::string_view key) const;

  /// "--set hands.max_force_N=1.0, --override-passivity": the options that hold beside these overrides of commands.
  [[nodiscard]] std::string held(const std::vector<std::string>& live) const;

 private:
  std::vector<std::string> overrides_;
  scene::Hands hands_;
};

using scene::key_of;

}  // namespace ligature::app
