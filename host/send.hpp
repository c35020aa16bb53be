#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ligature::host {

/// KIND_ of command_t for a word of the command line; nothing for any other word.
[[nodiscard]] std::optional<std::int8_t> command_kind(std::string_view word);

/// How long the firmware may take: a scene and a parameter are built and measured first.
[[nodiscard]] std::chrono::seconds answer_time(std::int8_t kind);

/// Publishes a command and waits up to answer_time() for the firmware's answer, which is printed.
/// `stop` is repeated every 100 ms until it is answered, because it may be needed when the network is bad; the
/// others are sent once, because doing them twice is not the same.
/// @param text, value of `load-scene` and `set`, else empty and 0.
/// @throws RunFailed when the firmware refuses or does not answer.
void send(std::string_view word, const std::string& text, double value, const std::string& lcm_url);

}  // namespace ligature::host
