#pragma once
// What ends the torque of the drives of a device record, and how soon: many trials from one run.

#include <cstdint>
#include <optional>
#include <vector>

#include "tests/integration/virtual_rig/shelf_rig.hpp"
#include "tests/support/process_copy.hpp"

namespace ligature {

enum class Ends : std::uint8_t {
  kSilence,  ///< the firmware falls silent, as after SIGKILL: no frame of it gets to the drives any more
  kRelease,  ///< a hand releases the dead-man
  kFault     ///< a drive's power stage fails
};

struct Trial {
  Ends ends = Ends::kSilence;
  std::int64_t from = 0;  ///< period; it happens in the first one from here on in which torque acts
  std::size_t hand = 0;   ///< the one whose torque acts, and that releases; or the one of the drive that fails
  std::size_t drive = 0;  ///< the one that fails
};

/// The torque after it. Tick n ends n ms after it happened; at a release only the torque of the hand counts.
struct Outcome {
  bool was_in_force = false;
  int last = 0;               ///< last tick at whose end a drive made torque
  int last_commanded = 0;     ///< the same of drives that still follow their last command
  bool stays = true;          ///< every drive of the rig made the same torque all the time
  int pushed = 0;             ///< ticks, after the watchdog's time, in which a torque drove a joint on
  double most_left_Nm = 0.0;  ///< largest torque after the watchdog's time
  std::int64_t trips = 0;     ///< of the drives' watchdogs
  int fault = 0;
};

/// Two hands that pull at the thread between them, harder and less hard in turn, from the second second on. Each trial
/// happens in a copy of the run.
class MatrixRig : public ShelfRig {
 public:
  /// @param watchdog_ms  after this and two ticks more the drives should have acted by themselves
  MatrixRig(const std::string& record, const device::Device& device, int watchdog_ms);
  /// @return the outcome of each trial, nothing if its torque never acted. @throws std::runtime_error if the rig does
  /// not start.
  std::vector<std::optional<Outcome>> run(const std::vector<Trial>& trials, std::int64_t ticks, int watched_ticks);

 private:
  using Torques = std::array<std::array<double, 3>, 2>;
  [[nodiscard]] Torques torques_Nm() const;
  [[nodiscard]] std::array<sim::Vec3, 2> speeds() const;
  [[nodiscard]] bool acts(const Trial& trial) const;
  [[nodiscard]] bool has_commanded_torque();
  void begin(const Trial& trial);
  void watch();
  void look_for_pushes();

  int watchdog_ms_, watched_ticks_ = 0;
  test::ProcessCopy<Outcome> copy_;
  // Of the trial of a copy
  Trial trial_;
  Outcome outcome_;
  Torques at_first_Nm_{};
  std::array<sim::Vec3, 2> speeds_before_;
  std::int64_t trips_before_ = 0;
  int tick_ = 0;
};

}  // namespace ligature
