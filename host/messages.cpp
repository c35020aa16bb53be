#include "host/messages.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "protocol/lcm/array_fits.hpp"

namespace ligature::host {
namespace {

using lcm_tools::int32_at, lcm_tools::kFloat, lcm_tools::kHash, lcm_tools::kInt32, lcm_tools::kInt64, lcm_tools::kInt8;

constexpr std::int64_t kLargestTick = std::int64_t{1} << 40;  // 35 years at 1 kHz; larger numbers are rejected

/// Moves `offset` past `count` consecutive strings (length including the terminator, bytes, 0). False when one exceeds
/// the message.
bool skip_strings(Bytes message, std::size_t& offset, int count) {
  for (int i = 0; i < count; ++i) {
    const auto length = int32_at(message, offset);
    if (!length || *length < 1) return false;
    offset += kInt32 + static_cast<std::size_t>(*length);
    if (offset > message.size()) return false;
  }
  return true;
}

bool strings_fit(Bytes message, std::size_t offset, int count) { return skip_strings(message, offset, count); }

/// Moves `offset` past a preview_t: two strings, a float, and an array of points with its length. False when it exceeds
/// the message.
bool skip_preview(Bytes message, std::size_t& offset) {
  if (!skip_strings(message, offset, 2)) return false;
  const auto points = int32_at(message, offset += kFloat);
  if (!points || *points < 0) return false;
  offset += kInt32 + 3 * kFloat * static_cast<std::size_t>(*points);
  return offset <= message.size();
}

/// Whether the message has the layout of offer_t: scene names, a preview of each, then parameters of three strings and
/// three doubles each, up to the end of the message.
bool offer_fits(Bytes message) {
  std::size_t at = kHash + 2 * kInt64;
  const auto scenes = int32_at(message, at);
  at += kInt32;
  if (!scenes || *scenes < 0 || !skip_strings(message, at, *scenes)) return false;
  for (int i = 0; i < *scenes; ++i)
    if (!skip_preview(message, at)) return false;
  const auto parameters = int32_at(message, at);
  at += kInt32;
  if (!parameters || *parameters < 0) return false;
  for (int i = 0; i < *parameters; ++i, at += 3 * sizeof(double)) {
    if (!skip_strings(message, at, 3)) return false;
  }
  return at == message.size();
}

template <class M>
std::optional<M> decode_checked(Bytes message) {
  if (message.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) return std::nullopt;
  M decoded{};
  const int size = static_cast<int>(message.size());
  if (decoded.decode(message.data(), 0, size) != size) return std::nullopt;
  return decoded;
}

bool is_tick_number(std::int64_t tick) { return tick >= 0 && tick < kLargestTick; }

/// Whether tick numbers are valid and strictly rising. Gaps are allowed: the firmware's ring buffer may drop ticks.
bool is_rising(const std::vector<ligature_msg::tick_t>& ticks) {
  const auto falls = [](const auto& a, const auto& b) { return a.tick >= b.tick; };
  return std::ranges::all_of(ticks, is_tick_number, &ligature_msg::tick_t::tick) &&
         std::ranges::adjacent_find(ticks, falls) == ticks.end();
}

}  // namespace

template <>
std::optional<ligature_msg::tick_batch_t> decode(Bytes message) {
  static const auto tick_size = static_cast<std::size_t>(ligature_msg::tick_t{}._getEncodedSizeNoHash());
  if (!lcm_tools::tick_batch_fits(message, tick_size)) return std::nullopt;
  auto batch = decode_checked<ligature_msg::tick_batch_t>(message);
  if (batch && !is_rising(batch->ticks)) return std::nullopt;
  return batch;
}

template <>
std::optional<ligature_msg::thread_t> decode(Bytes message) {
  if (!lcm_tools::thread_fits(message)) return std::nullopt;
  auto thread = decode_checked<ligature_msg::thread_t>(message);
  if (thread && !is_tick_number(thread->tick)) return std::nullopt;
  return thread;
}

template <>
std::optional<ligature_msg::status_t> decode(Bytes message) {
  if (!strings_fit(message, kHash + 2 * kInt64 + kInt32, 4)) return std::nullopt;
  auto status = decode_checked<ligature_msg::status_t>(message);
  if (status && !(std::isfinite(status->period_s) && status->period_s > 0.0)) return std::nullopt;
  return status;
}

template <>
std::optional<ligature_msg::event_t> decode(Bytes message) {
  if (!strings_fit(message, kHash + 2 * kInt64 + 2 * kInt8 + kInt32, 1)) return std::nullopt;
  return decode_checked<ligature_msg::event_t>(message);
}

template <>
std::optional<ligature_msg::ack_t> decode(Bytes message) {
  if (!strings_fit(message, kHash + 4 * kInt64 + kInt8, 1)) return std::nullopt;
  return decode_checked<ligature_msg::ack_t>(message);
}

template <>
std::optional<ligature_msg::offer_t> decode(Bytes message) {
  if (!offer_fits(message)) return std::nullopt;
  auto offer = decode_checked<ligature_msg::offer_t>(message);
  const auto is_range = [](const ligature_msg::parameter_t& p) {
    return std::isfinite(p.value) && std::isfinite(p.lowest) && std::isfinite(p.highest) && p.lowest <= p.highest;
  };
  if (offer && !std::ranges::all_of(offer->parameters, is_range)) return std::nullopt;
  return offer;
}

template <>
std::optional<ligature_msg::command_t> decode(Bytes message) {
  if (!strings_fit(message, kHash + 4 * kInt64 + kInt8, 1)) return std::nullopt;
  return decode_checked<ligature_msg::command_t>(message);
}

bool is_readable(std::string_view channel, Bytes message) {
  if (channel == kTicksChannel) return decode<ligature_msg::tick_batch_t>(message).has_value();
  if (channel == kThreadChannel) return decode<ligature_msg::thread_t>(message).has_value();
  if (channel == kStatusChannel) return decode<ligature_msg::status_t>(message).has_value();
  if (channel == kEventChannel) return decode<ligature_msg::event_t>(message).has_value();
  if (channel == kAckChannel) return decode<ligature_msg::ack_t>(message).has_value();
  if (channel == kCommandChannel) return decode<ligature_msg::command_t>(message).has_value();
  if (channel == kOfferChannel) return decode<ligature_msg::offer_t>(message).has_value();
  return true;
}

}  // namespace ligature::host
