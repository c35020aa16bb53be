#pragma once
// Between LCM and a steered hand: wishes in, where it is and who has it out.

#include <memory>
#include <string>

#include "sim_device/mechanics.hpp"
#include "sim_device/page/holding.hpp"
#include "sim_device/page/steered_hand.hpp"

namespace lcm {
class LCM;
struct ReceiveBuffer;
}  // namespace lcm

namespace ligature::sim {

class PageLink {
 public:
  static constexpr Time kStateEvery = std::chrono::milliseconds(50);

  /// @param hand lives longer. Signals that are blocked now never come to the library's thread.
  PageLink(const std::string& url, bool is_left, SteeredHand& hand);
  ~PageLink();
  PageLink(const PageLink&) = delete;
  PageLink& operator=(const PageLink&) = delete;

  /// Why there is no network; empty when there is one.
  [[nodiscard]] const std::string& objection() const noexcept { return objection_; }

  /// Takes the wishes that have come, and tells the state when it is due. Never waits.
  void look(const Mechanics& mechanics, Time now);

 private:
  static void receive(const lcm::ReceiveBuffer* received, const std::string& channel, PageLink* link);
  void take(const lcm::ReceiveBuffer& received);
  void tell(const Mechanics& mechanics);

  SteeredHand& hand_;
  std::int8_t index_;
  Holding holding_;
  std::unique_ptr<lcm::LCM> lcm_;
  std::string objection_;
  Vec3 home_D_m_ = Vec3::Zero();
  double t_s_ = 0.0;  // of the look that goes on
  Time now_{}, tell_at_{};
};

}  // namespace ligature::sim
