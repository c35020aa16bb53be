// The server of `ligature-host view` limits clients, requests and messages; tested over local sockets.
#include "host/view/server.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <functional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace ligature::host::view {
namespace {

/// A client connection.
class Peer {
 public:
  explicit Peer(std::uint16_t port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(port);
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{.tv_sec = 20, .tv_usec = 0};  // only ends a test that hangs
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    connected_ = connect(socket_, reinterpret_cast<const sockaddr*>(&at), sizeof at) == 0;
  }
  ~Peer() { close(socket_); }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// Sends a request. @return the beginning of the answer; empty if the server closes the connection.
  [[nodiscard]] std::string ask(std::string_view request) const {
    if (!connected_) return {};
    if (send(socket_, request.data(), request.size(), MSG_NOSIGNAL) < 0) return {};
    std::string answer(64, '\0');
    const auto got = recv(socket_, answer.data(), answer.size(), 0);
    answer.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return answer;
  }

  /// Sends a request. @return status line and header fields of the answer; empty if the server closes the connection.
  [[nodiscard]] std::string head_of(std::string_view request) const {
    std::string head = ask(request);
    for (char c = 0; !head.empty() && head.find("\r\n\r\n") == std::string::npos && recv(socket_, &c, 1, 0) == 1;)
      head += c;
    return head;
  }

  /// Upgrades the connection to a web socket, as a page does. @return whether that succeeded.
  [[nodiscard]] bool upgrade() const {
    return ask("GET /socket HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
               "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n")
        .starts_with("HTTP/1.1 101");
  }
  /// Sends a short text message, masked with zeros.
  void say(const std::string& text) const {
    const std::string frame = std::string{'\x81', static_cast<char>(0x80 | text.size()), 0, 0, 0, 0} + text;
    (void)send(socket_, frame.data(), frame.size(), MSG_NOSIGNAL);
  }
  /// Reads until the server closes the connection. @return whether it did.
  [[nodiscard]] bool is_closed() const {
    std::array<char, 4096> bytes{};
    for (;;) {
      const auto got = recv(socket_, bytes.data(), bytes.size(), 0);
      if (got <= 0) return got == 0 || errno == ECONNRESET;
    }
  }

