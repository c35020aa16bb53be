#include "host/lab/rig/recording.hpp"

#include <utility>

#include "firmware/control/faults.hpp"
#include "firmware/control/state_machine.hpp"
#include "firmware/rt/period.hpp"
#include "firmware/telemetry/messages.hpp"
#include "host/lab/rig/virtual_rig.hpp"
#include "host/messages.hpp"

namespace ligature::lab {
namespace {

constexpr std::int64_t kSession = 1;  // constant, because a run on a simulated clock has no date

constexpr telemetry::Names kNames{
    [](int s) { return control::name(static_cast<control::State>(s)); },
    [](int f) { return control::name(static_cast<control::Fault>(f)); },
};

}  // namespace

Recording::Recording(const std::string& path, const scene::Scene& scene, std::string scene_file, std::string scene_toml)
    : log_(path, false),
      scene_(scene),
      scene_file_(std::move(scene_file)),
      scene_toml_(std::move(scene_toml)),
      events_(kNames) {}

template <class Message>
void Recording::write(std::string_view channel, const Message& message) {
  host::encode(message, bytes_);
  log_.write(now_us(), channel, bytes_);
}

void Recording::take(const rt::TickRecord& record) {
  last_ = record;
  misses_ += (record.flags & rt::kDeadlineMissed) != 0;
  lost_ += (record.flags & rt::kPeriodLost) != 0;
  batch_.ticks.push_back(telemetry::to_message(record));
  for (auto& event : events_.next(record)) {
    event.utime = now_us();
    write(host::kEventChannel, event);
  }
  if (batch_.ticks.size() == kTicksPerBatch) write_batch();
  if (record.tick % kStatusPeriod_ticks == 0) write_status();
}

void Recording::take(const rt::ThreadSnapshot& shape) {
  *shape_ = shape;
  if (shape.tick < shape_due_tick_) return;
  shape_due_tick_ = shape.tick + kShapePeriod_ticks;
  write_shape();
}

void Recording::scene_changed(const scene::Scene& scene, std::string scene_toml, std::int64_t first_tick) {
  scene_ = scene;
  scene_toml_ = std::move(scene_toml);
  scene_first_tick_ = first_tick;
  write_status();
}

void Recording::close() {
  if (!batch_.ticks.empty()) write_batch();
  if (shape_->count > 0) write_shape();
  write_status();
  log_.close();
}

void Recording::write_batch() {
  batch_.utime = now_us();
  batch_.session = kSession;
  batch_.count = static_cast<std::int32_t>(batch_.ticks.size());
  write(host::kTicksChannel, batch_);
  batch_.ticks.clear();
}

void Recording::write_shape() {
  write(host::kThreadChannel, telemetry::to_message(*shape_, scene_.suture.radius_m, now_us()));
}

void Recording::write_status() {
  ligature_msg::status_t m{};
  m.utime = now_us();
  m.session = kSession;
  m.protocol_version = ligature_msg::status_t::VERSION;
  m.firmware_version = LIGATURE_VERSION;
  m.scene_file = scene_file_;
  m.scene_toml = scene_toml_;
  m.scene_first_tick = scene_first_tick_;
  m.period_s = rt::kPeriod_s;
  m.max_force_N = scene_.hands.max_force_N;
  m.tick = last_.tick;
  m.state = last_.state;
  m.fault = last_.fault;
  m.deadline_misses = misses_;
  m.periods_lost = lost_;
  m.armed = last_.armed ? 1 : 0;
  m.admitted = 1;
  write(host::kStatusChannel, m);
}

void VirtualRig::record(const std::string& path) {
  recording_ = std::make_unique<Recording>(path, setup.scene, setup.scene_file, setup.scene_toml);
}

}  // namespace ligature::lab
