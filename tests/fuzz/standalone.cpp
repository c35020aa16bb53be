// Runs a target without libFuzzer: all seeds, then mutations of them, with a fixed generator seed.
//   TARGET [ROUNDS]          run; exit code 0 when nothing crashed
//   TARGET --write FOLDER    write the seeds as files, as a corpus for libFuzzer
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "tests/fuzz/target.hpp"
#include "tests/support/random.hpp"

namespace {

/// One to eight random changes: flip a bit, set a byte, cut out or duplicate a piece, truncate, insert a large number.
std::string mutated(std::string s, ligature::test::Random& random) {
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random()) % n; };
  for (std::size_t k = 1 + below(8); k > 0 && !s.empty(); --k) {
    const std::size_t at = below(s.size());
    const std::size_t length = std::min(s.size() - at, 1 + below(16));
    switch (below(6)) {
      case 0:
        s[at] = static_cast<char>(s[at] ^ (1 << below(8)));
        break;
      case 1:
        s[at] = static_cast<char>(below(256));
        break;
      case 2:
        s.erase(at, length);
        break;
      case 3:
        s.insert(at, s.substr(at, length));
        break;
      case 4:
        s.resize(at);
        break;
      default:
        std::memset(s.data() + at, below(2) != 0 ? 0xFF : 0x7F, length);
        break;
    }
  }
  return s;
}

void eat(const std::string& s) { LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(s.data()), s.size()); }

}  // namespace

int main(int argc, char** argv) {
  const auto seeds = ligature::fuzz::seeds();
  if (argc == 3 && std::string(argv[1]) == "--write") {
    for (std::size_t i = 0; i < seeds.size(); ++i)
      std::ofstream(std::string(argv[2]) + "/seed-" + std::to_string(i), std::ios::binary) << seeds[i];
    return 0;
  }
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 1000;
  ligature::test::Random random(1);
  eat({});
  for (const auto& seed : seeds) eat(seed);
  for (int i = 0; i < rounds; ++i) eat(mutated(seeds[static_cast<std::size_t>(random()) % seeds.size()], random));
  std::printf("%zu seeds, %d mutations\n", seeds.size(), rounds);
  return seeds.empty() ? 1 : 0;
}
