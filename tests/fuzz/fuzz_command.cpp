// Fuzz target: command messages from the network, for the firmware's decoder.
#include <span>

#include "firmware/telemetry/messages.hpp"
#include "tests/fuzz/target.hpp"

std::vector<std::string> ligature::fuzz::seeds() {
  std::vector<std::string> out;
  for (const char* text : {"", "contact.friction", "scenes/suture-3-0.toml"}) {
    ligature_msg::command_t command{};
    command.text = text;
    std::string bytes(static_cast<std::size_t>(command.getEncodedSize()), '\0');
    (void)command.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    out.push_back(std::move(bytes));
  }
  return out;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  (void)ligature::telemetry::command_of(std::as_bytes(std::span(data, size)));
  return 0;
}
