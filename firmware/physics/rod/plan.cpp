#include "firmware/physics/rod/plan.hpp"

#include <algorithm>

namespace ligature::physics::rod {

Plan plan(const Plan& last, const TickReport& report, const Situation& now, const Numerics& numerics) noexcept {
  const bool fast = numerics.is_fast(now.hand_d);
  // A thread flies when it was just released, or when a node moves by more than a diameter in a substep
  const bool flies = now.released || now.node_d > numerics.max_substeps;
  Plan next;
  next.budget = numerics.budget(now.nodes, now.hand_d);
  const auto budget = static_cast<double>(numerics.budget(now.nodes, 0.0));
  const bool labours = static_cast<double>(report.work) > tuning.labours * budget || report.cut_at >= 0;
  next.leniency = report.cut_short > 0 ? std::min(tuning.most_leniency, tuning.leniency_up * last.leniency)
                                       : std::max(1.0, tuning.leniency_down * last.leniency);
  next.pace_m_per_s = 0.5 * now.apart_m_per_s;
  next.substeps = fast || flies ? numerics.max_substeps
                  : now.waits   ? report.substeps
                  : labours     ? std::min(numerics.substeps, std::max(tuning.fewest_substeps, numerics.substeps / 2))
                                : numerics.substeps;
  next.new_matrix = (fast && !now.waits) || next.substeps != report.substeps;
  return next;
}

}  // namespace ligature::physics::rod
