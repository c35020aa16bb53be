#include "host/tick_columns.hpp"

#include "host/names.hpp"

namespace ligature::host {
namespace {

using Tick = ligature_msg::tick_t;
using Columns = std::vector<TickColumn>;

template <class Field>
void add(Columns& to, std::string name, std::string unit, std::string meaning, Field field) {
  if constexpr (std::is_floating_point_v<decltype(field(Tick{}))>)
    to.push_back({std::move(name), std::move(unit), std::move(meaning), TickColumn::Real(field)});
  else
    to.push_back({std::move(name), std::move(unit), std::move(meaning), TickColumn::Whole(field)});
}

/// Adds the three components of a vector, named hand_quantity_x_unit.
template <class T>
void add_vector(Columns& to, std::size_t hand, const char* quantity, const char* suffix, const char* unit,
                const char* meaning, T (Tick::*field)[2][3]) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    add(to, std::string(kHandNames[hand]) + "_" + quantity + "_" + "xyz"[axis] + suffix, unit, meaning,
        [=](const Tick& t) { return (t.*field)[hand][axis]; });
  }
}

template <class T>
void add_joints(Columns& to, std::size_t hand, const char* quantity, const char* suffix, const char* unit,
                const char* meaning, T (Tick::*field)[2][3]) {
  for (std::size_t joint = 0; joint < 3; ++joint) {
    add(to, std::string(kHandNames[hand]) + "_" + quantity + "_" + "123"[joint] + suffix, unit, meaning,
        [=](const Tick& t) { return (t.*field)[hand][joint]; });
  }
}

template <class T>
void add_scalar(Columns& to, std::size_t hand, const char* quantity, const char* unit, const char* meaning,
                T (Tick::*field)[2]) {
  add(to, std::string(kHandNames[hand]) + "_" + quantity, unit, meaning, [=](const Tick& t) {
    if constexpr (std::is_floating_point_v<T>)
      return static_cast<double>((t.*field)[hand]);
    else
      return static_cast<std::int64_t>((t.*field)[hand]);
  });
}

template <class T>
void add_plain(Columns& to, const char* name, const char* unit, const char* meaning, T Tick::*field) {
  add(to, name, unit, meaning, [=](const Tick& t) {
    if constexpr (std::is_floating_point_v<T>)
      return static_cast<double>(t.*field);
    else
      return static_cast<std::int64_t>(t.*field);
  });
}

void add_hand(Columns& c, std::size_t hand) {
  add_vector(c, hand, "p_WT", "_m", "m", "tool tip in the world frame W (x right, y away, z up)", &Tick::p_WT_m);
  add_vector(c, hand, "v_WT", "_m_per_s", "m/s", "its filtered velocity", &Tick::v_WT_m_per_s);
  add_vector(c, hand, "world_f", "_N", "N", "force of the thread on the hand in world units, before force_scale",
             &Tick::f_world_N);
  add_vector(c, hand, "device_f", "_N", "N",
             "force commanded to the device at the tip, after scale and limits; + pushes the hand along the axis",
             &Tick::f_device_N);
  add_joints(c, hand, "torque", "_permille", "1/1000 of rated", "target torque of a joint on the wire",
             &Tick::torque_permille);
  add_scalar(c, hand, "node", "", "thread node held, -1 none", &Tick::grasped_node);
  add_scalar(c, hand, "grip", "", "grip button", &Tick::grip);
  add_scalar(c, hand, "dead_man", "", "dead-man button", &Tick::dead_man);
  add_scalar(c, hand, "tpdo_age_ticks", "ticks", "periods since the last complete set of TPDOs", &Tick::tpdo_age_ticks);
}

/// Columns of the device port. They follow the older columns, whose order must not change.
void add_port(Columns& c, std::size_t hand) {
  add_joints(c, hand, "q", "_rad", "rad", "joint angle: waist, shoulder, forearm (absolute)", &Tick::q_rad);
  add_vector(c, hand, "wish_f", "_N", "N", "what the coupling asks of the device, before gain, limits and passivity",
             &Tick::f_wish_N);
  add_scalar(c, hand, "gain", "", "share of it that engagement lets through", &Tick::gain);
  add_scalar(c, hand, "port_energy_J", "J", "account of the device port: put in by the hand minus given back",
             &Tick::port_energy_J);
  add_scalar(c, hand, "dissipated_J", "J", "energy taken out by the passivity controller, since start",
             &Tick::dissipated_J);
  add_scalar(c, hand, "injected_N_s_per_m", "N s/m", "damping that it injects", &Tick::injected_N_s_per_m);
  add_scalar(c, hand, "heat", "", "I2t state of the motors; 1: the continuous limit begins to act", &Tick::heat);
  add_scalar(c, hand, "limits", "", "sum of 1 peak, 2 continuous, 4 step, 8 slew, 16 velocity, 32 passivity, 64 torque",
             &Tick::limits);
  add_scalar(c, hand, "clutch", "", "1: the tool is parked while the hand moves on", &Tick::clutch);
  add_scalar(c, hand, "bus_load", "", "share of the last period that the hand's bus was busy", &Tick::bus_load);
}

