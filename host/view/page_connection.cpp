#include "host/view/page_connection.hpp"

#include <boost/asio/buffer.hpp>

#include "host/view/json_text.hpp"

namespace ligature::host::view {
namespace {

using Clock = Picture::Clock;
constexpr auto kSilentPage = std::chrono::seconds(30);  // a page that acknowledges nothing for so long is closed
constexpr int kSocketBuffer = 128 * 1024;               // small, so that frames do not wait in the kernel

}  // namespace

PageConnection::PageConnection(beast::tcp_stream stream, Shared& shared)
    : shared_(shared), id_(++shared.last_page), socket_(std::move(stream)) {
  ++shared_.connections;
  ++shared_.lookers;
  began_ = second_began_ = last_seen_ = Clock::now();
}

PageConnection::~PageConnection() {
  end();
  give_place_back();
  shared_.pages.erase(id_);
}

void PageConnection::end() {
  open_ = false;
  if (shared_.hooks.on_gone) shared_.hooks.on_gone(id_);
}

void PageConnection::give_place_back() {
  if (!std::exchange(has_place_, false)) return;
  --shared_.connections;
  if (!is_known_) --shared_.lookers;
}

void PageConnection::accept(const http::request<http::string_body>& upgrade) {
  boost::system::error_code ignored;
  auto& tcp_socket = beast::get_lowest_layer(socket_).socket();
  (void)tcp_socket.set_option(boost::asio::socket_base::send_buffer_size(kSocketBuffer), ignored);
  (void)tcp_socket.set_option(tcp::no_delay(true), ignored);
  beast::get_lowest_layer(socket_).expires_never();  // from here on the WebSocket's own time limits apply
  beast::websocket::stream_base::timeout limits{};
  limits.handshake_timeout = std::chrono::seconds(10);
  limits.idle_timeout = kSilentPage;
  limits.keep_alive_pings = false;
  socket_.set_option(limits);
  socket_.read_message_max(inbox_.max_size());
  socket_.binary(true);
  socket_.async_accept(upgrade, [self = shared_from_this()](beast::error_code error) {
    if (error) return;
    self->open_ = true;
    self->shared_.pages[self->id_] = self;
    self->read();
  });
}

void PageConnection::read() {
  socket_.async_read(inbox_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    if (error) return self->end();  // connection closed, message too large or malformed, or page silent for too long
    const auto data = self->inbox_.data();
    const bool goes_on = self->on_message({static_cast<const char*>(data.data()), data.size()});
    self->inbox_.clear();
    if (goes_on)
      self->read();
    else
      self->close();
  });
}

bool PageConnection::on_message(std::string_view text) {
  const auto now = Clock::now();
  if (now - second_began_ >= std::chrono::seconds(1)) {
    second_began_ = now;
    messages_this_second_ = 0;
  }
  if (++messages_this_second_ > kMessagesPerSecond || !socket_.got_text()) return false;
  const auto message = nlohmann::json::parse(text, nullptr, false);
  if (!message.is_object()) return false;
  if (const auto seen = message.find("seen"); seen != message.end() && seen->is_number_unsigned()) {
    seen_ = seen->get<std::uint32_t>();
    last_seen_ = now;
    return seen_ <= place_.frame;
  }
  look_at_token(message);
  if (message.size() == 1 && message.contains("token"))
    return true;  // the message only shows the token and contains no request
  if (auto answer = shared_.hooks.on_message(id_, message); !answer.is_null()) add_answer(answer);
  return true;
}

void PageConnection::look_at_token(const nlohmann::json& message) {
  if (is_known_ || !has_place_ || !is_token(text_of(message, "token"), shared_.access.token)) return;
  is_known_ = true;
  --shared_.lookers;
}

void PageConnection::add_answer(const nlohmann::json& answer) {
  if (answers_.size() < kMostAnswers) answers_.push_back(answer);
}

void PageConnection::offer_frame(Clock::time_point now) {
  if (!open_) return;
  const bool is_stranger = !is_known_ && shared_.access.gives_token && now - began_ > shared_.token_within;
  if (is_stranger || now - last_seen_ > kSilentPage) return close();
  if (writing_ || place_.frame - seen_ >= kMostUnseen) return;
  outbox_ = shared_.picture.frame_for(place_, std::exchange(answers_, nlohmann::json::array()), now);
  writing_ = true;
  socket_.async_write(boost::asio::buffer(outbox_), [self = shared_from_this()](beast::error_code error, std::size_t) {
    self->writing_ = false;
    if (error) self->end();
  });
}

void PageConnection::close() {
  end();
  give_place_back();
  beast::get_lowest_layer(socket_).close();
}

}  // namespace ligature::host::view
