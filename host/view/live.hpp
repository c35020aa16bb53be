#pragma once
#include <string>

#include "host/view/server.hpp"

namespace ligature::host::view {

struct ViewOptions {
  ServerOptions server;
  std::string token_file;
  std::string lcm_url;
  std::string recordings = ".";  // folder for recordings that the page starts
};

/// Serves the live view until a signal comes. @throws BadInput, RunFailed.
void view_live(const ViewOptions& options);

/// Access rights that follow from the address of the server. On a loopback address the page carries a fresh token. On
/// others, commands need the token of the file; without a file nobody may command.
[[nodiscard]] Access access_for(const ServerOptions& server, const std::string& token_file);

/// Prints the address to open in the browser on standard output.
void announce(const Server& server, const ServerOptions& options, const Access& access);

}  // namespace ligature::host::view
