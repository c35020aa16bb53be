#pragma once
// The messages of the Foxglove WebSocket protocol, version 1, as a server without optional capabilities uses them;
// the text of the protocol: https://github.com/foxglove/ws-protocol

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ligature::host::stream {

inline constexpr std::string_view kFoxgloveProtocol = "foxglove.websocket.v1";

/// Whether a list of subprotocols ("a, b") contains kFoxgloveProtocol.
[[nodiscard]] bool offers_foxglove(std::string_view subprotocols);

/// Whether a page with this Origin may read the rig. Foxglove's web application may, and programs that are no web page
/// (no Origin, or not one of http or https). Other web sites may not, unless they are in `allowed`.
[[nodiscard]] bool may_read(std::string_view origin, const std::vector<std::string>& allowed);

[[nodiscard]] std::string server_info(const std::string& session_id);
/// Announces viewer_topics(); a topic's channel number is its index.
[[nodiscard]] std::string advertise();
[[nodiscard]] std::string warning(const std::string& text);

/// What a client asks for.
struct ClientWish {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> subscribe;  // number of the subscription, channel
  std::vector<std::uint32_t> unsubscribe;                          // numbers of subscriptions
  std::string complaint;  // set when the message cannot be understood or is not offered
};
[[nodiscard]] ClientWish read_client_message(std::string_view text);

/// The binary message that carries one message of a topic.
[[nodiscard]] std::string message_data(std::uint32_t subscription, std::uint64_t time_ns, std::string_view message);

}  // namespace ligature::host::stream
