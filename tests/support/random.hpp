#pragma once
// Source of every random input of the tests.
//
// The same seed gives the same numbers with every compiler, library and machine. Therefore nothing here uses a standard
// distribution (its output is implementation-defined), libm, or a sum that a compiler may contract. Draw numbers in
// separate statements or in a braced list: C++ leaves the evaluation order of function arguments and operands open.
//
// LIGATURE_TEST_SEED (0 .. 2^64 - 1, default 0; `scripts/test --seed N`) shifts all seeds at once. A failing test
// prints the seed and the command that repeats the run (tests/support/seed_told.cpp). LIGATURE_TEST_DREW names a file
// that the first draw of a process creates: so scripts/sweep learns which tests draw.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <utility>

namespace ligature::test {

/// The value of LIGATURE_TEST_SEED; exits with 2 if it is no number. Writes LIGATURE_TEST_DREW for scripts/sweep.
inline std::uint64_t seed_shift() {
  static const std::uint64_t shift = [] {
    if (const char* drew = std::getenv("LIGATURE_TEST_DREW"))
      if (std::FILE* file = std::fopen(drew, "w")) std::fclose(file);
    const char* text = std::getenv("LIGATURE_TEST_SEED");
    if (text == nullptr || *text == '\0') return std::uint64_t{0};
    std::uint64_t value = 0;
    for (const char c : std::string_view(text)) {
      const auto digit = static_cast<std::uint64_t>(c - '0');
      if (c < '0' || c > '9' || value > (std::numeric_limits<std::uint64_t>::max() - digit) / 10) {
        std::fprintf(stderr, "LIGATURE_TEST_SEED is '%s', allowed: a whole number, 0 .. 2^64 - 1\n", text);
        std::exit(2);
      }
      value = 10 * value + digit;
    }
    return value;
  }();
  return shift;
}

/// SplitMix64 (Steele, Lea, Flood 2014). Satisfies UniformRandomBitGenerator, but only for standard algorithms whose
/// result is the same in every library; std::shuffle is not, use shuffle() below.
class Random {
 public:
  using result_type = std::uint64_t;
  explicit Random(std::uint64_t seed) noexcept : state_(mixed(seed) ^ (seed_shift() == 0 ? 0 : mixed(~seed_shift()))) {}

  result_type operator()() noexcept { return mixed(state_ += kStep); }
  static constexpr result_type min() noexcept { return 0; }
  static constexpr result_type max() noexcept { return std::numeric_limits<result_type>::max(); }

  /// Uniform in [0, 1), with 53 random bits.
  double share() noexcept { return static_cast<double>((*this)() >> 11) * 0x1p-53; }
  /// Uniform in [low, high).
  double in(double low, double high) noexcept { return std::fma(high - low, share(), low); }
  bool happens(double probability) noexcept { return share() < probability; }
  /// Uniform integer in low .. high, both included.
  std::int64_t any(std::int64_t low, std::int64_t high) noexcept {
    const auto span = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low) + 1;
    const std::uint64_t draw = (*this)();
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(low) + (span == 0 ? draw : draw % span));
  }
  /// Uniform index below n. @pre n > 0
  std::size_t below(std::size_t n) noexcept { return static_cast<std::size_t>((*this)() % n); }
  /// Approximately normal, mean 0, variance 1, magnitude at most 6: the sum of twelve uniform draws, which avoids libm.
  double normal() noexcept {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += share();
    return sum;
  }
  /// Three draws of normal(), in a defined order.
  std::array<double, 3> normals() noexcept { return {normal(), normal(), normal()}; }

  template <class List>
  void shuffle(List& list) noexcept {
    for (std::size_t i = list.size(); i > 1; --i) {
      using std::swap;
      swap(list[i - 1], list[below(i)]);
    }
  }

 private:
  static constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15ULL;
  static constexpr std::uint64_t mixed(std::uint64_t z) noexcept {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace ligature::test
