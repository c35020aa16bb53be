#pragma once
// Scene settings from the command line. They apply for the whole run, also to scenes that commands load later.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/app/options.hpp"
#include "protocol/scene/recorded_scene.hpp"

namespace ligature::app {

/// All `--set` options in order, then --override-passivity.
[[nodiscard]] std::vector<std::string> launch_overrides(const RunOptions& options);

class Launch {
 public:
  /// @param launched the scene at the start of the run, overrides included
  Launch(const RunOptions& options, const scene::Scene& launched);

  /// Combines the launch's overrides with those of commands (`live`). Where both set a key, only the command's value is
  /// kept. The only safety limit that a command can set is hands.force_scale, and highest() bounds it.
  [[nodiscard]] std::vector<std::string> with(const std::vector<std::string>& live) const;

  /// Overrides for a scene that a command loads from `file`. A force limit of the launch is replaced by the scene's own
  /// limit if that is lower; otherwise as above.
  [[nodiscard]] std::vector<std::string> with(const std::vector<std::string>& live, const std::string& file,
                                              const std::string& text) const;

  /// Largest value to which a command may set the limit `key`; empty if the launch options do not bound it.
  [[nodiscard]] std::optional<double> highest(std::string_view key) const;

  /// The launch options that commands (`live`) have not replaced, as text: "--set hands.max_force_N=1.0,
  /// --override-passivity".
  [[nodiscard]] std::string held(const std::vector<std::string>& live) const;

 private:
  std::vector<std::string> overrides_;
  scene::Hands hands_;
};

using scene::key_of;

}  // namespace ligature::app
