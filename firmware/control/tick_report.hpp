#pragma once
// Fills tick records and thread snapshots for telemetry and recorder.

#include "firmware/control/controller.hpp"
#include "firmware/control/thread_link.hpp"
#include "firmware/physics/simulation.hpp"
#include "firmware/rt/tick_record.hpp"

namespace ligature::control {

/// The held piece of thread, as the controller uses it.
[[nodiscard]] inline Grasp grasp_of(const physics::HandContact& contact) noexcept {
  return {contact.node >= 0, contact.p_WG, contact.v_WG};
}

/// Copies the state of controller, hands and suture into the record; PeriodLog fills in times, tick and torques.
void report(const Controller& controller, rt::TickRecord& record) noexcept;
void report(const HandState& hand, std::size_t number, rt::TickRecord& record) noexcept;
void report(const ThreadOrders& orders, rt::TickRecord& record) noexcept;
void report(const physics::ToolInput& tool, std::size_t hand, rt::TickRecord& record) noexcept;
void report(const physics::Diagnostics& thread, rt::TickRecord& record) noexcept;
void report(const physics::HandContact& contact, std::size_t hand, rt::TickRecord& record) noexcept;

/// Fills in a snapshot of the suture, with as many node positions as have room.
void report(std::span<const physics::Vec3> nodes_W, const ThreadResult& thread, rt::ThreadSnapshot& snapshot) noexcept;
/// As above, and also with tension and twist angle at every node.
void report(const physics::Simulation& thread, const ThreadResult& result, rt::ThreadSnapshot& snapshot) noexcept;

}  // namespace ligature::control
