#pragma once
// Data that the real-time thread reports: one record per period, and the thread's shape every few periods.

#include <array>
#include <cstdint>

#include "firmware/rt/culprit.hpp"
#include "firmware/rt/payload.hpp"
#include "firmware/rt/rig_io.hpp"

namespace ligature::rt {

/// Bits of TickRecord::flags; values as in protocol/lcm/tick_t.lcm.
enum TickFlag : std::int32_t {
  kPeriodLost = 1,
  kDeadlineMissed = 2,
  kLeftStale = 4,
  kRightStale = 8,
  kLeftLimited = 16,
  kRightLimited = 32,
  kContactCap = 64,
  kOverworked = 128,
  kThreadLate = 256,  ///< the physics had not finished this tick when the next samples came; its values are older
  kThreadCut = 512,   ///< the deadline ended the physics tick
};

/// Bits of TickRecord::limits, per hand: which limits reduce the force now. Reaching a limit is no fault.
enum LimitCode : std::int16_t {
  kPeakLimit = 1,        ///< magnitude at max_force_N or the device's peak
  kContinuousLimit = 2,  ///< the motors' thermal limit (I2t) is reached
  kStepLimit = 4,        ///< largest change within one period
  kSlewLimit = 8,        ///< largest rate of change over many periods
  kVelocityBrake = 16,   ///< tip too fast: the rig goes to BRAKE
  kPassivityLimit = 32,  ///< the port's energy account is short: the force is damped or reduced
  kTorqueLimit = 64,     ///< a drive's maximum torque, or the peak force that the torques could make in any pose
};

/// How the thread's solver degraded in this tick, in order of severity; values of TickRecord::degradation.
enum class Degradation : std::int8_t {
  kNone = 0,
  kIterations = 1,  ///< iterations ended before convergence: contacts are a little softer
  kContacts = 2,    ///< not enough room or budget for all contacts: the shallowest were only kept from crossing
  kCandidates = 3,  ///< not all near pairs could be checked or solved: the thread was not moved for part of the tick
};

/// Which of the paper's conditions (section IV) acts on a hand; values of TickRecord::propagation.
enum class Propagation : std::int8_t {
  kNone = 0,  ///< the hand holds nothing, or the scene has no propagation of forces
  kA = 1,     ///< only springs pass the force on
  kB = 2,     ///< a segment beside the hand is at a length limit and passes it on
  kC = 3,     ///< as B, and the other hand holds the thread too
};

using Triple = std::array<double, 3>;

/// Largest number of physics ticks that can end between two reads by the loop: the tick that was running, and those of
/// a waiting request and of the newest request.
inline constexpr std::size_t kThreadSteps = 3;

/// One control period; fields, units and frames as in protocol/lcm/tick_t.lcm. In addition `armed` and `culprit`, which
/// go into other messages (status_t, event_t).
struct TickRecord {
  std::int64_t tick = 0;
  std::int64_t scheduled_ns = 0;
  std::int32_t wakeup_latency_ns = 0;
  std::int32_t sync_ns = 0;
  std::int32_t tpdo_ns = 0;
  std::int32_t law_ns = 0;
  std::int32_t control_ns = 0;
  std::int32_t execution_ns = 0;
  std::int32_t flags = 0;
  std::int8_t state = 0;
  std::int16_t fault = 0;
  bool armed = false;
  Culprit culprit;  ///< of the fault; in OFF and CALIBRATE: what is waited for

  std::array<Triple, kHands> p_WT_m{};
  std::array<Triple, kHands> v_WT_m_per_s{};
  std::array<Triple, kHands> f_world_N{};
  std::array<Triple, kHands> f_device_N{};
  WireTorque torque_permille{};
  std::array<std::int16_t, kHands> grasped_node{-1, -1};
  std::array<std::int8_t, kHands> propagation{};  ///< rt::Propagation
  std::array<bool, kHands> grip{};
  std::array<bool, kHands> dead_man{};
  std::array<std::int16_t, kHands> tpdo_age_ticks{};

  // Each hand's device port: the tip, with its force and energy account.
  std::array<Triple, kHands> q_rad{};
  std::array<Triple, kHands> f_wish_N{};
  std::array<double, kHands> gain{};
  std::array<double, kHands> port_energy_J{};
  std::array<double, kHands> dissipated_J{};
  std::array<double, kHands> injected_N_s_per_m{};
  std::array<double, kHands> heat{};
  std::array<std::int16_t, kHands> limits{};
  std::array<bool, kHands> clutch{};
  std::array<float, kHands> bus_load{};

  double kinetic_J = 0.0;
  double potential_J = 0.0;
  double max_stretch = 0.0;
  double min_gap_m = 0.0;
  std::int16_t contacts = 0;
  std::int8_t degradation = 0;

  // Results of the thread's physics in this period; 0 if the physics was late. Times count from the loop's wake-up;
  // fields named `work` are CPU time.
  std::int16_t grasp_age_ticks = 0;  ///< periods since the one whose tools the grasp in use was computed from
  std::int32_t thread_start_ns = 0;
  std::int32_t thread_done_ns = 0;
  std::int32_t thread_work_ns = 0;
  std::int8_t thread_end = 0;  ///< physics::TickEnd
  /// Number of the clock query ("is there time left?") that ended the physics tick early; -1: none did
  std::int32_t thread_cut_at = -1;
  float time_lost = 0.0F;  ///< share of the tick in which the thread was not moved

  // Inputs from which the physics can be replayed bit by bit, given the same scenes: this period's tools, the numbers
  // of resets, scenes and parameters requested so far, and the periods whose tools were processed since the last
  // record.
  std::array<Triple, kHands> tool_p_W_m{};
  std::array<Triple, kHands> tool_v_W_m_per_s{};
  std::array<bool, kHands> tool_grip{};
  std::int32_t thread_resets = 0;
  std::int32_t thread_scenes = 0;
  std::int32_t thread_parameters = 0;
  std::int8_t thread_steps = 0;                                       ///< 1: in time; 0: late or lost period
  std::array<std::int32_t, kThreadSteps> step_age_ticks{-1, -1, -1};  ///< oldest first; 0: this period's tools
  std::array<std::int32_t, kThreadSteps> step_cut_at{-1, -1, -1};     ///< as thread_cut_at
};

inline constexpr std::size_t kMaxNodes = 5000;

/// The thread's centreline in W at one tick.
struct ThreadSnapshot {
  std::int64_t tick = 0;
  std::int32_t count = 0;  ///< nodes in use, ≤ kMaxNodes
  std::array<std::int16_t, kHands> grasped_node{-1, -1};
  std::array<std::array<float, 3>, kMaxNodes> p_W_m{};
  std::array<float, kMaxNodes> tension_N{};  ///< tension of the segment after each node
  /// Angle of the material frame against the twist-free frame that starts at node 0
  std::array<float, kMaxNodes> turn_rad{};
};

static_assert(Payload<TickRecord> && Payload<ThreadSnapshot>);

}  // namespace ligature::rt
