// Every field of the firmware's messages, from its source to the encoded bytes. Each source has a unique value, and the
// fields are enumerated from the .lcm definitions, so swapped and forgotten fields are found. The path from the bytes
// on: tests/integration/test_every_field.py.
#include <gtest/gtest.h>

#include <set>

#include "firmware/control/tick_report.hpp"
#include "firmware/telemetry/telemetry.hpp"
#include "tests/support/lcm_definition.hpp"

namespace ligature::telemetry {
namespace {

using ligature::test::told;
using ligature::test::Words;
using ligature::test::words;

constexpr Names kNames{[](int s) { return s == 0 ? "OFF" : "ON"; }, [](int) { return "broken"; }};

constexpr Moment kNow{.monotonic_us = 5, .utime = 9};

class Last final : public Sink {
 public:
  void send(const ligature_msg::tick_batch_t& m) override { batch = m; }
  void send(const ligature_msg::thread_t& m) override { shape = m; }
  void send(const ligature_msg::status_t& m) override { status = m; }
  void send(const ligature_msg::event_t& m) override { event = m; }
  void send(const ligature_msg::offer_t&) override {}
  ligature_msg::tick_batch_t batch{};
  ligature_msg::thread_t shape{};
  ligature_msg::status_t status{};
  ligature_msg::event_t event{};
};

/// Sources of boolean fields: each run of the test sets exactly one, so that swapped fields are found.
enum Yes { kGrip, kDeadMan = 2, kClutch = 4, kLimited = 6, kStale = 8, kCapHit = 10, kArmed, kToolGrip, kYeses = 14 };

/// Values 1.001, 1.002, ..; each is unique.
class Distinct {
 public:
  double next() { return 1.0 + 0.001 * ++count_; }
  control::Vec3 vector() {
    const double x = next(), y = next(), z = next();
    return {x, y, z};
  }

 private:
  int count_ = 0;
};

Words xyz(const control::Vec3& left, const control::Vec3& right) {
  return words(left.x(), left.y(), left.z(), right.x(), right.y(), right.z());
}

struct Sources {
  control::HandState hand[2];
  physics::HandContact contact[2];
  physics::ToolInput tool[2];
  control::ThreadOrders orders{601, 602, 603};
  physics::Diagnostics thread;
  rt::TickRecord record;  // the fields that the cycle itself fills

  explicit Sources(int yes) {
    Distinct d;
    for (int h = 0; h < 2; ++h) {
      auto& s = hand[h];
      s.q_rad = {d.next(), d.next(), d.next()};
      s.p_WT = d.vector(), s.v_WT = d.vector(), s.f_wish_N = d.vector(), s.f_device_N = d.vector();
      s.gain = d.next(), s.port_energy_J = d.next(), s.dissipated_J = d.next(), s.injected_N_s_per_m = d.next();
      s.heat = d.next(), s.received_J = d.next(), s.bus_load = static_cast<float>(d.next());
      s.limits = static_cast<std::int16_t>(101 + h);
      s.limited = yes == kLimited + h, s.grip = yes == kGrip + h, s.dead_man = yes == kDeadMan + h;
      s.clutch = yes == kClutch + h;
      s.age_ticks = yes == kStale + h ? 7 + h : 0;
      contact[h].node = 201 + h;
      contact[h].condition = h == 0 ? physics::Propagation::kB : physics::Propagation::kC;
      contact[h].p_WG = d.vector(), contact[h].v_WG = d.vector(), contact[h].f_W = d.vector();
      for (std::size_t j = 0; j < 3; ++j)
        record.torque_permille[static_cast<std::size_t>(h)][j] =
            static_cast<std::int16_t>(301 + 3 * h + static_cast<int>(j));
    }
    for (int h = 0; h < 2; ++h) tool[h] = {d.vector(), d.vector(), yes == kToolGrip + h, {}};
    record.thread_steps = 5, record.step_age_ticks = {604, 605, 606}, record.step_cut_at = {607, 608, 609};
    thread.kinetic_J = d.next(), thread.potential_J = d.next(), thread.max_stretch = d.next();
    thread.min_gap_m = d.next(), thread.time_lost = d.next(), thread.contacts = 401;
    thread.contact_cap_hit = yes == kCapHit;
    thread.degradation = physics::Degradation::kMotion;
    thread.end = physics::TickEnd::kWork, thread.cut_at = 513;
    record.grasp_age_ticks = 509, record.thread_start_ns = 510, record.thread_done_ns = 511;
    record.thread_work_ns = 512;
    record.tick = 501, record.scheduled_ns = 502, record.wakeup_latency_ns = 503, record.sync_ns = 504;
    record.tpdo_ns = 505, record.law_ns = 506, record.control_ns = 507, record.execution_ns = 508;
    record.flags = rt::kDeadlineMissed;
    record.state = 4, record.fault = 25, record.armed = yes == kArmed;
  }