/// Columns from which the thread's ticks can be recomputed: the physics' inputs.
void add_tool(Columns& c, std::size_t hand) {
  add_vector(c, hand, "tool_p_W", "_m", "m", "the tool as the thread's physics was given it", &Tick::tool_p_W_m);
  add_vector(c, hand, "tool_v_W", "_m_per_s", "m/s", "its velocity", &Tick::tool_v_W_m_per_s);
  add_scalar(c, hand, "tool_grip", "", "its grip", &Tick::tool_grip);
}

void add_steps(Columns& c) {
  add_plain(c, "thread_resets", "", "resets of the thread asked for since start", &Tick::thread_resets);
  add_plain(c, "thread_scenes", "", "scenes handed to it since start", &Tick::thread_scenes);
  add_plain(c, "thread_parameters", "", "changes of parameters handed to it since start", &Tick::thread_parameters);
  add_plain(c, "thread_steps", "", "its ticks that have ended since the last row; 1 in time", &Tick::thread_steps);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string step = "step_" + std::to_string(i + 1);
    const auto whole = [&](const char* name, const char* unit, const char* meaning, auto field) {
      add(c, step + name, unit, meaning, [=](const Tick& t) { return std::int64_t{(t.*field)[i]}; });
    };
    whole("_age_ticks", "ticks", "of the first, second or third of them: periods since its tools; -1 none",
          &Tick::step_age_ticks);
    whole("_cut_at", "", "its thread_cut_at", &Tick::step_cut_at);
  }
}

Columns make() {
  Columns c;
  add_plain(c, "tick", "ticks", "number of the control period since the firmware's start", &Tick::tick);
  add_plain(c, "scheduled_ns", "ns", "CLOCK_MONOTONIC time at which the period was due", &Tick::scheduled_ns);
  add_plain(c, "wakeup_latency_ns", "ns", "wake-up minus scheduled", &Tick::wakeup_latency_ns);
  add_plain(c, "sync_ns", "ns", "wake-up until SYNC was handed to both buses", &Tick::sync_ns);
  add_plain(c, "tpdo_ns", "ns", "wake-up until both hands' joints had come", &Tick::tpdo_ns);
  add_plain(c, "law_ns", "ns", "wake-up until the torques were computed", &Tick::law_ns);
  add_plain(c, "control_ns", "ns", "wake-up until both hands' RPDOs were written", &Tick::control_ns);
  add_plain(c, "execution_ns", "ns", "wake-up until the loop's tick was done, the tools handed to the thread",
            &Tick::execution_ns);
  add_plain(c, "flags", "",
            "sum of 1 period lost (values held), 2 deadline missed, 4/8 left/right stale, 16/32 left/right force "
            "limited, 64 contact list full, 128 the loop itself computed for longer than the bus leaves time, 256 the "
            "thread was late, 512 the clock ended its tick",
            &Tick::flags);
  add_plain(c, "state", "", "0 OFF 1 CALIBRATE 2 IDLE 3 ENGAGE 4 FORCE 5 BRAKE 6 FAULT", &Tick::state);
  add_plain(c, "fault", "", "latched fault number, 0 none", &Tick::fault);
  for (std::size_t hand = 0; hand < 2; ++hand) add_hand(c, hand);
  add_plain(c, "kinetic_J", "J", "kinetic energy of the thread", &Tick::kinetic_J);
  add_plain(c, "potential_J", "J", "potential energy: gravity, stretch, bending, twist", &Tick::potential_J);
  add_plain(c, "max_stretch", "", "largest l / l_rest - 1", &Tick::max_stretch);
  add_plain(c, "min_gap_m", "m", "smallest surface gap of the thread with itself; negative: overlap, 1e9: none near",
            &Tick::min_gap_m);
  add_plain(c, "contacts", "", "active contacts", &Tick::contacts);
  for (std::size_t hand = 0; hand < 2; ++hand) add_port(c, hand);
  add_plain(c, "degradation", "", "what the solver gave up: 0 nothing, 1 iterations, 2 contacts, 3 candidates",
            &Tick::degradation);
  add_plain(c, "grasp_age_ticks", "ticks", "periods since the one whose tools the law's grasp has seen; 1 in time",
            &Tick::grasp_age_ticks);
  add_plain(c, "thread_start_ns", "ns", "wake-up until the thread's physics began; 0 late", &Tick::thread_start_ns);
  add_plain(c, "thread_done_ns", "ns", "wake-up until it was done; 0 late", &Tick::thread_done_ns);
  add_plain(c, "thread_work_ns", "ns", "CPU time that it took", &Tick::thread_work_ns);
  add_plain(c, "thread_end", "", "0 all of the tick was computed, 1 its work was spent, 2 its time was over",
            &Tick::thread_end);
  add_plain(c, "thread_cut_at", "", "question for the time that was answered with no, -1 none", &Tick::thread_cut_at);
  add_plain(c, "time_lost", "", "share of the tick in which the thread stood still", &Tick::time_lost);
  for (std::size_t hand = 0; hand < 2; ++hand) add_tool(c, hand);
  add_steps(c);
  for (std::size_t hand = 0; hand < 2; ++hand)
    add_scalar(c, hand, "propagation", "", "the paper's condition for the hand's force: 0 none, 1 A, 2 B, 3 C",
               &Tick::propagation);
  return c;
}

}  // namespace

const std::vector<TickColumn>& tick_columns() {
  static const Columns columns = make();
  return columns;
}

}  // namespace ligature::host
