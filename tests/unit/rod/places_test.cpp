// Two strands that cross are one contact, wherever along their segments they cross. A pair of segments is left out only
// if it carries no impulse and a contact at its place is nearer.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "firmware/physics/closest.hpp"
#include "firmware/physics/rod/contact/contact_set.hpp"
#include "firmware/physics/rod/tuning.hpp"
#include "tests/support/random.hpp"
#include "tests/unit/rod/rods.hpp"

namespace ligature::test {
namespace {

using namespace physics::rod;

constexpr int kNodes = 42;
constexpr double kStrandDiameter_m = 3e-4, kNear_m = 3e-5;

/// A thread whose nodes 0 to 20 lie along x and whose nodes 21 to 41 lie along y above them, one diameter apart each.
/// `at_a`, `at_b`: where the strands cross, in segments from node 10 and from node 31.
struct Crossing {
  State state;
  ContactSet contacts;
  Motion motion;
  Work work;

  Crossing(double at_a, double at_b, double gap_m) {
    Material material;
    material.radius_m = 0.5 * kStrandDiameter_m;
    material.length_m = (kNodes - 1) * kStrandDiameter_m;
    state.resize(kNodes);
    for (int i = 0; i < kNodes; ++i) {
      const auto k = static_cast<std::size_t>(i);
      state.mesh.s[k] = i * kStrandDiameter_m;
      state.x[k] = i <= 20 ? make((i - 10 - at_a) * kStrandDiameter_m, 0, 0)
                           : make(0, (i - 31 - at_b) * kStrandDiameter_m, kStrandDiameter_m + gap_m);
    }
    state.mesh.rebuild(material);
    contacts.reserve(kNodes, 0, kNodes);
    motion.reserve(kNodes);
    motion.measure(state.v.data());
    work.start(100'000'000);
    for (std::int32_t a = 7; a <= 13; ++a) {
      for (std::int32_t b = 28; b <= 34; ++b) {
        Candidate& pair = contacts.pairs.emplace_back();
        pair.a = a, pair.b = b, pair.reach_m = kStrandDiameter_m, pair.near_m = kNear_m, pair.due = -1.0;
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

TEST(Places, ACrossingIsOneContactWhereverItLies) {
  for (int i = 0; i <= 10; ++i) {
    for (int j = 0; j <= 10; ++j) {
      Crossing crossing(0.1 * i, 0.1 * j, -1e-6);
      const auto& contacts = crossing.collect();
      ASSERT_EQ(contacts.size(), 1U) << i << " " << j;
      EXPECT_NEAR(contacts[0].gap_m, -1e-6, 1e-9);  // the nearest of the points found, not one of the others
    }
  }
}

// A near pair of segments: gap and points of its chords.
struct NearPair {
  double gap_m, a_m, b_m;
  bool loaded, contact;
};

std::vector<NearPair> near_pairs(Crossing& crossing) {
  const auto before = crossing.contacts.pairs;
  const auto& contacts = crossing.collect();
  const auto& x = crossing.state.x;
  std::vector<NearPair> near;
  for (const Candidate& pair : before) {
    const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
    const auto c = physics::closest(x[a], x[a + 1], x[b], x[b + 1]);
    const double gap_m = std::sqrt(c.distance2) - kStrandDiameter_m;
    if (gap_m >= kNear_m) continue;
    const bool contact = std::any_of(contacts.begin(), contacts.end(),
                                     [&](const Contact& k) { return k.node[0] == pair.a && k.node[2] == pair.b; });
    near.push_back({gap_m, (pair.a + c.s) * kStrandDiameter_m, (pair.b + c.t) * kStrandDiameter_m,
                    norm(pair.impulse) > 0.0, contact});
  }
  return near;
}

TEST(Places, OnlyAPairWithoutImpulseIsLeftOutForANearerOne) {
  Random random(53);
  int left_out = 0, loaded = 0;
  for (int round = 0; round < 200; ++round) {
    const double at_a = random.share(), at_b = random.share();
    Crossing crossing(at_a, at_b, -1e-6);
    for (auto& x : crossing.state.x) {  // bends the strands, so that each pair has a normal of its own
      const auto way = random.normals();
      x += 0.02 * kStrandDiameter_m * make(way[0], way[1], way[2]);
    }
    for (Candidate& pair : crossing.contacts.pairs) {
      pair.bulge_m = 0.0;  // contact between chords
      if (!random.happens(0.3)) continue;
      pair.impulse = make(0, 0, 1e-6);
      pair.touch = {(pair.a + 0.5) * kStrandDiameter_m, (pair.b + 0.5) * kStrandDiameter_m};
    }
    const auto near = near_pairs(crossing);
    for (const NearPair& one : near) {
      loaded += one.loaded;
      if (one.contact) continue;
      ++left_out;
      ASSERT_FALSE(one.loaded) << round;
      ASSERT_TRUE(std::any_of(near.begin(), near.end(), [&](const NearPair& other) {
        const double stays_m = other.loaded ? tuning.place_stays_d * kStrandDiameter_m : 0.0;
        return other.contact && other.gap_m <= one.gap_m + stays_m + 1e-12 &&
               std::abs(other.a_m - one.a_m) < tuning.place_d * kStrandDiameter_m &&
               std::abs(other.b_m - one.b_m) < tuning.place_d * kStrandDiameter_m;
      })) << round;
    }
  }
  EXPECT_GT(left_out, 100);
  EXPECT_GT(loaded, 50);
}

// In a held knot the least gap changes from pair to pair by rounding: the pair that carries stays the only contact.
TEST(Places, APairThatCarriesStaysTheOnlyContact) {
  Crossing crossing(0.02, 0.5, -1e-6);  // pair (10, 31) is the nearest, by 0.0002 diameters
  ASSERT_EQ(crossing.collect()[0].node[0], 10);
  for (Candidate& pair : crossing.contacts.pairs) {
    if (pair.a != 9 || pair.b != 31) continue;
    pair.impulse = make(0, 0, 1e-6), pair.touch = {10 * kStrandDiameter_m, 31.5 * kStrandDiameter_m};
  }
  const auto& contacts = crossing.collect();
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts[0].node[0], 9);
}

// Segments 10 and 31 alone, with this cosine of the angle between their strands. The impulse of the last substep acted
// at `touch`; lengths in segments.
struct OnePair : Crossing {
  OnePair(double cosine, double at_a, double at_b, double touch_a, double touch_b) : Crossing(at_a, at_b, -1e-6) {
    for (std::size_t i = 21; i < kNodes; ++i) {
      const double along = state.x[i][1], across = std::sqrt(1.0 - cosine * cosine);
      state.x[i] = make(cosine * along, across * along, state.x[i][2]);
    }
    std::erase_if(contacts.pairs, [](const Candidate& pair) { return pair.a != 10 || pair.b != 31; });
    contacts.groups[0].last = 1;
    Candidate& pair = contacts.pairs[0];
    pair.bulge_m = 0.0;  // contact between chords
    pair.impulse = make(0, 0, 1e-6);
    pair.touch = {(10.0 + touch_a) * kStrandDiameter_m, (31.0 + touch_b) * kStrandDiameter_m};
  }
};

TEST(Places, AnImpulseActsWhereItsTouchFollowsTo) {
  for (const double cosine : {-0.95, 0.0, 0.8}) {
    OnePair pair(cosine, 0.5, 0.5, 0.2, 0.9);
    Touch expected = pair.contacts.pairs[0].touch;
    expected.follow(10.5 * kStrandDiameter_m, 31.5 * kStrandDiameter_m, cosine);
    const auto& contacts = pair.collect();
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_NEAR(-contacts[0].w[1], expected.a / kStrandDiameter_m - 10.0, 1e-9) << cosine;
    EXPECT_NEAR(contacts[0].w[3], expected.b / kStrandDiameter_m - 31.0, 1e-9) << cosine;
  }
}

// In a ball a segment touches many others. A new pair is compared with the contacts near it on its first strand.
TEST(Places, EachComparisonIsCharged) {
  const auto prepared = [](bool all_carry) {
    Crossing crossing(0.5, 0.5, -1e-6);
    for (Candidate& pair : crossing.contacts.pairs) {
      pair.near_m = 1.0, pair.bulge_m = 0.0;  // all 49 pairs are near
      if (!all_carry && pair.a == 10 && pair.b == 28) continue;
      pair.impulse = make(0, 0, 1e-6);
      pair.touch = {(pair.a + 0.5) * kStrandDiameter_m, (pair.b + 0.5) * kStrandDiameter_m};
    }
    return crossing;
  };
  Crossing without = prepared(true), with = prepared(false);
  (void)without.collect(), (void)with.collect();
  const long charged = with.work.used() - without.work.used();
  // 15 contacts of the segments 9 to 11 with 29 to 33 are nearer than the pair (10, 28), and (10, 34) is as near
  EXPECT_GE(charged, 15 * price::kBeside);
  EXPECT_LE(charged, 16 * price::kBeside);
  Crossing poor = prepared(false);
  poor.work.start(with.work.used() - 1);
  poor.contacts.begin();
  ContactReport report;
  EXPECT_FALSE(poor.contacts.collect_thread(poor.state, poor.motion, 1e-4, 0.3, poor.work, report));
}

}  // namespace
}  // namespace ligature::test
