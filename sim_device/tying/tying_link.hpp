#pragma once
// Connects a hand that ties to LCM: a separate thread receives the messages and plans; the device's loop fetches the
// planned positions.

#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "sim_device/link.hpp"
#include "sim_device/tying/tying_plan.hpp"

namespace lcm {
class LCM;
struct ReceiveBuffer;
}  // namespace lcm

namespace ligature::sim {

inline constexpr const char* kTieWord = "tie:";

/// The operator for the words `tie:KNOT[:SEED]` or `untie[:SEED]` (default seed 1), or one line that says what is
/// wrong.
[[nodiscard]] std::variant<KnotTier, std::string> tier_of(const std::string& word, const scene::Scene& scene);

class TyingLink final : public Link {
 public:
  /// @param hand must outlive this. Signals blocked at this call stay blocked in the threads that it starts.
  TyingLink(const std::string& url, TyingPlan plan, PlayedHand& hand);
  ~TyingLink() override;

  /// Why the network could not be opened; empty if it is open.
  [[nodiscard]] const std::string& objection() const noexcept { return objection_; }

  void look(const Mechanics& mechanics, Time now) override;
  [[nodiscard]] std::vector<std::string> news() override { return std::move(told_); }

 private:
  static void receive(const lcm::ReceiveBuffer* received, const std::string& channel, TyingLink* link);
  void hear(const std::stop_token& stop);
  void hand_over();

  PlayedHand& hand_;
  std::unique_ptr<lcm::LCM> lcm_;
  std::string objection_;

  // Used only by the planning thread.
  TyingPlan plan_;
  std::vector<WishedTick> planned_;
  std::int64_t told_lost_ = 0;
  bool told_done_ = false;

  // Used only by the device's loop.
  std::vector<WishedTick> fresh_;
  std::vector<std::string> told_;

  // From the planning thread to the device's loop.
  std::mutex mutex_;
  std::vector<WishedTick> wishes_;  // guarded by mutex_
  std::vector<std::string> news_;   // guarded by mutex_

  std::jthread thread_;  // last member: starts when the others exist, and is joined before they are destroyed
};

}  // namespace ligature::sim
