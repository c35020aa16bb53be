#pragma once
// What a measurement of a thread determines.

#include <array>
#include <cstddef>

namespace ligature::fit {

inline constexpr double kGravity_m_per_s2 = 9.81;

/// Index of a parameter in Parameters. All are positive.
enum Parameter : std::size_t { kDensity, kNatural, kEA, kFriction, kEI, kBendDamping, kDrag, kParameters };

/// Values by Parameter.
using Parameters = std::array<double, kParameters>;

struct Told {
  const char* name;  ///< key of a scene, or a name
  const char* unit;
  const char* table;  ///< table of the scene that takes the key; empty: no key
};
inline constexpr std::array<Told, kParameters> kTold{{{"density_kg_per_m", "kg/m", "suture"},
                                                      {"unloaded length", "m", ""},
                                                      {"EA_N", "N", "suture"},
                                                      {"friction", "", "contact"},
                                                      {"EI_N_m2", "N m2", "suture"},
                                                      {"damping_s", "s", "suture"},
                                                      {"air_drag_per_s", "1/s", "suture"}}};

}  // namespace ligature::fit
