#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "host/view/access.hpp"
#include "host/view/picture.hpp"

namespace ligature::host::view {

struct ServerOptions {
  std::string listen = "127.0.0.1";
  std::uint16_t port = 8737;                       // 0: any free one
  std::chrono::milliseconds token_within{10'000};  // a page that carries the token says it at once; another ends then
};

/// The address to open in a browser; an IPv6 one stands in brackets.
[[nodiscard]] std::string url_of(const ServerOptions& options, std::uint16_t port);

/// Whether only this machine can reach it.
[[nodiscard]] bool is_loopback(const ServerOptions& options);

/// What the server needs of the rest. All are called on the server's thread.
struct ServerHooks {
  /// A text message of a page; @return an answer for it, or null.
  std::function<nlohmann::json(std::uint64_t page, const nlohmann::json& message)> on_message;
  /// 60 times a second, before frames are sent. @return answers for pages; false in `more` ends the server.
  std::function<std::multimap<std::uint64_t, nlohmann::json>(bool& more)> on_tick;
  /// The page's connection has ended; may be missing, and may be called more than once for a page.
  std::function<void(std::uint64_t page)> on_gone = {};
};

/// HTTP and WebSocket on one port and one thread (Boost.Beast). Pages get a frame 60 times a second unless the last
/// three are not yet acknowledged: a slow one is shown less often, and nothing is ever queued for it.
/// Bounds: 64 connections, of them 16 pages without the token where the page carries it (for 10 s each), 48 where it is
/// given by hand (the oldest makes room: first who speaks HTTP, then who has not shown the token), 4 KiB a message, 300
/// messages a second, 8 KiB of HTTP header, 10 s for a request or a write.
class Server {
 public:
  /// @throws BadInput for an address that is none, RunFailed when it cannot be bound.
  Server(const ServerOptions& options, const Access& access, const Picture& picture, ServerHooks hooks);
  ~Server();

  [[nodiscard]] std::uint16_t port() const;
  /// Serves until on_tick says no more.
  void run();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ligature::host::view
