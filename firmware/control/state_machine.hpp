#pragma once
// The rig's states: transition table, transition function, and compile-time checks. The class Controller acts on them.

#include <array>
#include <cstdint>

namespace ligature::control {

/// Values are part of the interface: protocol/lcm/tick_t.lcm.
enum class State : std::uint8_t {
  kOff = 0,        ///< drives off or starting up to Operation enabled; no torque
  kCalibrate = 1,  ///< drives on; encoders must show a possible pose for 50 ticks; no torque
  kIdle = 2,       ///< ready; no torque
  /// Armed. Each hand waits until its dead-man is pressed, the hand is still and its force small; then its gain rises
  kEngage = 3,
  kForce = 4,  ///< at least one hand has full force
  kBrake = 5,  ///< forces ramp to zero
  kFault = 6,  ///< latched; no torque, power stages off
};
inline constexpr int kStates = 7;

enum class Event : std::uint8_t {
  kDrivesUp,
  kCalibrated,
  kArm,
  kEngaged,
  kLetGo,
  kTooFast,
  kDisarm,
  kStopped,
  kPowerDown,
  kFault,
  kReset
};
inline constexpr int kEvents = 11;

struct Transition {
  State from;
  Event on;
  State to;
};
inline constexpr std::array kTransitions{
    Transition{State::kOff, Event::kDrivesUp, State::kCalibrate},
    Transition{State::kCalibrate, Event::kCalibrated, State::kIdle},
    Transition{State::kCalibrate, Event::kPowerDown, State::kOff},
    Transition{State::kIdle, Event::kArm, State::kEngage},
    Transition{State::kIdle, Event::kPowerDown, State::kOff},
    Transition{State::kEngage, Event::kEngaged, State::kForce},
    Transition{State::kEngage, Event::kDisarm, State::kBrake},
    Transition{State::kEngage, Event::kTooFast, State::kBrake},
    Transition{State::kForce, Event::kLetGo, State::kEngage},
    Transition{State::kForce, Event::kTooFast, State::kBrake},
    Transition{State::kForce, Event::kDisarm, State::kBrake},
    Transition{State::kBrake, Event::kStopped, State::kIdle},
    Transition{State::kFault, Event::kReset, State::kOff},
};

[[nodiscard]] constexpr State next(State s, Event e) noexcept {
  if (e == Event::kFault) return State::kFault;  // from any state
  for (const Transition& t : kTransitions) {
    if (t.from == s && t.on == e) return t.to;
  }
  return s;  // events that are not listed for a state have no effect
}

/// Only in these three states may torque be commanded.
[[nodiscard]] constexpr bool may_push(State s) noexcept {
  return s == State::kEngage || s == State::kForce || s == State::kBrake;
}

[[nodiscard]] constexpr const char* name(State s) noexcept {
  constexpr std::array kNames{"OFF", "CALIBRATE", "IDLE", "ENGAGE", "FORCE", "BRAKE", "FAULT"};
  return kNames[static_cast<std::size_t>(s)];
}

static_assert([] {  // every state leads to FAULT on a fault, and only a reset leaves FAULT
  for (int s = 0; s < kStates; ++s) {
    if (next(static_cast<State>(s), Event::kFault) != State::kFault) return false;
  }
  for (int e = 0; e < kEvents; ++e) {
    if (static_cast<Event>(e) != Event::kReset && next(State::kFault, static_cast<Event>(e)) != State::kFault)
      return false;
  }
  return true;
}());
static_assert([] {  // the only transition from no torque to torque is arming in IDLE
  for (const Transition& t : kTransitions) {
    if (!may_push(t.from) && may_push(t.to) && !(t.from == State::kIdle && t.on == Event::kArm)) return false;
  }
  return true;
}());
static_assert([] {  // from every state with torque, kDisarm and then kStopped lead to one without
  for (const State s : {State::kEngage, State::kForce, State::kBrake}) {
    if (may_push(next(next(s, Event::kDisarm), Event::kStopped))) return false;
  }
  return true;
}());
static_assert([] {  // no two rows have the same state and event
  for (std::size_t i = 0; i < kTransitions.size(); ++i) {
    for (std::size_t j = i + 1; j < kTransitions.size(); ++j) {
      if (kTransitions[i].from == kTransitions[j].from && kTransitions[i].on == kTransitions[j].on) return false;
    }
  }
  return true;
}());

}  // namespace ligature::control
