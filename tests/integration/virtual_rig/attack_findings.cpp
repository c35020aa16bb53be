#include "tests/integration/virtual_rig/attack_findings.hpp"

#include <algorithm>
#include <initializer_list>
#include <string_view>

namespace ligature {
namespace {

using Index = std::size_t;
using Torques = std::array<std::int16_t, 3>;
const std::string kForeignRpdo = "a foreign RPDO, until its fault takes all torque";
const std::string kOutsideBox = "tip outside the device's workspace box";

/// Evaluates one hand in one run.
class Judge {
 public:
  Judge(const AttackPlan& plan, const lab::VirtualRig& rig, Index hand)
      : plan_(plan), rig_(rig), hand_(hand), tips_(rig.truth[hand].tips()) {}

  void judge(Findings& found) {
    for (Index k = 1; k < tips_.size(); ++k) {
      const double force_N = tips_[k].f_N.norm();
      const bool pushes = tips_[k].permille != Torques{};
      see(k, "force", force_N, kTrueForce_N, found.peak_N, [&] { return cause_of_force(k); });
      see(k, pushes ? "step" : "step to zero", tips_[k].step_N, kTrueStep_N, found.step_N,
          [&] { return pushes ? cause_of_step(k) : cause_of_end(k); });
      outside_ = pushes && !may_push(k) ? outside_ + 1 : 0;
      if (outside_ > 0) note(k, {"outside ARM and dead-man", cause_of_outside(k)}, outside_);
    }
    for (const auto& f : plan_.foreign) see_foreign(f);
    for (const auto& [exception, times] : here_) {
      Times& all = found.exceptions[exception];
      all.syncs += times.syncs;
      all.runs = 1;
      if (times.worst > all.worst)
        all.worst = times.worst, all.seed = plan_.seed, all.hand = hand_, all.tick = times.tick;
    }
  }

 private:
  /// Checks that a foreign frame of a kind that only a controller may send is reported as a fault in the next ticks,
  /// unless the bus is cut or full or the loop stalls.
  void see_foreign(const AttackPlan::Foreign& f) {
    const bool only_ours = f.what == "RPDO" || f.what == "SYNC" || f.what == "NMT" || f.what == "SDO write";
    const bool away = plan_.cut_at >= 0 && f.hand == 0 && f.from + kTicksToSee >= plan_.cut_at;
    const bool busy = std::ranges::any_of(plan_.foreign, [&](const auto& other) {
      return other.what == "flood" && other.hand == f.hand && f.from + kTicksToSee >= other.from &&
             f.from <= other.from + other.ticks + kTicksToSee;
    });
    const bool lost = may_be_lost(f) && f.ticks <= kTicksOfLoss;
    if (!only_ours || f.hand != static_cast<int>(hand_) || away || busy || lost) return;
    // A stalled loop reads no frames. So the deadline for the fault is extended by that part of the stall that lies
    // before the deadline.
    const bool stalls = plan_.stall_at <= f.from + kTicksToSee && plan_.stall_at + plan_.stall_ticks > f.from;
    const auto asleep = stalls ? plan_.stall_at + plan_.stall_ticks - std::max(plan_.stall_at, f.from) : 0;
    const auto last = static_cast<Index>(f.from + kTicksToSee + asleep + (may_be_lost(f) ? kTicksOfLoss : 0));
    if (const auto* r = record(last); r != nullptr && r->fault == 0)
      note(last, {"foreign frames are a fault", kUnexplained}, static_cast<double>(kTicksToSee));
  }
  /// Foreign RPDOs are process data, so they may be lost like ours.
  [[nodiscard]] bool may_be_lost(const AttackPlan::Foreign& f) const {
    return f.what == "RPDO" && plan_.frame_loss > 0.0;
  }
  template <class Cause>
  void see(Index k, const std::string& promise, double value, double limit, double& largest, Cause cause) {
    if (value <= limit) {
      largest = std::max(largest, value);
    } else {
      note(k, {promise, cause()}, value);
    }
  }
  void note(Index k, const Exception& exception, double value) {
    Times& times = here_[exception];
    ++times.syncs;
    if (value > times.worst) times.worst = value, times.tick = k;
  }

