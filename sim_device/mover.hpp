#pragma once
// Creates what moves the hand in this run: a script, a person at a page, or nothing; plus tremor or an adversary if
// asked.

#include <memory>
#include <string>
#include <variant>

#include "sim_device/intention.hpp"
#include "sim_device/options.hpp"
#include "sim_device/page/page_link.hpp"

namespace ligature::sim {

struct Mover {
  std::unique_ptr<Intention> will;
  std::unique_ptr<PageLink> page;  ///< passes a page's targets to `will`; null without a page
};

/// @return the mover, or one line that says why not: a file that cannot be read, a key out of reach, no network.
[[nodiscard]] std::variant<Mover, std::string> mover_of(const Options& options, const Linkage& linkage);

}  // namespace ligature::sim
