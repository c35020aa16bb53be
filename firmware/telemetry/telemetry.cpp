#include "firmware/telemetry/telemetry.hpp"

#include <utility>

#include "firmware/telemetry/messages.hpp"
#include "protocol/lcm/command_words.hpp"

namespace ligature::telemetry {

Telemetry::Telemetry(Session session, const Names& names, rt::Outlets& outlets, Sink& sink, FlightRecorder* recorder)
    : session_(std::move(session)),
      gate_(session_.id),
      names_(names),
      events_(names),
      outlets_(outlets),
      sink_(sink),
      recorder_(recorder) {
  batch_.ticks.reserve(kTicksPerBatch);
}

void Telemetry::step(Moment now) {
  for (rt::TickRecord record; outlets_.records.pop(record);) take(record, now);
  send_notes(now);
  if (now.monotonic_us >= shape_due_us_ && outlets_.shape.refresh()) {
    send_shape(now);
    shape_due_us_ = now.monotonic_us + kShapePeriod_us;
  }
  if (now.monotonic_us >= status_due_us_) {
    send_status(now);
    status_due_us_ = now.monotonic_us + kStatusPeriod_us;
  }
  if (now.monotonic_us >= offer_due_us_) send_offer(now);
}

void Telemetry::finish(Moment now) {
  for (rt::TickRecord record; outlets_.records.pop(record);) take(record, now);
  if (!batch_.ticks.empty()) send_batch(now);
  send_notes(now);
  if (outlets_.shape.refresh()) send_shape(now);
  send_status(now);
}

void Telemetry::take(const rt::TickRecord& record, Moment now) {
  misses_ += (record.flags & rt::kDeadlineMissed) != 0;
  lost_ += (record.flags & rt::kPeriodLost) != 0;
  batch_.ticks.push_back(to_message(record));
  for (auto& event : events_.next(record)) {
    event.utime = now.utime;
    sink_.send(event);
  }
  last_ = record;
  if (batch_.ticks.size() == kTicksPerBatch) send_batch(now);
}

void Telemetry::send_notes(Moment now) {
  if (recorder_ == nullptr) return;
  for (auto& note : recorder_->take_notes()) {
    ligature_msg::event_t event{};
    event.utime = now.utime;
    event.tick = note.tick;
    event.kind = ligature_msg::event_t::KIND_RECORDER;
    event.hand = -1;
    event.code = note.fault;
    event.text = std::move(note.text);
    sink_.send(event);
  }
}

void Telemetry::send_batch(Moment now) {
  batch_.utime = now.utime;
  batch_.session = session_.id;
  batch_.ring_dropped = static_cast<std::int64_t>(outlets_.records.dropped());
  batch_.count = static_cast<std::int32_t>(batch_.ticks.size());
  sink_.send(batch_);
  batch_.ticks.clear();
}

void Telemetry::send_shape(Moment now) {
  sink_.send(to_message(outlets_.shape.front(), session_.scene.radius_m, now.utime));
}

void Telemetry::send_status(Moment now) {
  ligature_msg::status_t m{};
  m.utime = now.utime;
  m.session = session_.id;
  m.protocol_version = ligature_msg::status_t::VERSION;
  m.firmware_version = session_.firmware_version;
  m.scene_file = session_.scene.scene_file;
  m.scene_toml = session_.scene.scene_toml;
  m.scene_first_tick = session_.scene.first_tick;
  m.recorder_file = session_.recorder_file;
  m.period_s = session_.period_s;
  m.max_force_N = session_.scene.max_force_N;
  m.tick = last_.tick;
  m.state = last_.state;
  m.fault = last_.fault;
  m.deadline_misses = misses_;
  m.periods_lost = lost_;
  m.realtime = session_.realtime ? 1 : 0;
  m.armed = last_.armed ? 1 : 0;
  m.admitted = session_.scene.admitted ? 1 : 0;
  sink_.send(m);
}

void Telemetry::send_offer(Moment now) {
  offer_due_us_ = now.monotonic_us + kOfferPeriod_us;
  offer_.utime = now.utime;
  offer_.session = session_.id;
  offer_.scene_count = static_cast<std::int32_t>(offer_.scenes.size());
  offer_.previews.resize(offer_.scenes.size());
  offer_.parameter_count = static_cast<std::int32_t>(offer_.parameters.size());
  sink_.send(offer_);
}

void Telemetry::set_offer(ligature_msg::offer_t offer) {
  offer_ = std::move(offer);
  offer_due_us_ = 0;
}

void Telemetry::scene_changed(const SceneFacts& facts, const std::string& text, Moment now) {
  session_.scene = facts;
  ligature_msg::event_t event{};
  event.utime = now.utime;
  event.tick = facts.first_tick;
  event.kind = ligature_msg::event_t::KIND_CHANGE;
  event.hand = -1;
  event.text = text;
  sink_.send(event);
  send_status(now);
}

std::string Telemetry::objection(std::int8_t kind) const {
  using ligature_msg::command_t;
  const bool is_plain = kind >= command_t::KIND_ARM && kind <= command_t::KIND_RESET_THREAD;
  const bool is_of_hands = kind >= command_t::KIND_CLUTCH_LEFT && kind <= command_t::KIND_CALIBRATE;
  if (!is_plain && !is_of_hands) return "unknown kind " + std::to_string(kind) + ", allowed 1 .. 7, 9 .. 14";
  if (kind == command_t::KIND_PARK || kind == command_t::KIND_CALIBRATE) {
    if (!last_.armed) return "the rig is not armed, and no hand is led without force";
    if (!last_.dead_man[0] && !last_.dead_man[1]) return "no hand holds its dead-man";
  }
  if (kind == command_t::KIND_ARM && last_.fault != 0) {
    return "fault " + std::to_string(last_.fault) + " is latched: reset it first";
  }
  if (kind == command_t::KIND_RESET_FAULT && last_.fault == 0) return "there is no fault";
  if (kind == command_t::KIND_RESET_FAULT && names_.stays(last_.fault))
    return "fault " + std::to_string(last_.fault) + " stays until ligature-firmware is started again";
  return {};
}

void Telemetry::stamp(ligature_msg::ack_t& ack, Moment now) const {
  ack.utime = now.utime;
  ack.session = session_.id;
}

std::optional<ligature_msg::ack_t> Telemetry::turn_away(const ligature_msg::command_t& command, Moment now) {
  auto judged = gate_.judge(command, now.monotonic_us);
  if (judged.may_be_done) return std::nullopt;
  ligature_msg::ack_t ack{};
  stamp(ack, now);
  ack.id = command.id;
  ack.challenge = judged.challenge;
  ack.reason = judged.challenge != 0 ? "not done yet: to be sent again with this challenge" : judged.why;
  if (judged.challenge == 0) tell_refusal(command, judged.why, now);
  return ack;
}

void Telemetry::tell_refusal(const ligature_msg::command_t& command, const std::string& why, Moment now) {
  if (now.monotonic_us < refusal_due_us_) {
    ++untold_refusals_;
    return;
  }
  refusal_due_us_ = now.monotonic_us + kRefusalPeriod_us;
  ligature_msg::event_t event{};
  event.utime = now.utime;
  event.tick = last_.tick;
  event.kind = ligature_msg::event_t::KIND_REFUSED;
  event.hand = -1;
  event.code = command.kind;
  event.text = lcm_tools::command_word(command.kind) + " refused: " + why;
  if (untold_refusals_ > 0) event.text += " (" + std::to_string(untold_refusals_) + " others before it)";
  untold_refusals_ = 0;
  sink_.send(event);
}

ligature_msg::ack_t Telemetry::handle(const ligature_msg::command_t& command, Moment now) {
  ligature_msg::ack_t ack{};
  stamp(ack, now);
  ack.id = command.id;
  ack.reason = objection(command.kind);
  if (ack.reason.empty() && !outlets_.commands.push({command.id, static_cast<rt::CommandKind>(command.kind)})) {
    ack.reason = "too many commands at once";
  }
  ack.accepted = ack.reason.empty() ? 1 : 0;
  if (ack.accepted != 0) ack.reason = "done at the next tick";
  return ack;
}

}  // namespace ligature::telemetry