  [[nodiscard]] const rt::TickRecord* record(Index tick) const {
    return tick < rig_.records.size() ? &rig_.records[tick] : nullptr;
  }
  [[nodiscard]] bool is_sent(Index k, Index tick) const {
    const auto* r = record(tick);
    return r != nullptr && r->torque_permille[hand_] == tips_[k].permille;
  }
  /// Whether at SYNC k each joint makes a torque that the firmware has sent recently, or none.
  [[nodiscard]] bool is_ours(Index k) const {
    const Index longest = near_foreign(k, {"flood"}, kTicksOfFlood) ? kTicksOfFlood + kTicksOfFault : kTicksOfFault + 2;
    for (Index j = 0; j < 3; ++j) {
      bool ours = tips_[k].permille[j] == 0;
      for (Index back = 1; back <= longest && back <= k && !ours; ++back)
        if (const auto* r = record(k - back)) ours = r->torque_permille[hand_][j] == tips_[k].permille[j];
      if (!ours) return false;
    }
    return true;
  }
  /// Whether the joints' torques at SYNC k were all sent in the same tick.
  [[nodiscard]] bool is_whole(Index k) const {
    for (Index back = 1; back <= kTicksOfFault && back <= k; ++back)
      if (is_sent(k, k - back)) return true;
    return false;
  }
  /// Whether the torques that act at SYNC k - 1 and k were sent in consecutive ticks, so that the control law chose
  /// their step.
  [[nodiscard]] bool is_in_turn(Index k) const {
    for (Index back = 1; back <= kTicksOfFault && back < k; ++back)
      if (is_sent(k, k - back) && is_sent(k - 1, k - back - 1)) return true;
    return false;
  }
  /// Whether foreign frames of these kinds (none given: any) were on this hand's bus within the last `ago` ticks.
  [[nodiscard]] bool near_foreign(Index k, std::initializer_list<std::string_view> kinds, std::int64_t ago) const {
    return std::ranges::any_of(plan_.foreign, [&](const auto& f) {
      const auto tick = static_cast<std::int64_t>(k);
      const bool here = f.hand == static_cast<int>(hand_) && tick >= f.from && tick <= f.from + f.ticks + ago;
      return here && (kinds.size() == 0 || std::ranges::find(kinds, f.what) != kinds.end());
    });
  }
  /// Whether a foreign torque acts at SYNC k, so shortly after the first foreign frame that it cannot be removed yet.
  [[nodiscard]] bool is_strangers(Index k) const {
    return !is_ours(k) && std::ranges::any_of(plan_.foreign, [&](const auto& f) {
      const auto late = static_cast<std::int64_t>(k) - f.from;
      return f.hand == static_cast<int>(hand_) && f.what == "RPDO" && late >= 0 &&
             late <= kTicksOfStranger + (may_be_lost(f) ? kTicksOfLoss : 0);
    });
  }
  template <class Is>
  [[nodiscard]] bool any_in(Index k, int back, Is is) const {
    for (Index i = 0; i <= static_cast<Index>(back) && i <= k; ++i)
      if (const auto* r = record(k - i); r != nullptr && is(*r)) return true;
    return false;
  }
  [[nodiscard]] bool had_fault(Index k) const {
    return any_in(k, kTicksOfFault, [](const auto& r) { return r.fault != 0; });
  }
  [[nodiscard]] bool is_stop(Index tick) const {
    return std::ranges::any_of(plan_.orders, [tick](const auto& order) {
      return order.kind == rt::CommandKind::kStop && order.tick == static_cast<std::int64_t>(tick);
    });
  }
  /// Whether a force at SYNC k is legitimate: at some moment within the time that a force takes to fade, the rig was
  /// armed and without fault, and the dead-man was truly pressed.
  [[nodiscard]] bool may_push(Index k) const {
    for (Index i = 0; i <= static_cast<Index>(kTicksToEnd) && i <= k; ++i) {
      const auto* r = record(k - i);
      const bool ended = is_stop(k - i) || (r != nullptr && r->fault != 0);
      if (ended && i >= static_cast<Index>(kTicksOfFault)) return false;
      if (r != nullptr && r->armed && r->fault == 0 && tips_[k - i].dead_man) return true;
    }
    return false;
  }
  [[nodiscard]] std::string cause_of_force(Index k) const {
    if (is_strangers(k)) return kForeignRpdo;
    if (!tips_[k].in_workspace) return kOutsideBox;
    if (plan_.loses_frames() && is_ours(k) && !is_whole(k)) return "joints mix old and new torques (lost frames)";
    return kUnexplained;
  }
  [[nodiscard]] std::string cause_of_step(Index k) const {
    if (is_strangers(k) || is_strangers(k - 1)) return kForeignRpdo;
    if (!tips_[k].in_workspace || !tips_[k - 1].in_workspace) return kOutsideBox;
    if (!is_ours(k) || !is_ours(k - 1) || is_in_turn(k)) return kUnexplained;
    if (!tips_[k].drives_on || !tips_[k - 1].drives_on) return "one drive fell out, the others until the fault";
    if (near_foreign(k, {}, kTicksOfFault)) return "RPDOs late or taken early: foreign frames on the bus";
    if (plan_.loses_frames()) return "lost or late frames";
    return kUnexplained;
  }
  [[nodiscard]] std::string cause_of_end(Index k) const {
    if (had_fault(k)) return "a fault takes all force at once";
    if (!tips_[k].drives_on) return "the drives go off by themselves";
    for (Index i = 0; i <= static_cast<Index>(kTicksOfFault) && i <= k; ++i)
      if (is_stop(k - i)) return "`stop`";
    const int late = plan_.loses_frames() ? kTicksOfFault : 4;  // an RPDO with zero torque may be lost, too
    const auto let_go = [this](const auto& r) {
      return (r.limits[hand_] & rt::kPassivityLimit) != 0 && r.torque_permille[hand_] == Torques{};
    };
    if (any_in(k, late, let_go)) return "a hand let go by passivity";
    if (near_foreign(k, {}, kTicksOfFault)) return "foreign frames on the bus";
    return kUnexplained;
  }
  [[nodiscard]] std::string cause_of_outside(Index k) const {
    if (is_strangers(k)) return kForeignRpdo;
    if (near_foreign(k, {"flood"}, kTicksOfFlood) && outside_ <= kTicksOfFlood - kTicksOfFault)
      return "old torques in the interface's queue: the bus is flooded";
    if (near_foreign(k, {"joint message"}, kTicksToEnd))
      return "a forged joint message says that the dead-man is pressed";
    const auto& fault = plan_.faults[hand_];
    if (fault && fault->kind == scene::FaultKind::kButton) return "the buttons' sensor lies (fault 24 in 15 ticks)";
    return kUnexplained;
  }