  /// Assembles a record as PeriodLog does; state, fault and armed are the controller's own.
  rt::TickRecord told_record() {
    for (std::size_t h = 0; h < 2; ++h) {
      control::report(hand[h], h, record);
      control::report(contact[h], h, record);
      control::report(tool[h], h, record);
    }
    control::report(orders, record);
    control::report(thread, record);
    return record;
  }

  std::map<std::string, Words> expected(int yes) const {
    const auto& [l, r] = hand;
    const auto both = [](auto left, auto right) { return words(left, right); };
    int flags = rt::kDeadlineMissed;
    if (yes == kStale) flags |= 4;
    if (yes == kStale + 1) flags |= 8;
    if (yes == kLimited) flags |= 16;
    if (yes == kLimited + 1) flags |= 32;
    if (yes == kCapHit) flags |= 64;
    return {{"tick", words(501)},
            {"scheduled_ns", words(502)},
            {"wakeup_latency_ns", words(503)},
            {"sync_ns", words(504)},
            {"tpdo_ns", words(505)},
            {"law_ns", words(506)},
            {"control_ns", words(507)},
            {"execution_ns", words(508)},
            {"flags", words(flags)},
            {"state", words(4)},
            {"fault", words(25)},
            {"p_WT_m", xyz(l.p_WT, r.p_WT)},
            {"v_WT_m_per_s", xyz(l.v_WT, r.v_WT)},
            {"f_world_N", xyz(contact[0].f_W, contact[1].f_W)},
            {"f_device_N", xyz(l.f_device_N, r.f_device_N)},
            {"torque_permille", words(301, 302, 303, 304, 305, 306)},
            {"grasped_node", words(201, 202)},
            {"propagation", words(2, 3)},
            {"grip", words(int{yes == kGrip}, int{yes == kGrip + 1})},
            {"dead_man", words(int{yes == kDeadMan}, int{yes == kDeadMan + 1})},
            {"tpdo_age_ticks", words(yes == kStale ? 7 : 0, yes == kStale + 1 ? 8 : 0)},
            {"q_rad", words(l.q_rad[0], l.q_rad[1], l.q_rad[2], r.q_rad[0], r.q_rad[1], r.q_rad[2])},
            {"f_wish_N", xyz(l.f_wish_N, r.f_wish_N)},
            {"gain", both(l.gain, r.gain)},
            {"port_energy_J", both(l.port_energy_J, r.port_energy_J)},
            {"dissipated_J", both(l.dissipated_J, r.dissipated_J)},
            {"injected_N_s_per_m", both(l.injected_N_s_per_m, r.injected_N_s_per_m)},
            {"heat", both(l.heat, r.heat)},
            {"limits", words(101, 102)},
            {"clutch", words(int{yes == kClutch}, int{yes == kClutch + 1})},
            {"bus_load", both(l.bus_load, r.bus_load)},
            {"kinetic_J", words(thread.kinetic_J)},
            {"potential_J", words(thread.potential_J)},
            {"max_stretch", words(thread.max_stretch)},
            {"min_gap_m", words(thread.min_gap_m)},
            {"contacts", words(401)},
            {"degradation", words(3)},
            {"grasp_age_ticks", words(509)},
            {"thread_start_ns", words(510)},
            {"thread_done_ns", words(511)},
            {"thread_work_ns", words(512)},
            {"thread_end", words(1)},
            {"thread_cut_at", words(513)},
            {"time_lost", words(static_cast<float>(thread.time_lost))},
            {"tool_p_W_m", xyz(tool[0].p_WT, tool[1].p_WT)},
            {"tool_v_W_m_per_s", xyz(tool[0].v_WT, tool[1].v_WT)},
            {"tool_grip", words(int{yes == kToolGrip}, int{yes == kToolGrip + 1})},
            {"thread_resets", words(601)},
            {"thread_scenes", words(602)},
            {"thread_parameters", words(603)},
            {"thread_steps", words(5)},
            {"step_age_ticks", words(604, 605, 606)},
            {"step_cut_at", words(607, 608, 609)}};
  }
};

class EveryField : public ::testing::Test {
 protected:
  std::unique_ptr<rt::Outlets> outlets = std::make_unique<rt::Outlets>();
  Last sink;
  Session session{42, "1.2.3", {"a.toml", "text", 3.25, 0.0625, false, 702}, 0.002, false, "flight.rec"};
};

/// Compares all fields by name. Each of them must be in `expected`, and no other may be there.
void compare(const std::map<std::string, Words>& found, const std::map<std::string, Words>& expected) {
  for (const auto& [name, values] : found) {
    ASSERT_TRUE(expected.contains(name)) << name << ": a new field? Give it a source of its own value here";
    EXPECT_EQ(values, expected.at(name)) << name;
  }
  EXPECT_EQ(found.size(), expected.size()) << "a field that no definition has any more";
}

TEST_F(EveryField, OfATickIsThatOfItsSource) {
  for (int yes = 0; yes < kYeses; ++yes) {
    Telemetry telemetry{session, kNames, *outlets, sink};
    Sources sources(yes);
    outlets->records.push(sources.told_record());
    telemetry.finish(kNow);
    ASSERT_EQ(sink.batch.ticks.size(), 1U);
    compare(told(sink.batch.ticks[0], "tick_t"), sources.expected(yes));
    EXPECT_EQ(sink.status.armed, yes == kArmed ? 1 : 0);
  }
  // Precondition: no two fields expect the same values.
  std::set<Words> seen;
  for (const auto& [name, values] : Sources(kYeses).expected(kYeses)) {
    if (name != "grip" && name != "dead_man" && name != "clutch" && name != "tpdo_age_ticks" && name != "tool_grip") {
      EXPECT_TRUE(seen.insert(values).second) << name;
    }
  }
}

TEST_F(EveryField, OfABatchIsThatOfItsSource) {
  Telemetry telemetry{session, kNames, *outlets, sink};
  outlets->records.push({});
  outlets->records.count_dropped(13);
  telemetry.finish(kNow);
  EXPECT_EQ(sink.batch.utime, 9);
  EXPECT_EQ(sink.batch.session, 42);
  EXPECT_EQ(sink.batch.ring_dropped, 13);
  EXPECT_EQ(sink.batch.count, 1);
}

TEST_F(EveryField, OfAShapeIsThatOfItsSource) {
  Telemetry telemetry{session, kNames, *outlets, sink};
  const std::vector<physics::Vec3> nodes{{1.5, 2.5, 3.5}, {4.5, 5.5, 6.5}};
  control::ThreadResult thread;
  thread.tick = 601;
  thread.hand[0].node = 602, thread.hand[1].node = 603;
  auto& shape = outlets->shape.back();
  control::report(nodes, thread, shape);
  shape.tension_N[0] = 7.5F, shape.tension_N[1] = 8.5F, shape.turn_rad[0] = 9.5F, shape.turn_rad[1] = 10.5F;
  outlets->shape.publish();
  telemetry.finish(kNow);
  compare(told(sink.shape, "thread_t"), {{"utime", words(9)},
                                         {"tick", words(601)},
                                         {"radius_m", words(0.0625F)},
                                         {"count", words(2)},
                                         {"p_W_m", words(1.5, 2.5, 3.5, 4.5, 5.5, 6.5)},
                                         {"tension_N", words(7.5, 8.5)},
                                         {"turn_rad", words(9.5, 10.5)},
                                         {"grasped_node", words(602, 603)}});
}

TEST_F(EveryField, OfAStatusIsThatOfItsSource) {
  for (int yes = 0; yes < 3; ++yes) {
    session.realtime = yes == 0, session.scene.admitted = yes == 1;
    Telemetry telemetry{session, kNames, *outlets, sink};
    rt::TickRecord record;
    record.tick = 701, record.state = 5, record.fault = 21, record.armed = yes == 2;
    for (int i = 0; i < 5; ++i) {  // two lost periods, three deadline misses
      record.flags = i < 2 ? rt::kPeriodLost : rt::kDeadlineMissed;
      outlets->records.push(record);
    }
    telemetry.finish(kNow);
    compare(told(sink.status, "status_t"), {{"utime", words(9)},
                                            {"session", words(42)},
                                            {"protocol_version", words(int{ligature_msg::status_t::VERSION})},
                                            {"firmware_version", words(std::string("1.2.3"))},
                                            {"scene_file", words(std::string("a.toml"))},
                                            {"scene_toml", words(std::string("text"))},
                                            {"scene_first_tick", words(702)},
                                            {"recorder_file", words(std::string("flight.rec"))},
                                            {"period_s", words(0.002)},
                                            {"max_force_N", words(3.25)},
                                            {"tick", words(701)},
                                            {"state", words(5)},
                                            {"fault", words(21)},
                                            {"deadline_misses", words(3)},
                                            {"periods_lost", words(2)},
                                            {"realtime", words(int{yes == 0})},
                                            {"armed", words(int{yes == 2})},
                                            {"admitted", words(int{yes == 1})}});
  }
}

TEST_F(EveryField, OfAnEventIsThatOfItsSource) {
  for (int hand = 0; hand < 2; ++hand) {
    Telemetry telemetry{session, kNames, *outlets, sink};
    rt::TickRecord record;
    record.tick = 801;
    outlets->records.push(record);
    record.tick = 802;
    record.grip[static_cast<std::size_t>(hand)] = true;
    record.grasped_node[static_cast<std::size_t>(hand)] = 33;
    outlets->records.push(record);
    telemetry.step(kNow);
    auto found = told(sink.event, "event_t");
    EXPECT_NE(found["text"].at(0).find("33"), std::string::npos) << found["text"].at(0);
    found.erase("text");
    compare(found, {{"utime", words(9)},
                    {"tick", words(802)},
                    {"kind", words(int{ligature_msg::event_t::KIND_GRASP})},
                    {"hand", words(hand)},
                    {"code", words(33)}});
    telemetry.finish(kNow);
  }
}

}  // namespace
}  // namespace ligature::telemetry
