#pragma once
// Electronic data sheet (EDS, CiA 306) of one drive, generated from its object table.

#include <string>

#include "protocol/can/cob_id.hpp"

namespace ligature::can {

/// EDS text of the drive with this node id. The elbow's differs: its TPDO has buttons.
[[nodiscard]] std::string eds_text(NodeId node);

}  // namespace ligature::can
