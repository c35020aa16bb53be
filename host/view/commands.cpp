#include "host/view/commands.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "host/lcm_link.hpp"
#include "host/view/live.hpp"
#include "host/view/replay.hpp"

namespace ligature::host::view {
namespace {

void add_address(CLI::App& command, ServerOptions& server) {
  command.add_option("--port", server.port, "TCP port; 0 takes any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command.add_option("--listen", server.listen, "address to listen on; 127.0.0.1 is seen by this machine alone")
      ->capture_default_str();
}

}  // namespace

void add_view(CLI::App& app) {
  auto* command = app.add_subcommand("view", "Show the running rig in a browser");
  const auto options = std::make_shared<ViewOptions>();
  options->lcm_url = lcm_tools::kDefaultUrl;
  add_address(*command, options->server);
  command->add_option("--token-file", options->token_file,
                      "file whose first line is the token that commands need; without it commands are given only "
                      "on this machine's own address");
  command->add_option("--lcm-url", options->lcm_url, "LCM network of the rig")->capture_default_str();
  command->add_option("--recordings", options->recordings, "folder for what the page records; a page names the file")
      ->check(CLI::ExistingDirectory)
      ->capture_default_str();
  command->footer(
      "Prints the address to open. Works without internet, shows pages to up to 64 browsers and never slows the rig.\n"
      "Commands (arm, disarm, stop, resets) come only from this page itself: a page of another site is turned away.\n"
      "No command can by itself put force on a hand: that needs the dead-man button of the device as well.\n\n"
      "Example: look at the rig from a tablet, command it from there with a token\n"
      "  ligature-host view --listen 0.0.0.0 --token-file token.txt");
  command->callback([options] { view_live(*options); });
}

void add_replay(CLI::App& app) {
  auto* command = app.add_subcommand("replay", "Show a recording in a browser");
  const auto options = std::make_shared<ReplayOptions>();
  command->add_option("log", options->log, "LCM log of 'record'")->required();
  command->add_option("--compare", options->compare, "another one, whose traces are drawn dashed over these");
  command->add_option("--align", options->align, "what both have in common: their first tick, or their first grasp")
      ->check(CLI::IsMember({"start", "grasp"}))
      ->capture_default_str();
  add_address(*command, options->server);
  command->footer(
      "The same page with a bar to scrub, 0.1 to 10 times the speed, and marks to jump to: grasp, release, knot,\n"
      "fault. The log is mapped, not loaded: an hour opens in about two seconds. The page can lay another recording\n"
      "of the same folder over it, too.\n\n"
      "Example:\n  ligature-host replay tuesday.lcmlog --compare monday.lcmlog --align grasp");
  command->callback([options] { replay(*options); });
}

}  // namespace ligature::host::view
