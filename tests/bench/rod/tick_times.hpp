#pragma once
// Cost of ticks without the machine's disturbances: a deterministic pull is repeated, and each tick counts with its
// fastest run.

#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "firmware/physics/simulation.hpp"

namespace ligature::bench {

[[nodiscard]] inline double quantile(std::vector<double> v, double q) {
  std::sort(v.begin(), v.end());
  return v.empty() ? 0.0 : v[std::min(v.size() - 1, static_cast<std::size_t>(q * static_cast<double>(v.size())))];
}

/// Disturbances of the calling thread so far: page faults, involuntary context switches, and the CPU time stolen by the
/// hypervisor from all cores, in counts of 10 ms.
struct Disturbances {
  long faults = 0, switches = 0, steals = 0;

  [[nodiscard]] static Disturbances now() {
    rusage used{};
    getrusage(RUSAGE_THREAD, &used);
    std::ifstream stat("/proc/stat");
    std::string cpu;
    long user = 0, nice = 0, system = 0, idle = 0, disk = 0, irq = 0, softirq = 0, steals = 0;
    stat >> cpu >> user >> nice >> system >> idle >> disk >> irq >> softirq >> steals;
    return {used.ru_minflt + used.ru_majflt, used.ru_nivcsw, steals};
  }
  [[nodiscard]] Disturbances since(const Disturbances& before) const {
    return {faults - before.faults, switches - before.switches, steals - before.steals};
  }
};

/// One tick: its time, and what it computed, which is equal in every repetition.
struct Tick {
  double us = 0.0;
  long work = 0;            ///< spent on contact (rod/work.hpp), instructions
  std::uint64_t print = 0;  ///< fingerprint of all nodes and of both hands' forces
  Disturbances met{};

  [[nodiscard]] bool did_as(const Tick& other) const { return work == other.work && print == other.print; }
};

/// FNV-1a hash over the 64-bit words of the vectors' components.
[[nodiscard]] inline std::uint64_t fingerprint(std::span<const physics::Vec3> vectors, std::uint64_t hash) {
  for (const auto& v : vectors) {
    for (int k = 0; k < 3; ++k) hash = (hash ^ __builtin_bit_cast(std::uint64_t, v[k])) * 0x100000001b3U;
  }
  return hash;
}

/// Repetitions of one pull, compared tick by tick.
class Repeated {
 public:
  /// @return the first tick whose computation differs from the first run's, if any.
  [[nodiscard]] std::optional<std::size_t> add(std::vector<Tick> run) {
    runs_.push_back(std::move(run));
    const auto &first = runs_.front(), &last = runs_.back();
    const std::size_t both = std::min(first.size(), last.size());
    for (std::size_t k = 0; k < both; ++k) {
      if (!first[k].did_as(last[k])) return k;
    }
    return first.size() == last.size() ? std::nullopt : std::optional(both);
  }

  [[nodiscard]] std::size_t runs() const { return runs_.size(); }
  [[nodiscard]] const std::vector<Tick>& first() const { return runs_.front(); }
  /// For each tick the shortest time of all runs, us.
  [[nodiscard]] std::vector<double> least_us() const {
    std::vector<double> least(first().size(), 1e300);
    for (const auto& run : runs_) {
      for (std::size_t k = 0; k < std::min(run.size(), least.size()); ++k) least[k] = std::min(least[k], run[k].us);
    }
    return least;
  }

  /// Writes every tick of every run as CSV, to find the cause of long ticks.
  void write(std::ostream& out, const std::string& pull) const {
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      for (std::size_t k = 0; k < runs_[r].size(); ++k) {
        const Tick& t = runs_[r][k];
        out << pull << ',' << r << ',' << k << ',' << t.us << ',' << t.work << ',' << t.met.faults << ','
            << t.met.switches << ',' << t.met.steals << '\n';
      }
    }
  }

 private:
  std::vector<std::vector<Tick>> runs_;
};

}  // namespace ligature::bench
