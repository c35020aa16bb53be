// Fuzz target: LCM log files, intact and damaged, and the decoding of every message in them.
#include "host/errors.hpp"
#include "host/log_reader.hpp"
#include "tests/fuzz/target.hpp"
#include "tests/unit/host/synthetic_log.hpp"

std::vector<std::string> ligature::fuzz::seeds() {
  const host::test::TestFolder folder;
  {
    host::LogWriter log(folder.file("seed"), true);
    host::test::write(log, host::kTicksChannel, host::test::batch_of(1, 0, 2));
    host::test::write(log, host::kThreadChannel, host::test::thread_of(1, host::test::straight_points(3)));
    log.close();
  }
  return {host::test::text_of(folder.file("seed"))};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ligature;
  const fuzz::MemoryFile file(data, size);
  try {
    host::LogReader log(file.path());
    while (const auto* event = log.next()) (void)host::is_readable(event->channel, event->data);
    (void)log.damage();
  } catch (const host::BadInput&) {  // rejected, as it should be
  }
  return 0;
}
