#pragma once
// Who moves the hand of this run: a script, a person at a page, or nobody; and what besides moves it.

#include <memory>
#include <string>
#include <variant>

#include "sim_device/intention.hpp"
#include "sim_device/options.hpp"
#include "sim_device/page/page_link.hpp"

namespace ligature::sim {

struct Mover {
  std::unique_ptr<Intention> will;
  std::unique_ptr<PageLink> page;  ///< tells the will what a page wishes; null where none does
};

/// @return one line that says why not, for what cannot be read, reached or heard.
[[nodiscard]] std::variant<Mover, std::string> mover_of(const Options& options, const Linkage& linkage);

}  // namespace ligature::sim
