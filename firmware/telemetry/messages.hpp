#pragma once
// Records of the real-time thread as LCM messages. Allocates, so never on that thread.

#include <cstddef>
#include <optional>
#include <span>

#include "firmware/rt/tick_record.hpp"
#include "ligature_msg/command_t.hpp"
#include "ligature_msg/thread_t.hpp"
#include "ligature_msg/tick_t.hpp"

namespace ligature::telemetry {

[[nodiscard]] ligature_msg::tick_t to_message(const rt::TickRecord& record);
[[nodiscard]] ligature_msg::thread_t to_message(const rt::ThreadSnapshot& snapshot, double radius_m,
                                                std::int64_t utime);

/// A command as anybody on the network may have sent it. Nothing for another type, a length that is not that of its
/// parts, or a text without its final zero: the generated decoder throws at some of these and reads past others.
[[nodiscard]] std::optional<ligature_msg::command_t> command_of(std::span<const std::byte> message);

}  // namespace ligature::telemetry
