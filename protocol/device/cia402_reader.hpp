#pragma once
// Reads table [cia402] of a device record. Private to the reader of device records.

#include <utility>

#include "protocol/device/device.hpp"
#include "protocol/scene/toml_text.hpp"

namespace ligature::device {

inline constexpr std::pair<const char*, Source> kSourceNames[] = {
    {"assumed", Source::kAssumed}, {"datasheet", Source::kDatasheet}, {"measured", Source::kMeasured}};

void read_cia402(scene::StrictTable& table, Cia402Profile& out);

}  // namespace ligature::device
