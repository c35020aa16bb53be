#pragma once
// Scripts and hand models for the haptics experiments, on the knotted suture of scenes/suture-3-0-knot.toml. Scale 1:
// one device metre is one world metre.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "host/lab/rig/virtual_rig.hpp"
#include "sim_device/unrest.hpp"

namespace ligature::lab {

/// No gravity: both ends of the thread are free, and it would fall before it is grasped.
inline constexpr const char* kWeightless = "world.gravity_m_per_s2=[0,0,0]";

/// Distance of each hand from the middle at which it first feels `force_N`, when the knotted suture is pulled slowly.
/// Measured by a run, because the loose knot springs open before it is grasped, by an amount that depends on the
/// solver.
[[nodiscard]] double apart_when_felt_m(const scene::Scene& knotted, double force_N);

/// Both hands grasp the thread 8 cm from the knot's middle, pull to `apart_m` from the middle each, rest and release.
[[nodiscard]] scene::GripperScript pull_and_release(double apart_m, double draw_s = 2.0, double rest_s = 1.5);
/// Pulls the knot tight, then relaxes and pulls again `times` times, each motion in `beat_s`: the knot jams more each
/// time.
[[nodiscard]] scene::GripperScript jam(double apart_m, double beat_s, int times);
/// The right hand releases and grasps again under tension, every 0.3 s.
[[nodiscard]] scene::GripperScript slip(double apart_m);

/// Pulls the thread tight, moves it away from the user by `push_m`, half back, and forward again. With kPeg in the
/// scene the thread is pushed against a peg.
[[nodiscard]] scene::GripperScript against_peg(double apart_m, double push_m);
inline constexpr const char* kPeg = "world.pegs=[{from_m=[0,0.004,-0.1],to_m=[0,0.004,0.2],radius_m=0.002}]";
/// Pulls the thread tight, then both hands move left by `shift_m`: the left hand pulls, the right one is dragged.
[[nodiscard]] scene::GripperScript give_way(double apart_m, double shift_m);
/// The left hand pulls down the end of a stiff object: a thread of 2 cm that hangs from a post (short_thread()).
[[nodiscard]] scene::GripperScript on_a_short_thread(double pull_m);
[[nodiscard]] std::vector<std::string> short_thread();

/// A hand that is displaced by `by_m` between two times, with a jump at each.
class Teleporting final : public sim::Intention {
 public:
  Teleporting(std::unique_ptr<sim::Intention> calm, double from_s, double to_s, const sim::Vec3& by_m)
      : calm_(std::move(calm)), from_s_(from_s), to_s_(to_s), by_m_(by_m) {}
  [[nodiscard]] sim::Intent at(double t_s, const sim::Touch& touch) const noexcept override {
    sim::Intent now = calm_->at(t_s, touch);
    if (t_s >= from_s_ && t_s < to_s_) now.p_DH += by_m_;
    return now;
  }
  [[nodiscard]] double end_s() const noexcept override { return calm_->end_s(); }
  [[nodiscard]] sim::Vec3 start_D_m() const noexcept override { return calm_->start_D_m(); }

 private:
  std::unique_ptr<sim::Intention> calm_;
  double from_s_, to_s_;
  sim::Vec3 by_m_;
};

/// Two scripted hands, each passed through `wrap`.
template <class Wrap>
[[nodiscard]] VirtualRig::Intentions wrapped(const RigSetup& setup, const scene::GripperScript& script,
                                             const Wrap& wrap) {
  VirtualRig::Intentions hands = scripted_hands(setup, script);
  for (auto& hand : hands) hand = wrap(std::move(hand));
  return hands;
}

}  // namespace ligature::lab
