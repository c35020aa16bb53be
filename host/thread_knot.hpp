#pragma once
#include "host/knot/recognise.hpp"
#include "ligature_msg/thread_t.hpp"

namespace ligature::host {

/// The knot in a recorded thread, which is open.
[[nodiscard]] knot::KnotResult name_knot(const ligature_msg::thread_t& thread);

}  // namespace ligature::host
