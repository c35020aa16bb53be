#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "ligature_msg/ack_t.hpp"
#include "ligature_msg/command_t.hpp"
#include "ligature_msg/event_t.hpp"
#include "ligature_msg/offer_t.hpp"
#include "ligature_msg/status_t.hpp"
#include "ligature_msg/thread_t.hpp"
#include "ligature_msg/tick_batch_t.hpp"

namespace ligature::host {

inline constexpr std::string_view kTicksChannel = "LIGATURE_TICKS";
inline constexpr std::string_view kThreadChannel = "LIGATURE_THREAD";
inline constexpr std::string_view kStatusChannel = "LIGATURE_STATUS";
inline constexpr std::string_view kEventChannel = "LIGATURE_EVENT";
inline constexpr std::string_view kCommandChannel = "LIGATURE_COMMAND";
inline constexpr std::string_view kAckChannel = "LIGATURE_ACK";
inline constexpr std::string_view kOfferChannel = "LIGATURE_OFFER";

using Bytes = std::span<const std::byte>;

/// Decodes a message from the network, which anybody may have sent.
/// The generated decoders trust the lengths inside a message. These functions first check that every array and string
/// fits into the received bytes, so that a forged length can neither allocate gigabytes nor read past the end. All
/// bytes must be used, and values used in computations must be plausible.
/// @return nothing when the message is not exactly one valid M.
template <class M>
[[nodiscard]] std::optional<M> decode(Bytes message);

template <>
std::optional<ligature_msg::tick_batch_t> decode(Bytes message);
template <>
std::optional<ligature_msg::thread_t> decode(Bytes message);
template <>
std::optional<ligature_msg::status_t> decode(Bytes message);
template <>
std::optional<ligature_msg::event_t> decode(Bytes message);
template <>
std::optional<ligature_msg::ack_t> decode(Bytes message);
template <>
std::optional<ligature_msg::command_t> decode(Bytes message);
template <>
std::optional<ligature_msg::offer_t> decode(Bytes message);

/// Encodes a message (an lcm-gen type) into a reusable buffer.
template <class M>
void encode(const M& message, std::vector<std::byte>& bytes) {
  bytes.resize(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
}

/// Whether a message on one of Ligature's channels can be decoded; true for other channels.
[[nodiscard]] bool is_readable(std::string_view channel, Bytes message);

}  // namespace ligature::host
