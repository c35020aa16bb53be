#pragma once
// Records of the real-time thread as LCM messages. Allocates, so never on that thread.

#include "firmware/rt/tick_record.hpp"
#include "ligature_msg/thread_t.hpp"
#include "ligature_msg/tick_t.hpp"

namespace ligature::telemetry {

[[nodiscard]] ligature_msg::tick_t to_message(const rt::TickRecord& record);
[[nodiscard]] ligature_msg::thread_t to_message(const rt::ThreadSnapshot& snapshot, double radius_m,
                                                std::int64_t utime);

}  // namespace ligature::telemetry
