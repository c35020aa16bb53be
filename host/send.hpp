#pragma once
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace ligature::host {

/// How long to wait for the firmware's answer; longer for a scene or a parameter, which it first builds and measures.
[[nodiscard]] std::chrono::seconds answer_time(std::int8_t kind);

/// Requests a challenge from the firmware, publishes the command with it, waits up to answer_time() and prints the
/// answer. The request, and `stop` and `disarm`, which need no challenge, are repeated every 100 ms until answered,
/// because they must work on a bad network, too. Other commands are sent once, because executing them twice can have
/// another effect than executing them once.
/// @param text, value of `load-scene` and `set`, else empty and 0.
/// @throws RunFailed when the firmware refuses or does not answer.
void send(std::string_view word, const std::string& text, double value, const std::string& lcm_url);

}  // namespace ligature::host
