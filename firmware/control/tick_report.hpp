#pragma once
// A period as others shall read it.

#include "firmware/control/controller.hpp"
#include "firmware/control/thread_link.hpp"
#include "firmware/physics/simulation.hpp"
#include "firmware/rt/tick_record.hpp"

namespace ligature::control {

/// The node that a hand of the thread holds, as the controller wants it.
[[nodiscard]] inline Grasp grasp_of(const physics::HandContact& contact) noexcept {
  return {contact.node >= 0, contact.p_WG, contact.v_WG};
}

/// Copies controller and thread into the record; timing, tick number and torques are the cycle's own.
void report(const Controller& controller, rt::TickRecord& record) noexcept;
void report(const HandState& hand, std::size_t number, rt::TickRecord& record) noexcept;
void report(const ThreadOrders& orders, rt::TickRecord& record) noexcept;
void report(const physics::ToolInput& tool, std::size_t hand, rt::TickRecord& record) noexcept;
void report(const physics::Diagnostics& thread, rt::TickRecord& record) noexcept;
void report(const physics::HandContact& contact, std::size_t hand, rt::TickRecord& record) noexcept;

/// The shape, as many nodes as fit.
void report(std::span<const physics::Vec3> nodes_W, const ThreadResult& thread, rt::ThreadSnapshot& snapshot) noexcept;
/// The whole shape, tension and turn included.
void report(const physics::Simulation& thread, const ThreadResult& result, rt::ThreadSnapshot& snapshot) noexcept;

}  // namespace ligature::control
