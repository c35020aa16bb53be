#pragma once
// What two hands do over time: the operator's script that a simulated device or the offline lab plays.
//   time,hand,x,y,z,grip        s, L or R, m, m, m, 0 or 1      `#` starts a comment
// and, in a script of hands that turn, three columns more: turn_x,turn_y,turn_z, degrees. A line before the header says
// how a hand goes from key to key; without it, it comes to rest in every key:
//   motion,rests                at rest in every key, and smoothstep between them
//   motion,monotone-cubic       through the keys without a stop, as recorded hands go

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "protocol/scene/scene.hpp"

namespace ligature::scene {

/// At time_s the hand is at p_W_m; from then on it grips or not, until the next key.
struct GripKey {
  double time_s = 0.0;
  Vec p_W_m{};
  bool grip = false;
  Vec turn_deg{};  ///< rotation vector of the tool since its rest, about the axes of W; more than a turn is more than
                   ///< 360
  Vec v_W_m_per_s{}, turn_deg_per_s{};  ///< with which the hand passes; zero: it rests there
};

/// How a hand goes from key to key.
enum class Motion : std::uint8_t { kRests, kMonotoneCubic };

// The implicit copy of the array below has a loop variable of the compiler's own, which the check takes for ours.
struct GripperScript {           // NOLINT(bugprone-reserved-identifier)
  std::vector<GripKey> keys[2];  ///< 0 = L, 1 = R; times strictly increase within a hand; empty: the hand is absent
  bool turns = false;            ///< it has the turn columns: grippers hold the thread's direction and roll
  Motion motion = Motion::kRests;
};

struct ToolPose {
  Vec p_W_m{};
  Vec v_W_m_per_s{};
  bool grip = false;
  Vec turn_deg{};
};

/// Where a hand without a script waits: so far away that it touches nothing.
inline constexpr Vec kParked_W_m{0.0, 0.0, -1000.0};

/// Reads a script. Refused, with file and line: wrong header or column count, a cell that is not a finite number, a
/// negative time, a hand other than L or R, a grip other than 0 or 1, a time that does not increase within its hand,
/// an unknown motion.
[[nodiscard]] std::variant<GripperScript, Error> load_gripper_script(const std::filesystem::path& path);

/// The text of a script that reads back as this one: times to 0.1 ms, places to 1 um, turns to 0.001 degrees.
/// @param remark first line, without its `#`
[[nodiscard]] std::string gripper_script_text(const GripperScript& script, const std::string& remark);

/// Pose at time t: between keys a and b, T apart, the cubic that has the keys' positions and velocities at its ends,
///   p = a + (b - a) s(u) + T (u (1 - u)^2 v_a - u^2 (1 - u) v_b),   s(u) = 3u^2 - 2u^3,
/// smoothstep where both keys are at rest; held before the first key and after the last one. Grip is that of the last
/// key with time <= t, open before the first.
/// @param keys one hand's keys in rising time; empty gives kParked_W_m.
[[nodiscard]] ToolPose sample(std::span<const GripKey> keys, double t_s) noexcept;

/// When the last key of either hand is due, s.
[[nodiscard]] double end_time_s(const GripperScript& script) noexcept;

}  // namespace ligature::scene
