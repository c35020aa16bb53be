// The server's own limits, over real sockets of this machine.
#include "host/view/server.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace ligature::host::view {
namespace {

/// A peer that may say something, or nothing.
class Peer {
 public:
  explicit Peer(std::uint16_t port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(port);
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = connect(socket_, reinterpret_cast<const sockaddr*>(&at), sizeof at) == 0;
  }
  ~Peer() { close(socket_); }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// The beginning of the answer; empty when the server closes instead.
  [[nodiscard]] std::string ask(std::string_view request) const {
    if (!connected_) return {};
    if (send(socket_, request.data(), request.size(), MSG_NOSIGNAL) < 0) return {};
    std::string answer(64, '\0');
    const auto got = recv(socket_, answer.data(), answer.size(), 0);
    answer.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return answer;
  }

 private:
  int socket_;
  bool connected_ = false;
};

TEST(Server, PeersThatConnectAndSayNothingKeepNoPageOut) {
  const Access access;
  const Picture picture;
  std::atomic<bool> done = false;
  ServerHooks hooks;
  hooks.on_tick = [&done](bool& more) {
    more = !done;
    return std::multimap<std::uint64_t, nlohmann::json>{};
  };
  Server server({.listen = "127.0.0.1", .port = 0}, access, picture, hooks);
  const auto port = server.port();
  std::string answer;
  std::thread visitor([&] {
    std::vector<std::unique_ptr<Peer>> silent;
    for (int i = 0; i < 200; ++i) silent.push_back(std::make_unique<Peer>(port));
    const Peer page(port);
    answer = page.ask("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
    done = true;
  });
  server.run();
  visitor.join();
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 200 OK")) << "answer: '" << answer << "'";
}

}  // namespace
}  // namespace ligature::host::view
