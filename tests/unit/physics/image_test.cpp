// A simulation loaded from an image continues like the simulation that was saved, to the bit. A damaged image, or one
// of another simulation, is refused.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "firmware/physics/image.hpp"
#include "firmware/physics/simulation.hpp"
#include "ligature_source_dir.hpp"
#include "protocol/scene/scene_file.hpp"
#include "tests/support/random.hpp"

namespace ligature::test {
namespace {

using physics::Simulation;
using physics::ToolInput;
using Image = std::vector<std::byte>;

Simulation made(const std::string& name, const std::vector<std::string>& overrides = {}) {
  const auto read = scene::load_scene(LIGATURE_SOURCE_DIR "/scenes/" + name, overrides);
  if (const auto* error = std::get_if<scene::Error>(&read)) throw std::runtime_error(error->text);
  auto simulation = Simulation::make(std::get<scene::Scene>(read));
  if (const auto* why = std::get_if<std::string>(&simulation)) throw std::runtime_error(*why);
  return std::get<Simulation>(std::move(simulation));
}

/// Two hands that hold the ends, draw them apart, shake them across, and let go now and then.
struct Hands {
  explicit Hands(const Simulation& sim) : from{sim.nodes_W().front(), sim.nodes_W().back()} {}
  [[nodiscard]] std::array<ToolInput, 2> at(int tick) const {
    std::array<ToolInput, 2> tools{};
    const double t_s = 1e-3 * tick, drawn_m = 0.1 * t_s, shaken_m = 2e-3 * std::sin(30.0 * t_s);
    for (int h = 0; h < 2; ++h) {
      const double out = h == 0 ? -1.0 : 1.0;
      auto& tool = tools[static_cast<std::size_t>(h)];
      tool.p_WT = from[static_cast<std::size_t>(h)] + physics::Vec3(out * drawn_m, shaken_m, out * shaken_m);
      tool.v_WT = {out * 0.1, 0.06 * std::cos(30.0 * t_s), 0.0};
      tool.grip = tick % 300 < 290;
    }
    return tools;
  }
  std::array<physics::Vec3, 2> from;
};

void play(Simulation& sim, const Hands& hands, int from, int to) {
  for (int k = from; k < to; ++k) sim.tick(hands.at(k));
}

struct Kind {
  const char* name;
  const char* scene;
  std::vector<std::string> overrides;
};

const Kind kKinds[] = {
    {"paper-1", "paper.toml", {"suture.model=paper-1"}},
    {"paper-2", "paper.toml", {"suture.model=paper-2"}},
    {"paper-3", "paper.toml", {"suture.model=paper-3"}},
    {"paper-4", "paper.toml", {"suture.model=paper-4", "hands.propagation=true"}},
    {"paper-5", "paper.toml", {"suture.model=paper-5", "contact.broad_phase=sweep"}},
    {"paper's contact", "paper.toml", {"contact.solver=paper"}},
    {"knot on a desk", "desk.toml", {}},
    {"hanging suture", "suture-3-0.toml", {}},
    {"knot", "suture-3-0-knot.toml", {}},
    {"knot that turns", "suture-3-0-knot.toml", {"contact.turns_thread=true"}},
    {"knot with set and memory",
     "suture-3-0-knot.toml",
     {"suture.yield_strain=0.01", "suture.set_fraction=0.5", "contact.static_friction=0.4"}},
    {"knot with a stiff part",
     "suture-3-0-knot.toml",
     {"suture.stiffness_profile=[{from_m=0.05,to_m=0.1,EI_N_m2=2e-6}]"}},
    {"knot with peg and desk",
     "suture-3-0-knot.toml",
     {"world.desk_height_m=-0.002",
      "world.pegs=[{from_m=[-0.05,-0.01,-0.001],to_m=[-0.05,0.01,-0.001],radius_m=0.001}]"}},
    {"knot by sweeps, little work", "suture-3-0-knot.toml", {"suture.work_instructions=2000000"}},
};

/// All values that can be read from a simulation.
std::vector<double> shown(const Simulation& sim) {
  std::vector<double> all;
  const auto add = [&all](const physics::Vec3& v) { all.insert(all.end(), {v.x(), v.y(), v.z()}); };
  std::ranges::for_each(sim.nodes_W(), add);
  std::ranges::for_each(sim.velocities_W(), add);
  std::vector<physics::ContactPoint> contacts(Simulation::kMostContacts);
  contacts.resize(sim.contacts(contacts));
  for (const auto& c : contacts) add(c.p_W), add(c.f_W);
  for (const auto hand : {physics::Hand::kLeft, physics::Hand::kRight})
    add(sim.hand(hand).f_W), add(sim.hand(hand).p_WG);
  const auto& d = sim.diagnostics();
  all.insert(all.end(), {d.kinetic_J, d.potential_J, d.max_stretch, d.time_lost, double(d.work), double(d.contacts)});
  return all;
}

class OfImage : public testing::TestWithParam<Kind> {};

/// A simulation is saved at several moments, with and without a hold. The loaded simulation is compared with it at
/// once, and in each of the 40 ticks that follow.
TEST_P(OfImage, ContinuesToTheBit) {
  Simulation sim = made(GetParam().scene, GetParam().overrides);
  Simulation loaded = sim;
  const Hands hands(sim);
  int now = 0, contacts = 0;
  for (const int stop : {0, 7, 60, 200, 295, 400}) {
    play(sim, hands, now, stop);
    now = stop;
    const Image image = sim.save(now);
    const auto nodes = loaded.nodes_W();
    ASSERT_EQ(std::get<0>(loaded.load(image)), now);
    ASSERT_EQ(nodes.data(), loaded.nodes_W().data()) << "views of the nodes stay valid";
    ASSERT_TRUE(std::ranges::equal(loaded.save(now), image)) << "what is written is read";
    ASSERT_EQ(shown(sim), shown(loaded)) << "saved at " << now;
    for (int k = now; k < now + 40; ++k) {
      sim.tick(hands.at(k));
      loaded.tick(hands.at(k));
      ASSERT_EQ(shown(sim), shown(loaded)) << "tick " << k << ", saved at " << now;
    }
    now += 40;
    contacts = std::max(contacts, sim.diagnostics().contacts);
  }
  const bool has_knot = std::string(GetParam().name).find("knot") != std::string::npos;
  EXPECT_GE(contacts, has_knot ? 5 : 0) << "the contacts of a knot are continued, too";
}

INSTANTIATE_TEST_SUITE_P(Kinds, OfImage, testing::ValuesIn(kKinds), [](const auto& kind) {
  std::string name = kind.param.name;
  std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  return name;
});

/// The text with which a suture that has moved refuses an image; empty if it accepts. A refusal must not change the
/// suture.
std::string refusal(const Image& image) {
  Simulation sim = made("suture-3-0-knot.toml");
  play(sim, Hands(sim), 0, 20);
  const Image before = sim.save();
  const auto loaded = sim.load(image);
  const std::string why = loaded.index() == 1 ? std::get<1>(loaded) : "";
  EXPECT_TRUE(why.empty() || sim.save() == before) << "refused, but changed";
  return why;
}

TEST(Image, OfAnotherSceneIsRefused) {
  EXPECT_EQ(refusal(made("suture-3-0-knot.toml").save()), "");
  for (const char* other : {"contact.friction=0.31", "suture.nodes=201", "world.gravity_m_per_s2=[0,0,-9]",
                            "hands.reach_m=0.02", "suture.work_instructions=5000000", "suture.initial=hanging"})
    EXPECT_EQ(refusal(made("suture-3-0-knot.toml", {other}).save()),
              "the image was saved by a simulation of another scene: load it with the scene and the overrides of that "
              "simulation")
        << other;
  EXPECT_NE(refusal(made("paper.toml").save()), "");
}

/// The paper's models have the same constants and members and differ only in the forces that are chosen when a
/// simulation is made. So an image of another model must be recognised by the chosen forces.
TEST(Image, OfAnotherModelOfThePaperIsRefused) {
  const std::vector<std::string> kinds{"suture.model=\"paper-1\"", "suture.model=\"paper-2\"",
                                       "suture.model=\"paper-3\"", "suture.model=\"paper-4\"",
                                       "suture.model=\"paper-5\"", "suture.swivel=\"paper\""};  // of model 4
  for (const auto& saved : kinds)
    for (const auto& other : kinds) {
      const auto loaded = made("paper.toml", {other}).load(made("paper.toml", {saved}).save());
      EXPECT_EQ(loaded.index(), saved == other ? 0U : 1U) << saved << " into " << other;
    }
}

TEST(Image, OfAnotherVersionOrDamagedIsRefused) {
  const Image good = made("suture-3-0-knot.toml").save();
  EXPECT_EQ(refusal({}), "found 0 bytes, allowed a whole image");
  EXPECT_EQ(refusal(Image(1000)), "this is no image of a simulation: allowed what save() has made");
  Image longer = good;
  longer.push_back(std::byte{0});
  EXPECT_EQ(refusal(longer), "the image is damaged: save it again");
}

/// The contents have a wrong length, but the header fits them: only reading the contents shows the error.
TEST(Image, OfOtherLengthsIsRefused) {
  const Image good = made("suture-3-0-knot.toml").save();
  physics::ImageOrigin origin;
  std::memcpy(&origin, good.data() + 32, sizeof origin);  // after magic, version and ticks
  Image contents(good.begin() + 48, good.end());
  const auto with = [&](const Image& c) { return physics::with_header(origin, {0, c}); };
  EXPECT_EQ(refusal(with(contents)), "");
  contents.pop_back();
  EXPECT_EQ(refusal(with(contents)), "the image has other lengths than this simulation: save it again");
  contents.insert(contents.end(), 2, std::byte{0});
  EXPECT_EQ(refusal(with(contents)), "the image has other lengths than this simulation: save it again");
}

/// A truncated image, or one with flipped bits, is refused: a CRC-32 finds every burst of up to 32 bits.
TEST(Image, DamagedAtRandomIsRefused) {
  Simulation sim = made("suture-3-0-knot.toml");
  const Hands hands(sim);
  play(sim, hands, 0, 20);
  const Image good = sim.save();
  Random random(20'261'125);
  for (int k = 0; k < 60; ++k) {
    Image bad = good;
    const auto at = static_cast<std::size_t>(random.share() * static_cast<double>(k % 3 == 0 ? 48 : good.size()));
    if (k % 2 == 0) {
      bad.resize(at);
    } else {
      bad[at] ^= static_cast<std::byte>(1U << static_cast<unsigned>(random.in(0.0, 8.0)));
    }
    Simulation into = sim;
    const Image before = into.save();
    ASSERT_EQ(into.load(bad).index(), 1U) << "byte " << at << (k % 2 == 0 ? " is the end" : " is damaged");
    ASSERT_EQ(into.save(), before) << "refused, but changed";
  }
}

}  // namespace
}  // namespace ligature::test
