#pragma once
// Motion of two hands over time: the script that a simulated device or the offline lab plays. CSV columns:
//   time,hand,x,y,z,grip        s, L or R, m, m, m, 0 or 1      `#` starts a comment
// and, if hands also turn, three more columns: turn_x,turn_y,turn_z in degrees. A line before the header selects the
// interpolation between keys; the default is `rests`:
//   motion,rests                at rest in every key, smoothstep between keys
//   motion,monotone-cubic       passes the keys without stopping, as for recorded motions

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "protocol/scene/scene.hpp"

namespace ligature::scene {

/// One key: at time_s the hand is at p_W_m; `grip` holds from then until the next key.
struct GripKey {
  double time_s = 0.0;
  Vec p_W_m{};
  bool grip = false;
  /// Rotation vector of the tool since its rest pose, about the axes of W; may exceed 360
  Vec turn_deg{};
  Vec v_W_m_per_s{}, turn_deg_per_s{};  ///< velocities with which the hand passes the key; zero: it stops there
};

/// Interpolation between keys.
enum class Motion : std::uint8_t { kRests, kMonotoneCubic };

// clang-tidy warns wrongly here: the reserved identifier is a loop variable that the compiler generates to copy the
// array.
struct GripperScript {           // NOLINT(bugprone-reserved-identifier)
  std::vector<GripKey> keys[2];  ///< 0 = L, 1 = R; times strictly increase within a hand; empty: no such hand
  bool turns = false;            ///< the turn columns are present: grippers hold the thread's direction and roll
  Motion motion = Motion::kRests;
};

struct ToolPose {
  Vec p_W_m{};
  Vec v_W_m_per_s{};
  bool grip = false;
  Vec turn_deg{};
};

/// Position of a hand without a script: far from everything.
inline constexpr Vec kParked_W_m{0.0, 0.0, -1000.0};

/// Reads a script. Refuses, with file and line: wrong header or column count, a cell that is not a finite number, a
/// negative time, a hand other than L or R, a grip other than 0 or 1, a time that does not increase within its hand, an
/// unknown motion.
[[nodiscard]] std::variant<GripperScript, Error> load_gripper_script(const std::filesystem::path& path);

/// Text of a script that reads back as this one, rounded: times to 0.1 ms, positions to 1 um, turns to 0.001 degrees.
/// @param remark text of the first line, without `#`
[[nodiscard]] std::string gripper_script_text(const GripperScript& script, const std::string& remark);

/// Pose at time t. Between keys a and b, T apart, the cubic with the keys' positions and velocities,
///   p = a + (b - a) s(u) + T (u (1 - u)^2 v_a - u^2 (1 - u) v_b),   s(u) = 3u^2 - 2u^3,   u = (t - t_a) / T;
/// smoothstep if both keys are at rest. Constant before the first and after the last key. Grip is that of the last key
/// with time <= t, and open before the first.
/// @param keys one hand's keys in order of time; empty gives kParked_W_m.
[[nodiscard]] ToolPose sample(std::span<const GripKey> keys, double t_s) noexcept;

/// Time of the last key of either hand, s.
[[nodiscard]] double end_time_s(const GripperScript& script) noexcept;

}  // namespace ligature::scene