  const AttackPlan& plan_;
  const lab::VirtualRig& rig_;
  Index hand_;
  const std::vector<lab::TrueTip>& tips_;
  int outside_ = 0;
  std::map<Exception, Times> here_;
};

}  // namespace

Findings judge(const AttackPlan& plan, const lab::VirtualRig& rig) {
  Findings found;
  found.runs = 1;
  for (Index hand = 0; hand < 2; ++hand) Judge(plan, rig, hand).judge(found);
  double most_N = 0.0;
  for (const auto& watch : rig.truth)
    for (const auto& tip : watch.tips()) most_N = std::max(most_N, tip.f_N.norm());
  found.pushed = most_N > 0.5;
  for (const auto& f : plan.faults)
    found.lying |= f && (f->kind == scene::FaultKind::kFreeze || f->kind == scene::FaultKind::kReverse ||
                         f->kind == scene::FaultKind::kJump);
  for (const auto& r : rig.records) {
    if (r.fault == 0) continue;
    found.faulted = 1;
    found.faults[r.fault] = 1;
  }
  return found;
}

void Findings::add(const Findings& other) {
  runs += other.runs, refused += other.refused, pushed += other.pushed, faulted += other.faulted, lying += other.lying;
  peak_N = std::max(peak_N, other.peak_N);
  step_N = std::max(step_N, other.step_N);
  for (const auto& [number, times] : other.faults) faults[number] += times;
  for (const auto& [exception, times] : other.exceptions) {
    Times& all = exceptions[exception];
    all.runs += times.runs;
    all.syncs += times.syncs;
    if (times.worst > all.worst)
      all.worst = times.worst, all.seed = times.seed, all.hand = times.hand, all.tick = times.tick;
  }
}

}  // namespace ligature
