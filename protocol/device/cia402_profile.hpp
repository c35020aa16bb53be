#pragma once
// What a CiA 402 drive offers, as far as the controller needs it: table [cia402] of a device record. A record without
// this table describes our own drive (docs/wire.md). docs/drives.md explains the choices.

#include <cstdint>
#include <vector>

namespace ligature::device {

/// Index and sub-index of an entry of the drive's object dictionary; index 0: the drive has no such entry.
struct ObjectAddress {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  [[nodiscard]] constexpr bool is_there() const noexcept { return index != 0; }
  friend constexpr bool operator==(const ObjectAddress&, const ObjectAddress&) = default;
};

struct ObjectWrite {
  ObjectAddress object;
  std::uint32_t value = 0;
  int bytes = 1;
};

/// What makes the drive remove its torque when the controller falls silent.
enum class DriveWatchdog : std::uint8_t {
  kRpdoTimer,  ///< no torque message for some time (object 0x1400:05), and no heartbeat (0x1016:01)
  kHeartbeat,  ///< no heartbeat of the controller for some time (0x1016:01)
  kNone,
};

/// Contents of the buttons' object.
enum class ButtonsWord : std::uint8_t {
  kLigature,  ///< the word of docs/wire.md, with a sign of life; it takes the place of the torque in TPDO 1
  kInputs,    ///< plain digital inputs, in a TPDO 2 of their own
};

struct ButtonsPlace {
  ButtonsWord word = ButtonsWord::kLigature;
  int node = 3;
  ObjectAddress object{0x2100, 1};
  int bits = 16;
  int grip_bit = 0, dead_man_bit = 1, clutch_bit = 2;  ///< -1: there is no such button

  [[nodiscard]] constexpr bool are_inputs() const noexcept { return word == ButtonsWord::kInputs; }
};

struct Cia402Profile {
  ObjectAddress counts{0x608F, 1};  ///< encoder resolution, compared with the record at start-up
  int counts_unit = 1;              ///< encoder counts in one unit of that object
  ObjectAddress rated_torque{0x6076, 0};
  double rated_torque_unit_Nm = 1e-3;
  bool at_motor = false;  ///< both objects concern the motor's shaft, before the gear; false: the joint
  ObjectAddress max_torque{0x6072, 0};
  int pdos = 1;  ///< PDOs of the drive in each direction; start-up switches off those that are not used

  ButtonsPlace buttons{};

  DriveWatchdog watchdog = DriveWatchdog::kRpdoTimer;
  int watchdog_ms = 1;  ///< shortest time that the watchdog is set to; `--watchdog-ms` may be longer

  std::vector<ObjectAddress> optional;  ///< entries that start-up may find missing
  std::vector<ObjectWrite> writes;      ///< written at start-up before the PDOs are set up
};

}  // namespace ligature::device
