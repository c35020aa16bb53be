// Fuzz target: LCM messages from the network, for the host's decoders. The first byte selects the message type.
#include <span>

#include "host/messages.hpp"
#include "tests/fuzz/target.hpp"
#include "tests/unit/host/synthetic_log.hpp"

namespace ligature {
namespace {

template <class M>
std::string seed(char type, const M& message) {
  const auto bytes = host::test::encoded(message);
  return type + std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

}  // namespace

std::vector<std::string> fuzz::seeds() {
  ligature_msg::status_t status{};
  status.period_s = 0.001;
  status.scene_toml = "[suture]";
  return {seed(0, host::test::batch_of(1, 0, 3)),
          seed(1, host::test::thread_of(1, host::test::straight_points(4))),
          seed(2, status),
          seed(3, ligature_msg::event_t{}),
          seed(4, ligature_msg::ack_t{}),
          seed(5, ligature_msg::command_t{})};
}

}  // namespace ligature

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ligature;
  if (size == 0) return 0;
  const host::Bytes bytes = std::as_bytes(std::span(data + 1, size - 1));
  switch (data[0] % 6) {
    case 0:
      (void)host::decode<ligature_msg::tick_batch_t>(bytes);
      break;
    case 1:
      (void)host::decode<ligature_msg::thread_t>(bytes);
      break;
    case 2:
      (void)host::decode<ligature_msg::status_t>(bytes);
      break;
    case 3:
      (void)host::decode<ligature_msg::event_t>(bytes);
      break;
    case 4:
      (void)host::decode<ligature_msg::ack_t>(bytes);
      break;
    default:
      (void)host::decode<ligature_msg::command_t>(bytes);
      break;
  }
  return 0;
}
