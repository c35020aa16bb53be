// Two throws of one thread: the friction at which square, granny, thief and grief lock, and the threshold of a square
// knot that is drawn slowly.

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/knot/draw.hpp"
#include "host/lab/published/case.hpp"
#include "host/lab/published/lock_test.hpp"

namespace ligature::published {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A statement that must be true: 1 for yes, 0 for no.
Finding claim(std::string what, bool holds) { return validate::absolute(std::move(what), 1.0, holds, 0.0, "(1: yes)"); }

/// A loose square knot whose lengths are drawn at random, each within 20 % of its usual value.
Throws random_square(std::uint64_t seed) {
  knot::Draw draw(seed);
  Throws t{.half_turns = {3, -3}};
  for (double* length : {&t.aside_d, &t.half_turn_d, &t.between_d}) *length *= 0.8 + 0.4 * draw.share();
  return t;
}

}  // namespace

Result locking(const Subject& subject) {
  struct Named {
    const char* name;
    Throws throws;
  };
  const Named knots[] = {{"reef (square)", {.half_turns = {3, -3}}},
                         {"granny", {.half_turns = {3, 3}}},
                         {"thief", {.half_turns = {3, -3}, .ends = Ends::kDiagonal}},
                         {"grief", {.half_turns = {3, 3}, .ends = Ends::kDiagonal}}};
  Result result;
  std::vector<double> at;  // reef, granny, thief, grief; the quick form leaves the thief out
  for (int k = 0; k < 4; ++k) {
    if (subject.quick && k == 2) continue;
    at.push_back(locking_friction(subject, {.throws = knots[k].throws}, 0.2, 5.0, subject.quick ? 1.25 : 1.03));
    result.findings.push_back(reported(std::string(knots[k].name) + ": friction at which it locks", at.back(), ""));
    result.points.push_back({"locks at", k + 1.0, kNone, at.back()});
  }
  const auto others_above = std::all_of(at.begin() + 1, at.end(), [&](double other) { return other > at.front(); });
  const auto others_below = std::all_of(at.begin(), at.end() - 1, [&](double other) { return other < at.back(); });
  result.findings.push_back(claim("the reef knot locks first", others_above));
  result.findings.push_back(claim("the grief knot locks last", others_below));
  return result;
}

Result threshold(const Subject& subject) {
  Result result;
  const int draws = subject.quick ? 2 : 12;
  constexpr double kLow = 0.2, kHigh = 1.0;
  double sum = 0.0, squares = 0.0, least = 1.0, most = 0.0;
  for (int seed = 1; seed <= draws; ++seed) {
    const Drawing square{.throws = random_square(static_cast<std::uint64_t>(seed)), .speed_m_per_s = 0.005};
    const double friction = locking_friction(subject, square, kLow, kHigh, subject.quick ? 1.12 : 1.02);
    sum += friction, squares += friction * friction;
    least = std::min(least, friction), most = std::max(most, friction);
    result.points.push_back({"begins to lock", static_cast<double>(seed), kNone, friction});
  }
  const double mean = sum / draws, deviation = std::sqrt(std::max(0.0, (squares - draws * mean * mean) / (draws - 1)));
  // The search goes upwards, so every knot has slipped at a friction below its threshold and held at a friction above
  // it.
  result.findings.push_back(claim("slips at friction 0.2 and holds below friction 1", least > kLow && most < kHigh));
  result.findings.push_back(reported("friction at which it begins to lock, mean", mean, ""));
  result.findings.push_back(reported("its standard error", deviation / std::sqrt(draws), ""));
  result.findings.push_back(reported("lowest of the drawn knots", least, ""));
  result.findings.push_back(reported("highest of the drawn knots", most, ""));
  return result;
}

}  // namespace ligature::published
