// Two strands that cross are one contact, wherever along their segments they cross; its impulse passes whole from pair
// to pair of segments.

#include <gtest/gtest.h>

#include <vector>

#include "firmware/physics/rod/contact/contact_set.hpp"
#include "tests/unit/rod/rods.hpp"

namespace ligature::test {
namespace {

using namespace physics::rod;

constexpr int kNodes = 42;
constexpr double kDiameter_m = 3e-4, kNear_m = 3e-5;

/// A thread whose nodes 0 to 20 lie along x and whose nodes 21 to 41 lie along y above them, one diameter apart each.
/// `at_a`, `at_b`: where the strands cross, in segments from node 10 and from node 31.
struct Crossing {
  State state;
  ContactSet contacts;
  Motion motion;
  Work work;

  Crossing(double at_a, double at_b, double gap_m) {
    Material material;
    material.radius_m = 0.5 * kDiameter_m;
    material.length_m = (kNodes - 1) * kDiameter_m;
    state.resize(kNodes);
    for (int i = 0; i < kNodes; ++i) {
      const auto k = static_cast<std::size_t>(i);
      state.mesh.s[k] = i * kDiameter_m;
      state.x[k] = i <= 20 ? make((i - 10 - at_a) * kDiameter_m, 0, 0)
                           : make(0, (i - 31 - at_b) * kDiameter_m, kDiameter_m + gap_m);
    }
    state.mesh.rebuild(material);
    contacts.reserve(kNodes, 0, kNodes);
    motion.reserve(kNodes);
    motion.measure(state.v.data());
    work.start(100'000'000);
    for (std::int32_t a = 7; a <= 13; ++a) {
      for (std::int32_t b = 28; b <= 34; ++b) {
        Candidate& pair = contacts.pairs.emplace_back();
        pair.a = a, pair.b = b, pair.reach_m = kDiameter_m, pair.near_m = kNear_m, pair.due = -1.0;
        pair.bulge_m = 1e-6;
      }
    }
    contacts.groups.push_back({0, static_cast<std::int32_t>(contacts.pairs.size()), 0, 2, PairGroup::kAtOnce});
  }
  [[nodiscard]] const std::vector<Contact>& collect() {
    ContactReport report;
    contacts.begin();
    EXPECT_TRUE(contacts.collect_thread(state, motion, 1e-4, 0.3, work, report));
    return contacts.contacts();
  }
};

TEST(Merge, ACrossingIsOneContactWhereverItLies) {
  for (int i = 0; i <= 10; ++i) {
    for (int j = 0; j <= 10; ++j) {
      Crossing crossing(0.1 * i, 0.1 * j, -1e-6);
      const auto& contacts = crossing.collect();
      ASSERT_EQ(contacts.size(), 1U) << i << " " << j;
      EXPECT_NEAR(contacts[0].gap_m, -1e-6, 1e-9);  // the nearest of the points found, not one of the others
    }
  }
}

TEST(Merge, PassesTheWholeImpulseOn) {
  for (int i = 0; i <= 10; ++i) {
    Crossing crossing(0.1 * i, 0.0, -1e-6);
    for (Candidate& pair : crossing.contacts.pairs) {
      const bool touches = (pair.a == 9 || pair.a == 10) && (pair.b == 30 || pair.b == 31);
      if (touches)
        pair.impulse = make(0, 0, pair.a == 9 ? 2e-6 : 1e-6), pair.touch.begin(10 * kDiameter_m, 31 * kDiameter_m);
    }
    double sum = 0.0;
    for (const Contact& c : crossing.collect()) sum += c.p[2];
    if (i <= 4) {  // further off, pair 9 does not touch any more
      EXPECT_DOUBLE_EQ(sum, 6e-6) << i;
    }
    EXPECT_GE(sum, 2e-6) << i;
  }
}

// In a held knot the least gap changes from pair to pair by rounding: the pair that carries keeps the contact.
TEST(Merge, APairThatCarriesKeepsTheContact) {
  Crossing crossing(0.02, 0.5, -1e-6);  // pair (10, 31) is the nearest, by 0.0002 diameters
  ASSERT_EQ(crossing.collect()[0].node[0], 10);
  for (Candidate& pair : crossing.contacts.pairs) {
    if (pair.a != 9 || pair.b != 31) continue;
    pair.impulse = make(0, 0, 1e-6), pair.touch.begin(10 * kDiameter_m, 31.5 * kDiameter_m);
  }
  const auto& contacts = crossing.collect();
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts[0].node[0], 9);
}

}  // namespace
}  // namespace ligature::test
