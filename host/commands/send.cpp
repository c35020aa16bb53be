#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "host/commands.hpp"
#include "host/commands/options.hpp"
#include "host/errors.hpp"
#include "host/lcm_link.hpp"
#include "host/send.hpp"

namespace ligature::host {

void add_send(CLI::App& app) {
  struct Options {
    std::string word, text, lcm_url{lcm_tools::kDefaultUrl};
    std::optional<double> value;
  };
  auto* command = app.add_subcommand("send", "Send the firmware a command and print its answer");
  const auto options = std::make_shared<Options>();
  command
      ->add_option("command", options->word,
                   "arm, disarm, stop, reset-fault, reset-thread, clutch, unclutch, park, calibrate, load-scene or set")
      ->required()
      ->check(CLI::IsMember({"arm", "disarm", "stop", "reset-fault", "reset-thread", "clutch", "unclutch", "park",
                             "calibrate", "load-scene", "set"}));
  command->add_option("name", options->text,
                      "clutch, unclutch: left or right; load-scene: the scene file's name, with another model "
                      "or\nnumber of nodes as 'NAME suture.model=MODEL suture.nodes=N'; set: the parameter's key");
  command->add_option("value", options->value, "set: the parameter's value")->check(finite);
  add_url(*command, options->lcm_url);
  command->footer(
      "clutch left parks that tool in the world while the hand moves on, unclutch left takes it up where it is. park "
      "and "
      "calibrate lead\n"
      "hands that hold their dead-man and no thread, gently, to the resting and to the home pose; armed only. "
      "calibrate "
      "checks the\n"
      "encoders on the way and forgets the clutch's offsets.\n"
      "load-scene takes a file of the firmware's --scenes folder, in OFF and IDLE only, where no force can flow. set "
      "changes\n"
      "a parameter within its range, at any time. Launch options (--set, --override-passivity) hold all along: neither "
      "turns\n"
      "force up beyond them. What may be asked for is in the refusal of what may not. Both are "
      "built and\n"
      "measured beside the running loop first, and refused when the worst tick would not fit.\n"
      "Waits up to 1 s (load-scene, set: 10 s); exit code 3 when the firmware refuses or does not answer. No command "
      "can by itself put force "
      "on\n"
      "a hand: that needs the dead-man button of the device as well.\n\n"
      "Example:\n  ligature-host send stop\n  ligature-host send load-scene desk.toml\n"
      "  ligature-host send load-scene 'paper.toml suture.model=paper-2 suture.nodes=35'\n"
      "  ligature-host send set contact.friction 0.5");
  command->callback([options] {
    const bool is_clutch = options->word == "clutch" || options->word == "unclutch";
    const bool is_scene = options->word == "load-scene", is_set = options->word == "set";
    const bool has_text = !options->text.empty(), has_value = options->value.has_value();
    if (has_text != (is_clutch || is_scene || is_set) || has_value != is_set)
      throw BadInput("send " + options->word + ": found " + std::to_string(has_text + has_value) +
                     " further words, allowed " +
                     (is_set      ? "a key and a value"
                      : is_scene  ? "the name of a scene"
                      : is_clutch ? "left or right"
                                  : "none"));
    if (is_clutch && options->text != "left" && options->text != "right")
      throw BadInput("send " + options->word + ": found '" + options->text + "', allowed left, right");
    if (is_clutch) return send(options->word + " " + options->text, "", 0.0, options->lcm_url);
    send(options->word, options->text, options->value.value_or(0.0), options->lcm_url);
  });
}

}  // namespace ligature::host