 private:
  int socket_;
  bool connected_ = false;
};

const Access kToken{"0123456789abcdef", true};
const std::string kGreeting = R"({"token":"0123456789abcdef"})";

/// A server, and a second thread in which `visit` acts as its clients.
class Visited {
 public:
  Visited(Access access, const ServerOptions& options, const std::function<void(Visited&)>& visit)
      : access_(std::move(access)), server_(options, access_, picture_, hooks()) {
    std::thread visitor([&] {
      visit(*this);
      done_ = true;
    });
    server_.run();
    visitor.join();
  }
  [[nodiscard]] std::unique_ptr<Peer> peer() const { return std::make_unique<Peer>(server_.port()); }
  [[nodiscard]] bool is_served() const {
    return peer()->ask("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n").starts_with("HTTP/1.1 200 OK");
  }
  /// Sends a command and waits until the server has handled it. @return false on timeout.
  [[nodiscard]] bool is_heard(const Peer& page) {
    const int before = heard_;
    page.say(R"({"seen":0})");  // marks the page as active
    page.say(R"({"command":"stop","id":1})");
    for (int i = 0; i < 2000 && heard_ == before; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return heard_ > before;
  }

 private:
  ServerHooks hooks() {
    return {[this](std::uint64_t, const nlohmann::json&) {
              ++heard_;
              return nlohmann::json(nullptr);
            },
            [this](bool& more) {
              more = !done_;
              return std::multimap<std::uint64_t, nlohmann::json>{};
            }};
  }
  const Access access_;
  const Picture picture_;
  std::atomic<bool> done_ = false;
  std::atomic<int> heard_ = 0;
  Server server_;
};

constexpr int kMany = 200;  // more than three times the server's limit

/// Clients that open a page and stay silent; their connections stay open.
std::vector<std::unique_ptr<Peer>> crowd(const Visited& visited) {
  std::vector<std::unique_ptr<Peer>> peers;
  for (int i = 0; i < kMany; ++i) {
    peers.push_back(visited.peer());
    EXPECT_TRUE(peers.back()->upgrade()) << i;
  }
  return peers;
}

TEST(Server, EveryAnswerSaysWhatItIsAndWhoMayUseIt) {
  Visited(kToken, {.listen = "127.0.0.1", .port = 0}, [](Visited& visited) {
    for (const auto& [file, type] : {std::pair("/", "text/html"), std::pair("/main.js", "text/javascript")}) {
      const auto head = visited.peer()->head_of("GET " + std::string(file) + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
      EXPECT_TRUE(head.starts_with("HTTP/1.1 200 OK")) << head;
      for (const std::string& line :
           {"Content-Type: " + std::string(type),
            std::string("Content-Security-Policy: default-src 'none'; script-src 'self'"),
            std::string("X-Content-Type-Options: nosniff"), std::string("X-Frame-Options: DENY"),
            std::string("Cache-Control: no-store"), std::string("Cross-Origin-Resource-Policy: same-origin")})
        EXPECT_NE(head.find("\r\n" + line), std::string::npos) << line << " is not in\n" << head;
    }
  });
}

TEST(Server, WhatIsNoRequestOfItsOwnPageIsTurnedAway) {
  Visited(kToken, {.listen = "127.0.0.1", .port = 0}, [](Visited& visited) {
    const auto answer = [&](const std::string& request) { return visited.peer()->ask(request).substr(0, 12); };
    EXPECT_EQ(answer("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"), "HTTP/1.1 403");
    EXPECT_EQ(answer("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n"), "HTTP/1.1 405");
    EXPECT_EQ(answer("GET /../main.js HTTP/1.1\r\nHost: localhost\r\n\r\n"), "HTTP/1.1 404");
    EXPECT_EQ(answer("GET /socket HTTP/1.1\r\nHost: localhost\r\nOrigin: http://evil.example\r\nUpgrade: websocket\r\n"
                     "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                     "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"),
              "HTTP/1.1 403");
    const std::string filler(7000, 'x'), more(2000, 'x');
    EXPECT_EQ(answer("GET / HTTP/1.1\r\nHost: localhost\r\nX: " + filler + "\r\n\r\n"), "HTTP/1.1 200");
    EXPECT_EQ(answer("GET / HTTP/1.1\r\nHost: localhost\r\nX: " + filler + more + "\r\n\r\n"), "")
        << "8 kB are allowed";
    EXPECT_EQ(answer("GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2000\r\n\r\n" + more), "") << "1 kB is";
  });
}

TEST(Server, PagesWithoutTheTokenKeepNobodyOutAndTakeNoPlaceOfThoseWithIt) {
  Visited(kToken, {.listen = "127.0.0.1", .port = 0}, [](Visited& visited) {
    const auto page = visited.peer();
    EXPECT_TRUE(page->upgrade());
    page->say(kGreeting);
    EXPECT_TRUE(visited.is_heard(*page));
    const auto strangers = crowd(visited);
    EXPECT_TRUE(visited.is_served());
    EXPECT_TRUE(visited.is_heard(*page)) << "a page with the token lost its place";
    const auto next = visited.peer();
    EXPECT_TRUE(next->upgrade());
    EXPECT_TRUE(visited.is_heard(*next));
  });
}

TEST(Server, WhereNobodyHasATokenTheLongestLookerMakesRoom) {
  Visited({}, {.listen = "127.0.0.1", .port = 0}, [](Visited& visited) {
    const auto lookers = crowd(visited);
    EXPECT_TRUE(visited.is_served());
    EXPECT_TRUE(lookers.front()->is_closed());
    EXPECT_TRUE(visited.is_heard(*lookers.back()));
  });
}

TEST(Server, APageThatCarriesTheTokenAndDoesNotSayItEnds) {
  Visited(kToken, {.listen = "127.0.0.1", .port = 0, .token_within = std::chrono::milliseconds(100)},
          [](Visited& visited) {
            const auto page = visited.peer(), stranger = visited.peer(), liar = visited.peer();
            EXPECT_TRUE(page->upgrade());
            page->say(kGreeting);
            EXPECT_TRUE(stranger->upgrade());
            EXPECT_TRUE(liar->upgrade());
            liar->say(R"({"token":"0123456789abcdee"})");
            EXPECT_TRUE(stranger->is_closed());
            EXPECT_TRUE(liar->is_closed());
            EXPECT_TRUE(visited.is_heard(*page));
          });
}

TEST(Server, APageThatFloodsEndsAndOneThatTalksDoesNot) {
  Visited(kToken, {.listen = "127.0.0.1", .port = 0}, [](Visited& visited) {
    const auto page = visited.peer(), flood = visited.peer();
    EXPECT_TRUE(page->upgrade());
    page->say(kGreeting);
    for (int i = 0; i < 200; ++i) page->say(R"({"seen":0})");
    EXPECT_TRUE(visited.is_heard(*page)) << "300 a second are allowed";
    EXPECT_TRUE(flood->upgrade());
    flood->say(kGreeting);
    for (int i = 0; i < 20'000; ++i) flood->say(R"({"seen":0})");  // more than 300 per second for a minute
    EXPECT_TRUE(flood->is_closed());
    EXPECT_TRUE(visited.is_heard(*page));
  });
}

TEST(Server, WhereTheTokenIsGivenByHandPagesMayLookWithoutIt) {
  Visited({"0123456789abcdef", false}, {.listen = "127.0.0.1", .port = 0, .token_within = std::chrono::milliseconds(1)},
          [](Visited& visited) {
            const auto looker = visited.peer();
            EXPECT_TRUE(looker->upgrade());
            for (int i = 0; i < 5; ++i) EXPECT_TRUE(visited.is_heard(*looker));
          });
}

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
