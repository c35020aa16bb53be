#include "sim_device/page/page_link.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <lcm/lcm-cpp.hpp>

#include "ligature_msg/hand_state_t.hpp"
#include "ligature_msg/hand_wish_t.hpp"
#include "protocol/lcm/fresh_id.hpp"
#include "protocol/lcm/quiet_stderr.hpp"

namespace ligature::sim {
namespace {

constexpr const char* kWishChannel = "LIGATURE_HAND_WISH";
constexpr const char* kStateChannel = "LIGATURE_HAND_STATE";
// wishes handled per call of look(); bounds its time if somebody floods the channel
constexpr int kMostWishesALook = 64;

/// Decodes a message of unknown origin: only the exact size of a hand_wish_t and plausible positions are accepted.
std::optional<ligature_msg::hand_wish_t> wish_of(const lcm::ReceiveBuffer& received) {
  ligature_msg::hand_wish_t wish{};
  const int size = wish.getEncodedSize();
  if (received.data_size != static_cast<unsigned>(size) || wish.decode(received.data, 0, size) != size)
    return std::nullopt;
  if (!std::ranges::all_of(wish.p_home_m, [](double x) { return std::abs(x) <= 10.0; })) return std::nullopt;
  return wish;
}

}  // namespace

PageLink::PageLink(const std::string& url, bool is_left, SteeredHand& hand)
    : hand_(hand), index_(is_left ? 0 : 1), holding_(lcm_tools::fresh_id) {
  const lcm_tools::QuietStderr one_line_is_enough;
  lcm_ = std::make_unique<lcm::LCM>(url);
  if (!lcm_->good() || lcm_->subscribeFunction(kWishChannel, &PageLink::receive, this) == nullptr)
    objection_ = "--lcm-url: cannot open '" + url +
                 "': wrong address or port, or no multicast route; remedy: run inside scripts/private-net";
}

PageLink::~PageLink() = default;

void PageLink::look(const Mechanics& mechanics, Time now) {
  now_ = now;
  t_s_ = mechanics.script_time_s();
  home_D_m_ = mechanics.body().plant.linkage.home_D_m();
  for (int i = 0; i < kMostWishesALook && lcm_->handleTimeout(0) > 0; ++i) {
  }
  if (now < tell_at_) return;
  tell_at_ = now + kStateEvery;
  holding_.look(now);
  tell(mechanics);
}

void PageLink::receive(const lcm::ReceiveBuffer* received, const std::string&, PageLink* link) {
  link->take(*received);
}

void PageLink::take(const lcm::ReceiveBuffer& received) {
  const auto wish = wish_of(received);
  if (!wish || wish->hand != index_) return;
  if (!holding_.accept({wish->session, wish->owner, wish->sequence, wish->leaves != 0}, now_)) return;
  const Vec3 p_D_m = home_D_m_ + Vec3(wish->p_home_m);
  hand_.wish(t_s_, p_D_m, wish->dead_man != 0 && wish->leaves == 0, wish->grip != 0);
}

void PageLink::tell(const Mechanics& mechanics) {
  const auto utime = std::chrono::system_clock::now().time_since_epoch();
  const Vec3 p_home_m = mechanics.touch().p_DT - home_D_m_;
  const auto buttons = mechanics.buttons();
  ligature_msg::hand_state_t state{};
  state.utime = std::chrono::duration_cast<std::chrono::microseconds>(utime).count();
  state.session = holding_.session();
  state.owner = holding_.owner();
  state.sequence = holding_.sequence();
  state.hand = index_;
  state.is_live = mechanics.has_started() ? 1 : 0;
  state.dead_man = (buttons & can::profile::kButtonDeadMan) != 0 ? 1 : 0;
  state.grip = (buttons & can::profile::kButtonGrip) != 0 ? 1 : 0;
  std::copy_n(p_home_m.data(), 3, state.p_home_m);
  lcm_->publish(kStateChannel, &state);  // a failure does not matter: the next message follows soon
}

}  // namespace ligature::sim
