#pragma once
// The two inequalities of docs/passivity.md for one hand of a virtual rig, from the true torques and motion of its
// device: also while frames are lost, where the energy account alone guarantees less.

#include <cstdint>
#include <vector>

#include "firmware/rt/tick_record.hpp"
#include "protocol/device/device.hpp"
#include "sim_device/hand_device.hpp"

namespace ligature::lab {

/// Checks after each period, with the terms of docs/passivity.md:
///   account at the sample of the last decision - energy given since >= -1 uJ - counted - beyond
///   work + energy lent to this hand >= -1 uJ - hidden - unseen - counted - beyond
/// `beyond` is its upper bound: the force that acts, times the largest motion that the acceleration allows. The
/// acceleration is the bound of the device record, or that of the hand where it is larger. The page takes the map from
/// torques to tip force as constant since the sample; what the arm's motion changes of the energy is allowed as well.
class PortBound {
 public:
  PortBound(const device::Device& device, std::size_t hand);

  /// Call once a period, before the SYNC that ends it. @param record of the tick that began the period
  /// @param received_J energy in the account that does not come from this hand (HandState::received_J)
  void look(const sim::HandDevice& device, const rt::TickRecord& record, double received_J);

  /// Smallest difference between the two sides of the inequalities so far, J; negative: one of them did not hold.
  [[nodiscard]] double least_margin_J() const noexcept { return least_margin_J_; }
  [[nodiscard]] double lowest_work_J() const noexcept { return lowest_work_J_; }  ///< work + energy lent
  /// What the second inequality allowed when the work was lowest: -1 uJ less the four terms
  [[nodiscard]] double its_bound_J() const noexcept { return its_bound_J_; }
  [[nodiscard]] double most_beyond_J() const noexcept { return most_beyond_J_; }

 private:
  struct Period {
    sim::Vec3 made_Nm = sim::Vec3::Zero(), f_N = sim::Vec3::Zero(), moved_m = sim::Vec3::Zero();
    sim::Mat3 tip_N_per_Nm = sim::Mat3::Identity();  ///< at the period's end
    double given_J = 0.0, account_J = 0.0, reserved_count_m = 0.0;
    std::int64_t sample = 0;  ///< SYNC of the latest sample known in the tick
    bool decides = false;     ///< the tick sent a force, or its account lent energy
    bool heard = false;       ///< every joint makes the torque that was sent last
  };
  [[nodiscard]] const Period& at(std::int64_t p) const { return periods_[static_cast<std::size_t>(p)]; }
  void book(const Period& before, const Period& now);
  void check(double work_J);
  [[nodiscard]] double unseen_J(std::int64_t from, std::int64_t to) const;
  [[nodiscard]] double hasty_m(std::int64_t from, std::int64_t to) const;
  [[nodiscard]] double beyond_J(std::int64_t decided, std::int64_t p) const;

  std::size_t hand_;
  double reach_m_, count_rad_;
  sim::Linkage linkage_;
  std::vector<Period> periods_;
  std::array<std::int16_t, 3> sent_permille_{};
  sim::Vec3 p_m_ = sim::Vec3::Zero();
  double given_J_ = 0.0, received_J_ = 0.0, hidden_J_ = 0.0, unseen_J_ = 0.0;
  double least_margin_J_ = 1e9, lowest_work_J_ = 0.0, its_bound_J_ = 0.0, most_beyond_J_ = 0.0;
};

}  // namespace ligature::lab
