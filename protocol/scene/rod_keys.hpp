#pragma once
// Private to scene_file.cpp: keys of the rod model, and presets of suture materials.

#include <string>

#include "protocol/scene/strict_table.hpp"

namespace ligature::scene {

/// A commercial suture: those of its properties that are known (tests/reference/08_sutures.json).
struct RodPreset {
  const char* name;
  double diameter_m;  ///< middle of the range allowed for this suture size (US Pharmacopeia)
  double density_kg_per_m3;
  double modulus_Pa;
  double bend_share;  ///< EI / EI of a solid rod: 1 for a monofilament, less for a braid
};

/// Diameters: middle of the range of the metric size. Densities: Morton & Hearle, Physical Properties of Textile
/// Fibres, table 5.1. Moduli: nylon 6.6 fibre of medium tenacity, ibid. table 13.2; silk and rapid polyglactin sutures,
/// 3-0: Naleway et al., J. Biomed. Mater. Res. B 103 (2015) 735, abstract. Assumed without a source: a nylon suture is
/// as stiff as the fibre; other sizes of a braid are as 3-0; polypropylene's modulus; polyglactin's density; a braid is
/// as dense as its fibres (no packing fraction); bend_share of braids; Poisson's ratio 0.4 in GJ. Friction is no
/// suture property here; scenes set it.
inline constexpr RodPreset kRodPresets[] = {
    {"nylon-2-0", 0.325e-3, 1140.0, 3.42e9, 1.0},       {"nylon-3-0", 0.225e-3, 1140.0, 3.42e9, 1.0},
    {"nylon-4-0", 0.175e-3, 1140.0, 3.42e9, 1.0},       {"nylon-5-0", 0.125e-3, 1140.0, 3.42e9, 1.0},
    {"polypropylene-2-0", 0.325e-3, 910.0, 3.0e9, 1.0}, {"polypropylene-3-0", 0.225e-3, 910.0, 3.0e9, 1.0},
    {"polypropylene-4-0", 0.175e-3, 910.0, 3.0e9, 1.0}, {"polypropylene-5-0", 0.125e-3, 910.0, 3.0e9, 1.0},
    {"silk-2-0", 0.325e-3, 1340.0, 8.70e9, 0.1},        {"silk-3-0", 0.225e-3, 1340.0, 8.70e9, 0.1},
    {"silk-4-0", 0.175e-3, 1340.0, 8.70e9, 0.1},        {"silk-5-0", 0.125e-3, 1340.0, 8.70e9, 0.1},
    {"polyglactin-2-0", 0.325e-3, 1400.0, 9.32e9, 0.1}, {"polyglactin-3-0", 0.225e-3, 1400.0, 9.32e9, 0.1},
    {"polyglactin-4-0", 0.175e-3, 1400.0, 9.32e9, 0.1}, {"polyglactin-5-0", 0.125e-3, 1400.0, 9.32e9, 0.1}};

/// Reads the rod's keys of [suture]: `preset` first, then keys that override its values.
/// @param length_m of the thread; no region of the stiffness profile may end beyond it
/// @param radius_m set by a preset; a `radius_m` in the file is read later and replaces it
void read_rod(StrictTable& t, double length_m, RodParameters& rod, double& radius_m);

/// Reads world.pegs.
void read_pegs(StrictTable& t, World& world);

}  // namespace ligature::scene
