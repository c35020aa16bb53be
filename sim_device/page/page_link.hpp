#pragma once
// LCM connection of a steered hand: receives targets, publishes the hand's state and owner.

#include <memory>
#include <string>

#include "sim_device/link.hpp"
#include "sim_device/page/holding.hpp"
#include "sim_device/page/steered_hand.hpp"

namespace lcm {
class LCM;
struct ReceiveBuffer;
}  // namespace lcm

namespace ligature::sim {

class PageLink final : public Link {
 public:
  static constexpr Time kStateEvery = std::chrono::milliseconds(50);

  /// @param hand must outlive this. Signals blocked at this call stay blocked in LCM's thread.
  PageLink(const std::string& url, bool is_left, SteeredHand& hand);
  ~PageLink() override;

  /// Why the network could not be opened; empty if it is open.
  [[nodiscard]] const std::string& objection() const noexcept { return objection_; }

  /// Applies the targets that have arrived, and publishes the state if it is due. Never waits.
  void look(const Mechanics& mechanics, Time now) override;

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
  double t_s_ = 0.0;  // time of the present look()
  Time now_{}, tell_at_{};
};

}  // namespace ligature::sim
