#pragma once
// Writes a run of the virtual rig as the LCM log that `ligature-host record` would write: same channels, messages and
// writer. Times are those of the simulated clock.

#include <string>
#include <vector>

#include "firmware/rt/tick_record.hpp"
#include "firmware/telemetry/event_finder.hpp"
#include "host/lab/rig/rig_log.hpp"
#include "host/log_writer.hpp"
#include "ligature_msg/tick_batch_t.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::lab {

class Recording final : public RigLog {
 public:
  static constexpr std::size_t kTicksPerBatch = 20;
  static constexpr std::int64_t kShapePeriod_ticks = 16, kStatusPeriod_ticks = 100;  ///< 62 Hz and 10 Hz

  /// @throws host::BadInput when the file exists or cannot be created.
  /// @param scene_toml as made by scene::recorded_text().
  Recording(const std::string& path, const scene::Scene& scene, std::string scene_file, std::string scene_toml);

  void take(const rt::TickRecord& record) override;
  void take(const rt::ThreadSnapshot& shape) override;
  void scene_changed(const scene::Scene& scene, std::string scene_toml, std::int64_t first_tick) override;
  /// Writes the incomplete batch, the last shape and a last status.
  void close() override;

 private:
  template <class Message>
  void write(std::string_view channel, const Message& message);
  void write_batch();
  void write_shape();
  void write_status();
  [[nodiscard]] std::int64_t now_us() const noexcept { return last_.scheduled_ns / 1000; }

  host::LogWriter log_;
  scene::Scene scene_;
  std::string scene_file_, scene_toml_;
  std::int64_t scene_first_tick_ = 0;
  telemetry::EventFinder events_;
  ligature_msg::tick_batch_t batch_{};
  rt::TickRecord last_{};
  std::unique_ptr<rt::ThreadSnapshot> shape_ = std::make_unique<rt::ThreadSnapshot>();
  std::int64_t shape_due_tick_ = 0;
  std::int64_t misses_ = 0, lost_ = 0;
  std::vector<std::byte> bytes_;
};

}  // namespace ligature::lab
