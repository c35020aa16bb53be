#pragma once
#include <array>
#include <vector>

#include "host/knot/recognise.hpp"
#include "ligature_msg/thread_t.hpp"

namespace ligature::host {

/// The thread's nodes, m, in the form that the knot functions take.
[[nodiscard]] std::vector<std::array<double, 3>> points_of(const ligature_msg::thread_t& thread);

/// Names the knot in a recorded thread, which is open.
[[nodiscard]] knot::KnotResult name_knot(const ligature_msg::thread_t& thread);

}  // namespace ligature::host
