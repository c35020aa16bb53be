#include "sim_device/tying/tying_link.hpp"

#include <charconv>
#include <lcm/lcm-cpp.hpp>
#include <limits>
#include <span>
#include <utility>

#include "protocol/lcm/array_fits.hpp"
#include "protocol/lcm/quiet_stderr.hpp"

namespace ligature::sim {
namespace {

constexpr const char* kThreadChannel = "LIGATURE_THREAD";
constexpr const char* kTicksChannel = "LIGATURE_TICKS";
constexpr int kMostWaiting = 500;  // messages; some 4 s of both channels
constexpr int kLongestWait_ms = 50;

/// @pre the array lengths in the message were checked.
template <class Message>
std::optional<Message> decoded(std::span<const std::byte> bytes) {
  Message message{};
  const auto size = static_cast<int>(bytes.size());
  if (message.decode(bytes.data(), 0, size) != size) return std::nullopt;
  return message;
}

}  // namespace

std::variant<KnotTier, std::string> tier_of(const std::string& word, const scene::Scene& scene) {
  const std::string words = word.starts_with(kTieWord) ? word.substr(std::string_view(kTieWord).size()) : word;
  const auto colon = words.find(':');
  const std::string knot = words.substr(0, colon);
  std::uint32_t seed = 1;
  if (colon != std::string::npos) {
    const std::string digits = words.substr(colon + 1);
    const char* const end = digits.data() + digits.size();
    const auto read = std::from_chars(digits.data(), end, seed);
    if (read.ec != std::errc() || read.ptr != end)
      return "seed: found \"" + std::string(digits) + "\", allowed 0 .. " +
             std::to_string(std::numeric_limits<std::uint32_t>::max());
  }
  if (word.starts_with(kTieWord) && knot == kUntie.name)
    return "knot: found \"untie\", allowed " + knot_names() + "; or the word untie alone";
  return KnotTier::make(scene, knot, seed);
}

TyingLink::TyingLink(const std::string& url, TyingPlan plan, PlayedHand& hand) : hand_(hand), plan_(std::move(plan)) {
  {
    const lcm_tools::QuietStderr one_line_is_enough;
    lcm_ = std::make_unique<lcm::LCM>(url);
    for (const char* channel : {kThreadChannel, kTicksChannel}) {
      auto* subscription = lcm_->good() ? lcm_->subscribeFunction(channel, &TyingLink::receive, this) : nullptr;
      if (subscription == nullptr) {
        objection_ = "--lcm-url: cannot open '" + url +
                     "': wrong address or port, or no multicast route; remedy: run inside scripts/private-net";
        return;
      }
      subscription->setQueueCapacity(kMostWaiting);
    }
  }
  thread_ = std::jthread([this](const std::stop_token& stop) { hear(stop); });
}

TyingLink::~TyingLink() = default;

void TyingLink::look(const Mechanics& mechanics, Time) {
  fresh_.clear();
  if (const std::unique_lock lock(mutex_, std::try_to_lock); lock) {
    fresh_.swap(wishes_);
    told_.swap(news_);
  }
  hand_.look(mechanics.script_time_s(), mechanics.started_at(), fresh_);
}

void TyingLink::hear(const std::stop_token& stop) {
  while (!stop.stop_requested() && lcm_->handleTimeout(kLongestWait_ms) >= 0) {
  }
}

/// Any process may have sent the message. Array lengths are checked here, numbers in TyingPlan.
void TyingLink::receive(const lcm::ReceiveBuffer* received, const std::string& channel, TyingLink* link) {
  static const auto tick_size = static_cast<std::size_t>(ligature_msg::tick_t{}._getEncodedSizeNoHash());
  const std::span bytes(static_cast<const std::byte*>(received->data), received->data_size);
  if (channel == kThreadChannel) {
    if (!lcm_tools::thread_fits(bytes)) return;
    if (const auto thread = decoded<ligature_msg::thread_t>(bytes)) link->plan_.take(*thread);
  } else {
    if (!lcm_tools::tick_batch_fits(bytes, tick_size)) return;
    if (const auto batch = decoded<ligature_msg::tick_batch_t>(bytes)) link->plan_.take(*batch, link->planned_);
    link->hand_over();
  }
}

void TyingLink::hand_over() {
  const std::lock_guard lock(mutex_);
  wishes_.insert(wishes_.end(), planned_.begin(), planned_.end());
  planned_.clear();
  if (const auto lost = plan_.lost_ticks(); lost != std::exchange(told_lost_, lost))
    news_.push_back(std::to_string(lost) + " ticks lost on the way in all: the hands may no longer plan the same");
  if (!plan_.tier().is_done() || std::exchange(told_done_, true)) return;
  std::string line = std::string(plan_.tier().knot().name) + ": the plan is done";
  for (const std::string& move : plan_.tier().missed()) line += ", gave up: " + move;
  news_.push_back(line);
}

}  // namespace ligature::sim
