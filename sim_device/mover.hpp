#pragma once
// Creates what moves the hand in this run: a script, a person at a page, an operator that sees the thread, or nothing;
// on request with tremor, or as an adversary of stability.

#include <memory>
#include <string>
#include <variant>

#include "sim_device/intention.hpp"
#include "sim_device/link.hpp"
#include "sim_device/options.hpp"

namespace ligature::sim {

struct Mover {
  std::unique_ptr<Intention> will;
  std::unique_ptr<Link> link;  ///< passes received messages to `will`; null if `will` needs none
};

/// @return the mover, or one line that says why not: a file that cannot be read, a key out of reach, no network.
[[nodiscard]] std::variant<Mover, std::string> mover_of(const Options& options, const Linkage& linkage);

}  // namespace ligature::sim
