#pragma once
#include <string>

#include "host/view/server.hpp"

namespace ligature::host::view {

struct ViewOptions {
  ServerOptions server;
  std::string token_file;
  std::string lcm_url;
  std::string recordings = ".";  // folder for what the page records
};

/// Shows the live rig until a signal comes. @throws BadInput, RunFailed.
void view_live(const ViewOptions& options);

/// The rights that follow from where a server listens: on this machine alone the page carries a fresh token; elsewhere
/// commands need the token of the file, and without a file there are none.
[[nodiscard]] Access access_for(const ServerOptions& server, const std::string& token_file);

/// The address to open, said on standard output.
void announce(const Server& server, const ServerOptions& options, const Access& access);

}  // namespace ligature::host::view
