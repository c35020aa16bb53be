#include "host/stream/foxglove_client.hpp"

#include <boost/asio/buffer.hpp>
#include <chrono>

#include "host/stream/foxglove_messages.hpp"
#include "host/view/access.hpp"

namespace ligature::host::stream {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;

constexpr auto kRequestWithin = std::chrono::seconds(10);

std::string_view text_of(const auto& request, http::field field) {
  const auto value = request[field];
  return {value.data(), value.size()};
}

}  // namespace

FoxgloveClient::FoxgloveClient(boost::asio::ip::tcp::socket socket, const FoxgloveRules& rules)
    : rules_(rules), socket_(std::move(socket)) {}

void FoxgloveClient::start() {
  parser_ = std::make_unique<http::request_parser<http::empty_body>>();
  parser_->header_limit(8U << 10U);
  auto& stream = beast::get_lowest_layer(socket_);
  stream.expires_after(kRequestWithin);
  http::async_read(stream, inbox_, *parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    if (!error) self->answer(self->parser_->get());
  });
}

void FoxgloveClient::answer(const Request& request) {
  if (!view::is_own_host(text_of(request, http::field::host), rules_.machine_name))
    return refuse(http::status::forbidden, "not this host\n");
  if (!websocket::is_upgrade(request))
    return refuse(http::status::upgrade_required,
                  "for Foxglove: open a Foxglove WebSocket connection to this address\n");
  if (!may_read(text_of(request, http::field::origin), rules_.allowed_origins))
    return refuse(http::status::forbidden, "this web site may not read the rig; remedy: --allow-origin\n");
  if (!offers_foxglove(text_of(request, http::field::sec_websocket_protocol)))
    return refuse(http::status::bad_request, "found no subprotocol foxglove.websocket.v1\n");
  accept(request);
}

void FoxgloveClient::refuse(http::status status, const char* why) {
  refusal_ = {status, 11};
  refusal_.set(http::field::content_type, "text/plain");
  refusal_.body() = why;
  refusal_.keep_alive(false);
  refusal_.prepare_payload();
  http::async_write(beast::get_lowest_layer(socket_), refusal_,
                    [self = shared_from_this()](beast::error_code, std::size_t) { self->close(); });
}

void FoxgloveClient::accept(const Request& request) {
  beast::get_lowest_layer(socket_).expires_never();  // from here on the WebSocket's own time limits apply
  websocket::stream_base::timeout limits{};
  limits.handshake_timeout = kRequestWithin;
  limits.idle_timeout = std::chrono::seconds(30);
  limits.keep_alive_pings = true;
  socket_.set_option(limits);
  socket_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
    response.set(http::field::sec_websocket_protocol,
                 beast::string_view(kFoxgloveProtocol.data(), kFoxgloveProtocol.size()));
  }));
  socket_.read_message_max(inbox_.max_size());
  socket_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
    if (error) return;
    self->is_open_ = true;
    self->queue(server_info(self->rules_.session_id), true);
    self->queue(advertise(), true);
    self->read();
  });
}

void FoxgloveClient::read() {
  socket_.async_read(inbox_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    if (error) return self->close();
    const auto data = self->inbox_.data();
    self->take({static_cast<const char*>(data.data()), data.size()});
    self->inbox_.consume(data.size());
    self->read();
  });
}

void FoxgloveClient::take(std::string_view text) {
  const ClientWish wish = read_client_message(socket_.got_text() ? text : std::string_view());
  for (const auto& [id, channel] : wish.subscribe) subscriptions_[channel] = id;
  for (const auto id : wish.unsubscribe)
    std::erase_if(subscriptions_, [id](const auto& entry) { return entry.second == id; });
  if (!wish.complaint.empty()) queue(warning(wish.complaint), true);
}

void FoxgloveClient::offer(std::uint32_t channel, std::uint64_t time_ns, std::string_view message) {
  const auto found = subscriptions_.find(channel);
  if (found != subscriptions_.end()) queue(message_data(found->second, time_ns, message), false);
}

void FoxgloveClient::queue(std::string bytes, bool is_text) {
  if (!is_open_) return;
  if (waiting_bytes_ + bytes.size() > kMostWaitingBytes) {
    ++left_out_;
    return;
  }
  waiting_bytes_ += bytes.size();
  outbox_.push_back({std::move(bytes), is_text});
  if (!is_writing_) write();
}

void FoxgloveClient::write() {
  if (outbox_.empty() && left_out_ > 0) {
    std::string text = warning(std::to_string(left_out_) + " messages left out: the viewer reads too slowly");
    left_out_ = 0;
    waiting_bytes_ += text.size();
    outbox_.push_back({std::move(text), true});
  }
  if (outbox_.empty() || !is_open_) return;
  is_writing_ = true;
  socket_.text(outbox_.front().is_text);
  socket_.async_write(boost::asio::buffer(outbox_.front().bytes),
                      [self = shared_from_this()](beast::error_code error, std::size_t) {
                        self->is_writing_ = false;
                        if (error) return self->close();
                        self->waiting_bytes_ -= self->outbox_.front().bytes.size();
                        self->outbox_.pop_front();
                        self->write();
                      });
}

void FoxgloveClient::close() {
  is_open_ = false;
  beast::get_lowest_layer(socket_).close();
}

}  // namespace ligature::host::stream
