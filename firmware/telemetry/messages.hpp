#pragma once
// Converts real-time records to LCM messages. Allocates, so not for use in the real-time thread.

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

/// Decodes a command from the network, which may be malicious. Returns nothing for another type, inconsistent lengths,
/// or a text without its final zero; on some of these the generated decoder throws, on others it reads out of bounds.
[[nodiscard]] std::optional<ligature_msg::command_t> command_of(std::span<const std::byte> message);

}  // namespace ligature::telemetry
