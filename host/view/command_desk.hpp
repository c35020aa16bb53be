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

/// Passes commands of pages on to the firmware and its answers back. Every command is answered: accepted or refused
/// with the reason, or that nobody answered.
class CommandDesk {
 public:
  using Clock = std::chrono::steady_clock;
  using Publish = std::function<void(const ligature_msg::command_t&)>;
  static constexpr auto kRepeatEvery = std::chrono::milliseconds(100);
  static constexpr std::size_t kMostWaiting = 64;

  CommandDesk(const Access& access, Publish publish) : access_(access), publish_(std::move(publish)) {}

  /// A request {"command": "arm", "id": 7, "token": "..."} of a page; "load-scene" has a "text", "set" a "text" and a
  /// "value". @return an answer when there is one at once.
  [[nodiscard]] nlohmann::json request(std::uint64_t page, const nlohmann::json& message, Clock::time_point now);

  /// What the firmware answered; called by the thread that hears LCM.
  void take_ack(const ligature_msg::ack_t& ack);

  /// Answers for pages that have come since the last call, and of those that nobody gave in time. Repeats a stop and
  /// what only asks.
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
  std::map<std::int64_t, Waiting> waiting_;  // by the id of the command
  std::multimap<std::uint64_t, nlohmann::json> ready_;
};

}  // namespace ligature::host::view
