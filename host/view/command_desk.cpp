#include "host/view/command_desk.hpp"

#include <utility>

#include "host/send.hpp"
#include "host/text.hpp"
#include "host/view/json_text.hpp"
#include "protocol/lcm/command_words.hpp"

namespace ligature::host::view {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestText = 100;

json answer(const json& id, const std::string& word, bool accepted, const std::string& why) {
  return {{"id", id}, {"command", word}, {"accepted", accepted}, {"text", why}};
}

}  // namespace

json CommandDesk::request(std::uint64_t page, const json& message, Clock::time_point now) {
  const std::string word = text_of(message, "command");
  const json id = id_of(message);
  const auto kind = lcm_tools::command_kind(word);
  if (!kind) return answer(id, word.substr(0, 40), false, "no such command");
  if (const auto why = objection_to(text_of(message, "token"), access_); !why.empty())
    return answer(id, word, false, why);

  const std::scoped_lock lock(mutex_);
  if (waiting_.size() >= kMostWaiting) return answer(id, word, false, "too many commands are waiting for an answer");
  const auto value = message.find("value");
  const Exchange exchange(*kind, text_of(message, "text").substr(0, kLongestText),
                          value != message.end() && value->is_number() ? value->get<double>() : 0.0);
  try {
    publish_(exchange.message());
  } catch (const std::exception& error) {
    return answer(id, word, false, error.what());
  }
  waiting_.insert_or_assign(exchange.id(), Waiting{page, id, word, exchange, now, now});
  return nullptr;
}

/// Ignores failures to send: the page then learns from the missing answer.
void CommandDesk::publish_quietly(const Waiting& waiting) {
  try {
    publish_(waiting.exchange.message());
  } catch (const std::exception&) {
    return;
  }
}

void CommandDesk::take_ack(const ligature_msg::ack_t& ack) {
  const std::scoped_lock lock(mutex_);
  const auto found = waiting_.find(ack.id);
  if (found == waiting_.end()) return;
  auto& waiting = found->second;
  const auto step = waiting.exchange.take(ack);
  if (step == Exchange::Step::kSay) publish_quietly(waiting);
  if (step != Exchange::Step::kAnswered) return;
  ready_.emplace(waiting.page, answer(waiting.id, waiting.word, ack.accepted != 0, shortened(ack.reason, 600)));
  waiting_.erase(found);
}

std::multimap<std::uint64_t, json> CommandDesk::answers(Clock::time_point now) {
  const std::scoped_lock lock(mutex_);
  for (auto it = waiting_.begin(); it != waiting_.end();) {
    auto& w = it->second;
    if (const auto patience = answer_time(w.exchange.message().kind); now - w.sent >= patience) {
      const std::string time = std::to_string(patience.count());
      ready_.emplace(w.page, answer(w.id, w.word, false, "within " + time + " s " + w.exchange.silence()));
      it = waiting_.erase(it);
      continue;
    }
    if (w.exchange.may_be_repeated() && now - w.repeated >= kRepeatEvery) {
      w.repeated = now;
      publish_quietly(w);
    }
    ++it;
  }
  return std::exchange(ready_, {});
}

}  // namespace ligature::host::view
