#include "host/stream/foxglove_server.hpp"

#include <unistd.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <chrono>
#include <thread>

#include "host/errors.hpp"
#include "host/stream/foxglove_client.hpp"

namespace ligature::host::stream {
namespace {

namespace asio = boost::asio;
using tcp = asio::ip::tcp;
constexpr std::size_t kMostClients = 8;

std::string own_name() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

std::string new_session_id() {
  return std::to_string(std::chrono::system_clock::now().time_since_epoch() / std::chrono::milliseconds(1));
}

}  // namespace

struct FoxgloveServer::Parts {
  FoxgloveRules rules;  // first member: must outlive the clients, which end with io
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  std::vector<std::weak_ptr<FoxgloveClient>> clients{};
  std::jthread thread{};

  void accept() {
    acceptor.async_accept([this](boost::system::error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      std::erase_if(clients, [](const auto& client) { return client.expired(); });
      if (!error && clients.size() < kMostClients) {
        const auto client = std::make_shared<FoxgloveClient>(std::move(socket), rules);
        clients.push_back(client);
        client->start();
      }
      accept();
    });
  }
};

FoxgloveServer::FoxgloveServer(const FoxgloveOptions& options)
    : parts_(new Parts{.rules = {own_name(), options.allowed_origins, new_session_id()}}) {
  boost::system::error_code error;
  const auto address = asio::ip::make_address(options.listen, error);
  if (error)
    throw BadInput("--listen: found '" + options.listen + "', allowed an address such as 127.0.0.1 or 0.0.0.0");
  const tcp::endpoint endpoint(address, options.port);
  auto& acceptor = parts_->acceptor;
  (void)acceptor.open(endpoint.protocol(), error);
  if (!error) (void)acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) (void)acceptor.bind(endpoint, error);
  if (!error) (void)acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error)
    throw RunFailed("cannot listen on " + options.listen + ":" + std::to_string(options.port) + ": " + error.message() +
                    "; remedy: another --port or --listen");
  parts_->accept();
  parts_->thread = std::jthread([parts = parts_.get()] { parts->io.run(); });
}

FoxgloveServer::~FoxgloveServer() {
  parts_->io.stop();
  parts_->thread.join();
}

std::uint16_t FoxgloveServer::port() const { return parts_->acceptor.local_endpoint().port(); }

void FoxgloveServer::publish(std::vector<TopicMessage> messages) {
  asio::post(parts_->io, [parts = parts_.get(), messages = std::move(messages)] {
    for (const auto& weak : parts->clients)
      if (const auto client = weak.lock())
        for (const auto& [topic, time_ns, text] : messages) client->offer(topic, time_ns, text);
  });
}

}  // namespace ligature::host::stream
