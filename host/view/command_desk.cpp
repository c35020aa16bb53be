#include "host/view/command_desk.hpp"

#include <algorithm>

#include "host/send.hpp"
#include "host/view/json_text.hpp"
#include "host/wall_clock.hpp"

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
  const auto kind = command_kind(word);
  if (!kind) return answer(id, word.substr(0, 40), false, "no such command");
  if (access_.token.empty()) return answer(id, word, false, "this view may only look: it was started without a token");
  if (!is_token(text_of(message, "token"), access_.token))
    return answer(id, word, false, "the token is not the one of this view; open the address that its start printed");

  const std::scoped_lock lock(mutex_);
  if (waiting_.size() >= kMostWaiting) return answer(id, word, false, "too many commands are waiting for an answer");
  ligature_msg::command_t command{};
  command.utime = now_us();
  command.id = last_id_ = std::max(last_id_ + 1, command.utime);
  command.kind = *kind;
  command.text = text_of(message, "text").substr(0, kLongestText);
  if (const auto value = message.find("value"); value != message.end() && value->is_number())
    command.value = value->get<double>();
  waiting_[command.id] = {page, id, word, command, now, now};
  try {
    publish_(command);
  } catch (const std::exception& error) {
    waiting_.erase(command.id);
    return answer(id, word, false, error.what());
  }
  return nullptr;
}

void CommandDesk::take_ack(const ligature_msg::ack_t& ack) {
  const std::scoped_lock lock(mutex_);
  const auto found = waiting_.find(ack.id);
  if (found == waiting_.end()) return;
  const auto& [page, id, word, command, sent, repeated] = found->second;
  ready_.emplace(page, answer(id, word, ack.accepted != 0, ack.reason.substr(0, 200)));
  waiting_.erase(found);
}

std::multimap<std::uint64_t, json> CommandDesk::answers(Clock::time_point now) {
  const std::scoped_lock lock(mutex_);
  for (auto it = waiting_.begin(); it != waiting_.end();) {
    auto& w = it->second;
    if (const auto patience = answer_time(w.command.kind); now - w.sent >= patience) {
      const std::string time = std::to_string(patience.count());
      ready_.emplace(w.page, answer(w.id, w.word, false, "no answer within " + time + " s: is the firmware running?"));
      it = waiting_.erase(it);
      continue;
    }
    if (w.command.kind == ligature_msg::command_t::KIND_STOP && now - w.repeated >= kRepeatStopEvery) {
      w.repeated = now;
      try {
        publish_(w.command);
      } catch (const std::exception&) {  // said by the answer that does not come
      }
    }
    ++it;
  }
  return std::exchange(ready_, {});
}

}  // namespace ligature::host::view
