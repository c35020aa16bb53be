#pragma once
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace ligature::host {

/// How long the firmware may take: a scene and a parameter are built and measured first.
[[nodiscard]] std::chrono::seconds answer_time(std::int8_t kind);

/// Asks the firmware for a challenge, publishes the command with it and waits up to answer_time() for the answer, which
/// is printed. The question, and `stop` and `disarm`, which need none, are repeated every 100 ms until they are
/// answered, because they may be needed when the network is bad; the others are sent once, because doing them twice is
/// not the same.
/// @param text, value of `load-scene` and `set`, else empty and 0.
/// @throws RunFailed when the firmware refuses or does not answer.
void send(std::string_view word, const std::string& text, double value, const std::string& lcm_url);

}  // namespace ligature::host
