#pragma once
// Scripts and hands of the haptics runs, for the knotted suture of scenes/suture-3-0-knot.toml: world = device, 1 : 1.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "host/lab/rig/virtual_rig.hpp"
#include "sim_device/unrest.hpp"

namespace ligature::lab {

/// Both its ends are free: without this it falls before it is taken.
inline constexpr const char* kWeightless = "world.gravity_m_per_s2=[0,0,0]";

/// Of each hand from the middle when it first feels so much of the knotted suture, drawn slowly. A rig that does it
/// says this, and not the scene: the loose knot springs open before it is taken, and how far is the solver's business.
[[nodiscard]] double apart_when_felt_m(const scene::Scene& knotted, double force_N);

/// Both hands take the thread 8 cm from the knot's middle, draw apart to `apart_m` each, rest there, let go.
[[nodiscard]] scene::GripperScript pull_and_release(double apart_m, double draw_s = 2.0, double rest_s = 1.5);
/// Drawn apart and back in `beat_s`, again and again: the knot jams a little more each time.
[[nodiscard]] scene::GripperScript jam(double apart_m, double beat_s, int times);
/// The right hand lets go and takes hold again under tension, every 0.3 s.
[[nodiscard]] scene::GripperScript slip(double apart_m);

/// Away from the person by `push_m` and half back, again: against a peg if the scene has one in the way.
[[nodiscard]] scene::GripperScript against_peg(double apart_m, double push_m);
inline constexpr const char* kPeg = "world.pegs=[{from_m=[0,0.004,-0.1],to_m=[0,0.004,0.2],radius_m=0.002}]";
/// Drawn apart, then both to the left by `shift_m`: the left hand pulls, the right one gives way.
[[nodiscard]] scene::GripperScript give_way(double apart_m, double shift_m);
/// The left hand pulls down the end of a thread of 2 cm that hangs from a post (short_thread()): a stiff thing.
[[nodiscard]] scene::GripperScript on_a_short_thread(double pull_m);
[[nodiscard]] std::vector<std::string> short_thread();

/// A hand that is elsewhere between two moments, at once.
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

/// Two scripted intentions, each wrapped by `wrap` (or as they are).
template <class Wrap>
[[nodiscard]] VirtualRig::Intentions wrapped(const RigSetup& setup, const scene::GripperScript& script, Wrap wrap) {
  VirtualRig::Intentions hands = scripted_hands(setup, script);
  for (auto& hand : hands) hand = wrap(std::move(hand));
  return hands;
}

}  // namespace ligature::lab
