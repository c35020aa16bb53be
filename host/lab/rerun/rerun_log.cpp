#include "host/lab/rerun/rerun_log.hpp"

#include <algorithm>
#include <utility>

#include "host/lab/rig/recording.hpp"
#include "host/messages.hpp"
#include "protocol/scene/recorded_scene.hpp"

namespace ligature::lab {
template <class Message>
void RerunLog::write(std::string_view channel, const Message& message) {
  host::encode(message, bytes_);
  log_.write(at_us_, channel, bytes_);
}

void RerunLog::add(ligature_msg::thread_t shape, std::int64_t utime) {
  shape.utime = utime;
  write(host::kThreadChannel, shape);
}

void RerunLog::add(ligature_msg::status_t status) {
  for (const auto& o : overrides_) scene::add_override(status.scene_toml, o);
  write(host::kStatusChannel, status);
}

void RerunLog::end_batch(const ligature_msg::tick_batch_t& like) {
  const std::vector<ligature_msg::tick_t> all = std::exchange(ticks_, {});
  for (std::size_t from = 0; from < all.size(); from += Recording::kTicksPerBatch) {
    ligature_msg::tick_batch_t batch{};
    batch.utime = like.utime, batch.session = like.session, batch.ring_dropped = like.ring_dropped;
    const auto to = std::min(all.size(), from + Recording::kTicksPerBatch);
    batch.ticks.assign(all.begin() + static_cast<std::ptrdiff_t>(from), all.begin() + static_cast<std::ptrdiff_t>(to));
    batch.count = static_cast<std::int32_t>(batch.ticks.size());
    write(host::kTicksChannel, batch);
  }
}

}  // namespace ligature::lab
