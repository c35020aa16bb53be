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

/// Access rights that follow from the address of the server. With a token file, commands need the token in it, and
/// users append the token to the page's address. Without a file: on a loopback address the server makes a token and
/// writes it into the page; on any other address no page may send commands.
[[nodiscard]] Access access_for(const ServerOptions& server, const std::string& token_file);

/// Prints the address to open in the browser on standard output.
void announce(const Server& server, const ServerOptions& options, const Access& access);

}  // namespace ligature::host::view
