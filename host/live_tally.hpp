#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "host/messages.hpp"
#include "host/session_tally.hpp"

namespace ligature::host {

/// What the recorder knows about the stream it writes: enough for its progress line and its last words.
class LiveTally {
 public:
  void add(std::string_view channel, Bytes message);
  /// A message that is not kept, because no reader would take it.
  void refuse() { ++messages_, ++refused_; }

  [[nodiscard]] const SessionTally& sessions() const { return sessions_; }
  /// The run of the firmware whose ticks came last.
  [[nodiscard]] std::optional<std::int64_t> newest_session() const { return newest_session_; }
  [[nodiscard]] std::int64_t messages() const { return messages_; }
  [[nodiscard]] std::int64_t unreadable() const { return unreadable_; }
  [[nodiscard]] std::int64_t shapes() const { return shapes_; }

  /// "12.3 s  12300 ticks  1000/s  0 lost  FORCE  left 1.20 N  right 0.31 N"; `ticks_per_s` is the caller's measure.
  [[nodiscard]] std::string progress_line(double elapsed_s, double ticks_per_s) const;

  /// Lines about what was recorded and what was lost, with the missing numbers (the first `max_ranges` holes).
  /// @param open_ends sessions of which nobody knows whether more ticks followed the last one that came: of a log with
  /// one of them, or with ticks that could not be counted, nobody can say that nothing is lost.
  [[nodiscard]] std::string summary(std::span<const std::int64_t> open_ends = {}, std::size_t max_ranges = 10) const;

 private:
  void add(const ligature_msg::tick_batch_t& batch);

  SessionTally sessions_;
  std::int64_t messages_ = 0, unreadable_ = 0, shapes_ = 0, refused_ = 0;
  std::optional<std::int64_t> newest_session_;
  std::int8_t state_ = 0;
  std::int16_t fault_ = 0;
  std::array<double, 2> force_N_{};
};

}  // namespace ligature::host
