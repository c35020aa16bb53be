#pragma once
// Electronic data sheet (CiA 306) of one drive, written from its object table.

#include <string>

#include "protocol/can/cob_id.hpp"

namespace ligature::can {

/// Text of the EDS of the drive with this node id (the elbow's differs: its TPDO carries buttons).
[[nodiscard]] std::string eds_text(NodeId node);

}  // namespace ligature::can
