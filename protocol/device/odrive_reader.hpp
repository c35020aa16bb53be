#pragma once
// Reads table [odrive] of a device record. Private to the reader of device records.

#include "protocol/device/odrive_profile.hpp"
#include "protocol/scene/toml_text.hpp"

namespace ligature::device {

void read_odrive(scene::StrictTable& table, OdriveProfile& out);

}  // namespace ligature::device
