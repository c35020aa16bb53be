#pragma once
// LCM connection of telemetry. Messages that cannot be sent are counted; nothing blocks.

#include <lcm/lcm-cpp.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "firmware/telemetry/telemetry.hpp"

namespace ligature::telemetry {

/// Why a URL is not allowed; empty if it is allowed. Allowed are "udpm://ADDRESS:PORT[?..]" with a multicast address,
/// and "memq://" (within this process).
[[nodiscard]] std::string objection_to_url(const std::string& url);

class LcmLink final : public Sink {
 public:
  /// Handles a command. @return the answer, or nothing if it comes later by answer().
  using OnCommand = std::function<std::optional<ligature_msg::ack_t>(const ligature_msg::command_t&)>;
  using OnEvent = std::function<void(const ligature_msg::event_t&)>;

  /// Opens the URL. Takes seconds if multicast is misconfigured, so call it before the loop starts.
  LcmLink(const std::string& url, OnEvent on_event);

  /// False if the URL is invalid or the network refuses it (no multicast route).
  [[nodiscard]] bool is_open() const noexcept { return open_; }
  [[nodiscard]] std::int64_t failures() const noexcept { return failures_; }

  /// Starts to handle commands, and answers each with an ack. Commands received earlier are discarded.
  void listen(OnCommand on_command);

  /// Handles commands for at most this time; also serves as the pause between two steps of telemetry.
  void wait(std::int64_t at_most_ms);

  void answer(const ligature_msg::ack_t& ack) { publish("LIGATURE_ACK", ack); }

  void send(const ligature_msg::tick_batch_t& m) override { publish("LIGATURE_TICKS", m); }
  void send(const ligature_msg::thread_t& m) override { publish("LIGATURE_THREAD", m); }
  void send(const ligature_msg::status_t& m) override { publish("LIGATURE_STATUS", m); }
  void send(const ligature_msg::offer_t& m) override { publish("LIGATURE_OFFER", m); }
  void send(const ligature_msg::event_t& m) override {
    publish("LIGATURE_EVENT", m);
    on_event_(m);
  }

 private:
  template <class Message>
  void publish(const char* channel, const Message& m) {
    if (!open_ || lcm_->publish(channel, &m) != 0) ++failures_;
  }
  /// A static function, because GCC's -fsanitize=vptr miscompiles LCM's wrapper for member functions: its check uses
  /// the object's address before that is computed.
  static void receive(const lcm::ReceiveBuffer* received, const std::string& channel, LcmLink* link);

  std::unique_ptr<lcm::LCM> lcm_;
  bool open_ = false;
  bool listening_ = false;
  std::int64_t failures_ = 0;
  OnEvent on_event_;
  OnCommand on_command_;
};

}  // namespace ligature::telemetry
