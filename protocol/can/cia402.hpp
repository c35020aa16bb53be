#pragma once
// CiA 402 drive state machine: states and their statusword patterns, commands and their controlword patterns, a
// transition table and a pure transition function. A drive runs next(); the master uses state_of() and
// controlword_towards_operation().

#include <array>
#include <cstdint>
#include <optional>

namespace ligature::can::cia402 {

enum class State : std::uint8_t {
  kNotReadyToSwitchOn,
  kSwitchOnDisabled,
  kReadyToSwitchOn,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStopActive,
  kFaultReactionActive,
  kFault,
};

/// Commands with their controlword bits (x: any value), and events inside the drive.
enum class Event : std::uint8_t {
  kInitialised,        // event inside the drive: self test done
  kShutdown,           // controlword xxxx x110
  kSwitchOn,           // controlword xxxx 0111; in Operation Enabled it means "disable operation"
  kEnableOperation,    // controlword xxxx 1111
  kDisableVoltage,     // controlword xxxx xx0x
  kQuickStop,          // controlword xxxx x01x
  kFaultReset,         // rising edge of controlword bit 7
  kFaultDetected,      // event inside the drive
  kFaultReactionDone,  // event inside the drive: torque is zero
};

struct StatusPattern {
  State state;
  std::uint16_t mask;
  std::uint16_t value;
};
inline constexpr std::array kStatusPatterns{
    StatusPattern{State::kNotReadyToSwitchOn, 0x004F, 0x0000},  StatusPattern{State::kSwitchOnDisabled, 0x004F, 0x0040},
    StatusPattern{State::kReadyToSwitchOn, 0x006F, 0x0021},     StatusPattern{State::kSwitchedOn, 0x006F, 0x0023},
    StatusPattern{State::kOperationEnabled, 0x006F, 0x0027},    StatusPattern{State::kQuickStopActive, 0x006F, 0x0007},
    StatusPattern{State::kFaultReactionActive, 0x004F, 0x000F}, StatusPattern{State::kFault, 0x004F, 0x0008},
};

// Statusword bits outside the state pattern.
inline constexpr std::uint16_t kVoltageEnabledBit = 1U << 4;
inline constexpr std::uint16_t kRemoteBit = 1U << 9;
/// Torque is less than commanded: clipped at 0x6072, or the drive protects its winding
inline constexpr std::uint16_t kInternalLimitBit = 1U << 11;
inline constexpr std::uint16_t kFollowsTargetBit = 1U << 12;  ///< CST mode: the drive follows the target torque
/// Manufacturer-specific bit: the torque made is not between zero and the commanded one.
inline constexpr std::uint16_t kTorqueAstrayBit = 1U << 14;

/// State shown by a statusword; nothing for a pattern that the standard does not define.
[[nodiscard]] constexpr std::optional<State> state_of(std::uint16_t statusword) noexcept {
  for (const StatusPattern& p : kStatusPatterns) {
    if ((statusword & p.mask) == p.value) return p.state;
  }
  return std::nullopt;
}

[[nodiscard]] constexpr std::uint16_t statusword_of(State state) noexcept {
  for (const StatusPattern& p : kStatusPatterns) {
    if (p.state == state) return p.value;
  }
  return 0;
}

inline constexpr std::uint16_t kControlDisableVoltage = 0x0000;
inline constexpr std::uint16_t kControlQuickStop = 0x0002;
inline constexpr std::uint16_t kControlShutdown = 0x0006;
inline constexpr std::uint16_t kControlSwitchOn = 0x0007;
inline constexpr std::uint16_t kControlEnableOperation = 0x000F;
inline constexpr std::uint16_t kControlFaultReset = 0x0080;

struct ControlPattern {
  Event event;
  std::uint16_t mask;
  std::uint16_t value;
};
inline constexpr std::array kControlPatterns{
    ControlPattern{Event::kShutdown, 0x0087, 0x0006},        ControlPattern{Event::kSwitchOn, 0x008F, 0x0007},
    ControlPattern{Event::kEnableOperation, 0x008F, 0x000F}, ControlPattern{Event::kDisableVoltage, 0x0082, 0x0000},
    ControlPattern{Event::kQuickStop, 0x0086, 0x0002},
};

/// Command given by a controlword; fault reset is a rising edge, so the previous word is needed.
[[nodiscard]] constexpr std::optional<Event> event_of(std::uint16_t before, std::uint16_t controlword) noexcept {
  if ((controlword & kControlFaultReset) != 0 && (before & kControlFaultReset) == 0) return Event::kFaultReset;
  for (const ControlPattern& p : kControlPatterns) {
    if ((controlword & p.mask) == p.value) return p.event;
  }
  return std::nullopt;
}

struct Transition {
  State from;
  Event on;
  State to;
};
/// Transitions, with their numbers in CiA 402.
inline constexpr std::array kTransitions{
    Transition{State::kNotReadyToSwitchOn, Event::kInitialised, State::kSwitchOnDisabled},  // transition 1
    Transition{State::kSwitchOnDisabled, Event::kShutdown, State::kReadyToSwitchOn},        // transition 2
    Transition{State::kReadyToSwitchOn, Event::kSwitchOn, State::kSwitchedOn},              // transition 3
    // transition 3 only: transition 4 follows with the next controlword
    Transition{State::kReadyToSwitchOn, Event::kEnableOperation, State::kSwitchedOn},
    Transition{State::kSwitchedOn, Event::kEnableOperation, State::kOperationEnabled},       // transition 4
    Transition{State::kOperationEnabled, Event::kSwitchOn, State::kSwitchedOn},              // transition 5
    Transition{State::kSwitchedOn, Event::kShutdown, State::kReadyToSwitchOn},               // transition 6
    Transition{State::kReadyToSwitchOn, Event::kDisableVoltage, State::kSwitchOnDisabled},   // transition 7
    Transition{State::kReadyToSwitchOn, Event::kQuickStop, State::kSwitchOnDisabled},        // transition 7
    Transition{State::kOperationEnabled, Event::kShutdown, State::kReadyToSwitchOn},         // transition 8
    Transition{State::kOperationEnabled, Event::kDisableVoltage, State::kSwitchOnDisabled},  // transition 9
    Transition{State::kSwitchedOn, Event::kDisableVoltage, State::kSwitchOnDisabled},        // transition 10
    Transition{State::kSwitchedOn, Event::kQuickStop, State::kSwitchOnDisabled},             // transition 10
    Transition{State::kOperationEnabled, Event::kQuickStop, State::kQuickStopActive},        // transition 11
    Transition{State::kQuickStopActive, Event::kDisableVoltage, State::kSwitchOnDisabled},   // transition 12
    Transition{State::kFaultReactionActive, Event::kFaultReactionDone, State::kFault},       // transition 14
    Transition{State::kFault, Event::kFaultReset, State::kSwitchOnDisabled},                 // transition 15
};

[[nodiscard]] constexpr State next(State s, Event e) noexcept {
  if (e == Event::kFaultDetected)
    return s == State::kFault ? s : State::kFaultReactionActive;  // transition 13, from any state
  for (const Transition& t : kTransitions) {
    if (t.from == s && t.on == e) return t.to;
  }
  return s;  // events that are not listed for a state have no effect
}

/// Torque is possible only in Operation Enabled.
[[nodiscard]] constexpr bool may_produce_torque(State s) noexcept { return s == State::kOperationEnabled; }

/// Controlword that brings a drive one step closer to Operation Enabled. It never resets a fault; the caller decides
/// that, with kControlFaultReset.
[[nodiscard]] constexpr std::uint16_t controlword_towards_operation(State s) noexcept {
  switch (s) {
    case State::kSwitchOnDisabled:
      return kControlShutdown;
    case State::kReadyToSwitchOn:
      return kControlSwitchOn;
    case State::kSwitchedOn:
    case State::kOperationEnabled:
      return kControlEnableOperation;
    default:
      return kControlDisableVoltage;
  }
}

static_assert([] {  // state_of() and statusword_of() are inverse
  for (const StatusPattern& p : kStatusPatterns) {
    if (state_of(statusword_of(p.state)) != p.state) return false;
  }
  return true;
}());
static_assert([] {  // FAULT is left only by a fault reset
  for (int e = 0; e <= static_cast<int>(Event::kFaultReactionDone); ++e) {
    if (static_cast<Event>(e) != Event::kFaultReset && next(State::kFault, static_cast<Event>(e)) != State::kFault)
      return false;
  }
  return next(State::kFault, Event::kFaultReset) == State::kSwitchOnDisabled;
}());
static_assert([] {  // from Switch On Disabled the master's controlwords reach Operation Enabled in three steps
  State s = State::kSwitchOnDisabled;
  std::uint16_t before = 0;
  for (int i = 0; i < 3; ++i) {
    const std::uint16_t word = controlword_towards_operation(s);
    s = next(s, *event_of(before, word));
    before = word;
  }
  return s == State::kOperationEnabled;
}());

}  // namespace ligature::can::cia402
