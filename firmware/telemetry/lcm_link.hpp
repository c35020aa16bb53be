#pragma once
// The LCM end of telemetry. What LCM cannot do is counted and told; it never holds anything up.

#include <lcm/lcm-cpp.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "firmware/telemetry/telemetry.hpp"

namespace ligature::telemetry {

/// Why a URL cannot be one, or empty: "udpm://ADDRESS:PORT[?..]" with a multicast address, or "memq://" (this process).
[[nodiscard]] std::string objection_to_url(const std::string& url);

class LcmLink final : public Sink {
 public:
  /// The answer, or nothing when it takes a while: then answer() gives it.
  using OnCommand = std::function<std::optional<ligature_msg::ack_t>(const ligature_msg::command_t&)>;
  using OnEvent = std::function<void(const ligature_msg::event_t&)>;

  /// Opens the URL; may take seconds when multicast is misconfigured, so before the loop starts.
  LcmLink(const std::string& url, OnEvent on_event);

  /// False when the URL is none, or the network refuses (no multicast route).
  [[nodiscard]] bool is_open() const noexcept { return open_; }
  [[nodiscard]] std::int64_t failures() const noexcept { return failures_; }

  /// Hears commands and answers each with an ack; those from before are forgotten.
  void listen(OnCommand on_command);

  /// Waits for commands, at most so long; also the pause between two steps.
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
  /// A plain function: what the library makes of a member function does not survive GCC's -fsanitize=vptr, which uses
  /// an object's address before it has computed it where a member is called through a pointer found in a polymorphic
  /// one.
  static void receive(const lcm::ReceiveBuffer* received, const std::string& channel, LcmLink* link);

  std::unique_ptr<lcm::LCM> lcm_;
  bool open_ = false;
  bool listening_ = false;
  std::int64_t failures_ = 0;
  OnEvent on_event_;
  OnCommand on_command_;
};

}  // namespace ligature::telemetry
