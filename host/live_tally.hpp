#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "host/messages.hpp"
#include "host/session_tally.hpp"

namespace ligature::host {

/// Statistics of the stream while it is recorded: for the progress line and the final summary.
class LiveTally {
 public:
  void add(std::string_view channel, Bytes message);
  /// Counts a message that is not recorded, because no reader would accept it.
  void refuse() { ++messages_, ++refused_; }

  [[nodiscard]] const SessionTally& sessions() const { return sessions_; }
  /// The session (run of the firmware) of the last received ticks.
  [[nodiscard]] std::optional<std::int64_t> newest_session() const { return newest_session_; }
  [[nodiscard]] std::int64_t messages() const { return messages_; }
  [[nodiscard]] std::int64_t unreadable() const { return unreadable_; }
  [[nodiscard]] std::int64_t shapes() const { return shapes_; }

  /// A text such as "12.3 s  12300 ticks  1000/s  0 lost  FORCE  left 1.20 N  right 0.31 N"; the caller measures
  /// `ticks_per_s`.
  [[nodiscard]] std::string progress_line(double elapsed_s, double ticks_per_s) const;

  /// Lines that say what was recorded and what was lost, with the numbers of the missing ticks (first `max_ranges`
  /// ranges).
  /// @param open_ends sessions for which it is unknown whether more ticks followed the last received one. If there is
  /// such a session, or if ticks belong to no counted session, the summary does not claim that nothing was lost.
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
