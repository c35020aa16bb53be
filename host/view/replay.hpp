#pragma once
#include <string>

#include "host/view/server.hpp"

namespace ligature::host::view {

struct ReplayOptions {
  std::string log;
  std::string compare;  // second recording to compare with; empty: none
  std::string align = "start";
  ServerOptions server;
};

/// Serves a recording until a signal comes. @throws BadInput, RunFailed.
void replay(const ReplayOptions& options);

}  // namespace ligature::host::view
