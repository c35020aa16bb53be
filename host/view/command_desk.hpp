#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "host/exchange.hpp"
#include "host/messages.hpp"
#include "host/view/access.hpp"

namespace ligature::host::view {

/// Passes commands from pages to the firmware and the answers back. Every command gets an answer: accepted, refused
/// with a reason, or that no answer came in time.
class CommandDesk {
 public:
  using Clock = std::chrono::steady_clock;
  using Publish = std::function<void(const ligature_msg::command_t&)>;
  static constexpr auto kRepeatEvery = std::chrono::milliseconds(100);
  static constexpr std::size_t kMostWaiting = 64;

  CommandDesk(const Access& access, Publish publish) : access_(access), publish_(std::move(publish)) {}

  /// Handles a page's request {"command": "arm", "id": 7, "token": "..."}; "load-scene" also has a "text", "set" a
  /// "text" and a "value". @return an answer that is known at once, else null.
  [[nodiscard]] nlohmann::json request(std::uint64_t page, const nlohmann::json& message, Clock::time_point now);

  /// Takes an answer of the firmware; called on the LCM thread.
  void take_ack(const ligature_msg::ack_t& ack);

  /// Answers for pages since the last call, including those for commands whose time ran out. Repeats messages that may
  /// be repeated (Exchange::may_be_repeated).
  [[nodiscard]] std::multimap<std::uint64_t, nlohmann::json> answers(Clock::time_point now);

 private:
  struct Waiting {
    std::uint64_t page;
    nlohmann::json id;
    std::string word;
    Exchange exchange;
    Clock::time_point sent, repeated;
  };

  void publish_quietly(const Waiting& waiting);

  const Access& access_;
  Publish publish_;
  std::mutex mutex_;
  std::map<std::int64_t, Waiting> waiting_;  // commands without an answer, by command id
  std::multimap<std::uint64_t, nlohmann::json> ready_;
};

}  // namespace ligature::host::view
