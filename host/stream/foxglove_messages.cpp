#include "host/stream/foxglove_messages.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "host/mcap/records.hpp"
#include "host/viewer_topics.hpp"

namespace ligature::host::stream {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 2> kFoxgloveSites{"https://app.foxglove.dev", "https://studio.foxglove.dev"};

std::optional<std::uint32_t> number_in(const Json& json) {
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
    return std::nullopt;
  return json.get<std::uint32_t>();
}

/// The array `key` of `message`; an empty one when it has none.
const Json& list_in(const Json& message, const char* key) {
  static const Json none = Json::array();
  const auto found = message.find(key);
  return found != message.end() && found->is_array() ? *found : none;
}

void read_subscriptions(const Json& message, ClientWish& wish) {
  for (const Json& one : list_in(message, "subscriptions")) {
    const auto id = one.is_object() ? number_in(one.value("id", Json())) : std::nullopt;
    const auto channel = one.is_object() ? number_in(one.value("channelId", Json())) : std::nullopt;
    if (id && channel && *channel < kViewerTopics)
      wish.subscribe.emplace_back(*id, *channel);
    else
      wish.complaint = "subscribe: found " + one.dump() + ", allowed id and a channelId that was advertised";
  }
}

}  // namespace

bool offers_foxglove(std::string_view subprotocols) {
  while (!subprotocols.empty()) {
    const auto comma = subprotocols.find(',');
    std::string_view word = subprotocols.substr(0, comma);
    const auto first = word.find_first_not_of(" \t");
    const auto last = word.find_last_not_of(" \t");
    if (first != std::string_view::npos && word.substr(first, last - first + 1) == kFoxgloveProtocol) return true;
    if (comma == std::string_view::npos) return false;
    subprotocols.remove_prefix(comma + 1);
  }
  return false;
}

bool may_read(std::string_view origin, const std::vector<std::string>& allowed) {
  if (std::ranges::find(kFoxgloveSites, origin) != kFoxgloveSites.end()) return true;
  if (std::ranges::find(allowed, origin) != allowed.end()) return true;
  // "null" is the origin of a page in a closed frame, which can belong to any site
  return !origin.starts_with("http://") && !origin.starts_with("https://") && origin != "null";
}

std::string server_info(const std::string& session_id) {
  return Json{{"op", "serverInfo"},
              {"name", "ligature-host " LIGATURE_VERSION},
              {"capabilities", Json::array()},
              {"sessionId", session_id}}
      .dump();
}

std::string advertise() {
  Json channels = Json::array();
  for (std::size_t i = 0; i < kViewerTopics; ++i) {
    const auto& topic = viewer_topics()[i];
    channels.push_back({{"id", i},
                        {"topic", topic.name},
                        {"encoding", "json"},
                        {"schemaName", topic.schema_name},
                        {"schema", topic.schema},
                        {"schemaEncoding", "jsonschema"}});
  }
  return Json{{"op", "advertise"}, {"channels", channels}}.dump();
}

std::string warning(const std::string& text) {
  constexpr int kWarning = 1;
  return Json{{"op", "status"}, {"level", kWarning}, {"message", text}, {"id", "ligature"}}.dump(
      -1, ' ', false, Json::error_handler_t::replace);
}

ClientWish read_client_message(std::string_view text) {
  ClientWish wish;
  const Json message = Json::parse(text, nullptr, false);
  const auto op = message.is_object() ? message.find("op") : message.end();
  if (!message.is_object() || op == message.end() || !op->is_string()) {
    wish.complaint = "found a message without 'op', allowed JSON objects with one";
  } else if (*op == "subscribe") {
    read_subscriptions(message, wish);
  } else if (*op == "unsubscribe") {
    for (const Json& id : list_in(message, "subscriptionIds"))
      if (const auto number = number_in(id)) wish.unsubscribe.push_back(*number);
  } else {
    wish.complaint = "this server only sends; allowed: subscribe, unsubscribe";
  }
  return wish;
}

std::string message_data(std::uint32_t subscription, std::uint64_t time_ns, std::string_view message) {
  std::string bytes;
  bytes.reserve(1 + 4 + 8 + message.size());
  bytes += '\x01';
  mcap::put_number(bytes, subscription);
  mcap::put_number(bytes, time_ns);
  bytes += message;
  return bytes;
}

}  // namespace ligature::host::stream
