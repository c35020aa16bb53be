#include "protocol/scene/gripper_script.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "ligature_source_dir.hpp"
#include "protocol/scene/csv.hpp"
#include "tests/support/temp_folder.hpp"

namespace ligature::scene {
namespace {

TEST(Text, IsShortenedBetweenWords) {
  EXPECT_EQ(shortened("one two", 7), "one two");
  EXPECT_EQ(shortened("one two three", 12), "one two ..");
  EXPECT_EQ(shortened("one two three", 10), "one two ..");
  EXPECT_EQ(shortened("one two three", 9), "one ..");
  EXPECT_EQ(shortened("onetwothree", 8), "onetw ..") << "a word that does not fit";
}

std::string write(const std::string& text) {
  const auto path = test::temp_folder() + "grippers.csv";
  std::ofstream(path) << text;
  return path;
}

std::string why_script_refused(const std::string& rows) {
  const auto read = load_gripper_script(write("# a comment\ntime,hand,x,y,z,grip\n" + rows));
  const auto* error = std::get_if<Error>(&read);
  return error ? error->text : "";
}

TEST(GripperScript, ReadsTheShippedOverhandScript) {
  const auto read = load_gripper_script(LIGATURE_SOURCE_DIR "/scenes/operators/overhand.csv");
  ASSERT_TRUE(std::holds_alternative<GripperScript>(read)) << std::get<Error>(read).text;
  const auto& script = std::get<GripperScript>(read);
  EXPECT_EQ(script.keys[0].size(), 11u);
  EXPECT_EQ(end_time_s(script), 21.0);
}

TEST(GripperScript, RefusesABadRowByItsLine) {
  const struct {
    const char* rows;
    const char* says;
  } kCases[] = {
      {"0,L,0,0,0\n", ":3: found 5 columns"},
      {"0,L,0,0,0,1,\n", ":3: found 7 columns"},
      {"0,L,0,0,0,1\nx,L,0,0,0,1\n", ":4: column 'time': found 'x'"},
      {"0,L,0,nan,0,1\n", ":3: column 'y': found 'nan'"},
      {"0,L,0,0,inf,1\n", ":3: column 'z'"},
      {"0,L,,0,0,1\n", ":3: column 'x': found ''"},
      {"0,L,1e999,0,0,1\n", ":3: column 'x'"},
      {"0,l,0,0,0,1\n", ":3: column 'hand': found 'l', allowed L or R"},
      {"0,L,0,0,0,2\n", ":3: column 'grip': found '2', allowed 0 or 1"},
      {"-1,L,0,0,0,1\n", ":3: column 'time': found -1"},
      {"1e300,L,0,0,0,1\n", ":3: column 'time': found 1e300, allowed 0 .. 1e6"},
      {"0,L,0,-1e308,0,1\n", ":3: column 'y': found -1e308, allowed -1e6 .. 1e6"},
      {"1,L,0,0,0,1\n0,R,0,0,0,1\n1,L,0,0,0,1\n", ":5: column 'time': found 1, allowed later"},
      {"", "found no rows"},
  };
  for (const auto& c : kCases)
    EXPECT_NE(why_script_refused(c.rows).find(c.says), std::string::npos) << c.rows << why_script_refused(c.rows);
  const auto header = load_gripper_script(write("t,hand,x,y,z,grip\n0,L,0,0,0,1\n"));
  EXPECT_NE(std::get<Error>(header).text.find(":1: found 't,hand,x,y,z,grip', allowed the header"), std::string::npos);
  EXPECT_NE(std::get<Error>(load_gripper_script("no/such.csv")).text.find("cannot be read"), std::string::npos);
}

TEST(GripperScript, HandsThatTurnHaveThreeColumnsMore) {
  const std::string header = "time,hand,x,y,z,grip,turn_x,turn_y,turn_z\n";
  const auto read = load_gripper_script(write(header + "0,L,0,0,0,1,0,0,0\n2,L,0,0,0,1,720,0,-90\n"));
  ASSERT_TRUE(std::holds_alternative<GripperScript>(read)) << std::get<Error>(read).text;
  const auto& script = std::get<GripperScript>(read);
  EXPECT_TRUE(script.turns);
  EXPECT_EQ(sample(script.keys[0], 1.0).turn_deg, (Vec{360.0, 0.0, -45.0}));
  EXPECT_EQ(sample(script.keys[0], 9.0).turn_deg, (Vec{720.0, 0.0, -90.0}));
  const auto bad = load_gripper_script(write(header + "0,L,0,0,0,1,0,x,0\n"));
  EXPECT_NE(std::get<Error>(bad).text.find(":2: column 'turn_y': found 'x'"), std::string::npos);
  const auto plain = load_gripper_script(write("time,hand,x,y,z,grip\n0,L,0,0,0,1\n"));
  EXPECT_FALSE(std::get<GripperScript>(plain).turns);
}

TEST(GripperScript, ALineBeforeTheHeaderSaysHowTheHandGoes) {
  const std::string rows = "time,hand,x,y,z,grip\n0,L,0,0,0,1\n1,L,1,0,0,1\n2,L,2,0,0,1\n";
  const auto passing_x = [&](const std::string& first_line) {
    const auto read = load_gripper_script(write("# as recorded\n" + first_line + rows));
    const auto* error = std::get_if<Error>(&read);
    EXPECT_EQ(error, nullptr) << error->text;
    return error != nullptr ? -1.0 : sample(std::get<GripperScript>(read).keys[0], 1.0).v_W_m_per_s[0];
  };
  EXPECT_EQ(passing_x(""), 0.0);
  EXPECT_EQ(passing_x("motion,rests\n"), 0.0);
  EXPECT_DOUBLE_EQ(passing_x(" motion , monotone-cubic\n"), 1.0);
  const auto why = [&](const std::string& text) { return std::get<Error>(load_gripper_script(write(text))).text; };
  EXPECT_NE(why("motion,linear\n" + rows).find(":1: motion: found 'linear', allowed rests or monotone-cubic"),
            std::string::npos);
  EXPECT_NE(why("motion,rests\nmotion,rests\n" + rows).find(":2: found 'motion,rests', allowed the header"),
            std::string::npos);
  EXPECT_NE(why("pace,2\n" + rows).find(":1: found 'pace,2', allowed the header"), std::string::npos);
  EXPECT_NE(why(rows + "motion,rests\n").find(":5: found 2 columns"), std::string::npos);
}

TEST(GripperScript, WhatIsWrittenReadsBack) {
  for (const char* header : {"time,hand,x,y,z,grip\n0,L,0,-0.5,100,1\n1.25,L,1e-6,2,3,0\n0.001,R,0.1,0,0,1\n",
                             "motion,monotone-cubic\ntime,hand,x,y,z,grip,turn_x,turn_y,turn_z\n"
                             "0,L,0,0,0,1,0,0,0\n2,L,0,0,1,1,720,0,-90.5\n3,L,0,0,2,1,800,0,0\n"}) {
    const auto first = std::get<GripperScript>(load_gripper_script(write(header)));
    const auto text = gripper_script_text(first, "a remark");
    EXPECT_TRUE(text.starts_with("# a remark\n")) << text;
    const auto again = std::get<GripperScript>(load_gripper_script(write(text)));
    EXPECT_EQ(again.turns, first.turns);
    EXPECT_EQ(again.motion, first.motion);
    for (const double t_s : {0.0, 0.0005, 0.3, 1.25, 2.5, 9.0}) {
      for (const int hand : {0, 1}) {
        const auto a = sample(first.keys[hand], t_s), b = sample(again.keys[hand], t_s);
        EXPECT_EQ(a.grip, b.grip);
        for (std::size_t i = 0; i < 3; ++i) {
          EXPECT_NEAR(a.p_W_m[i], b.p_W_m[i], 1e-9);
          EXPECT_NEAR(a.turn_deg[i], b.turn_deg[i], 1e-9);
        }
      }
    }
  }
}

TEST(GripperScript, AByteOrderMarkIsNoData) {
  const auto read = load_gripper_script(write("\xEF\xBB\xBFtime,hand,x,y,z,grip\n0,L,0,0,0,1\n"));
  EXPECT_TRUE(std::holds_alternative<GripperScript>(read));
}

TEST(GripperScript, WhatIsQuotedIsShortAndHasNoControlCharacters) {
  EXPECT_NE(why_script_refused("0,L,0,\x1B[2J,0,1\n").find("found '\\x1B[2J'"), std::string::npos);
  EXPECT_LT(why_script_refused("0,L,0," + std::string(9000, '9') + ",0,1\n").size(), 250u);
}

TEST(GripperScript, SampleRestsAtKeysAndHoldsOutside) {
  const std::vector<GripKey> keys{{1.0, {0, 0, 0}, true}, {3.0, {2, 0, -4}, false}};
  EXPECT_FALSE(sample(keys, 0.5).grip);
  EXPECT_TRUE(sample(keys, 1.0).grip);
  EXPECT_EQ(sample(keys, 2.0).p_W_m, (Vec{1, 0, -2}));
  EXPECT_EQ(sample(keys, 2.0).v_W_m_per_s, (Vec{1.5, 0, -3}));
  EXPECT_EQ(sample(keys, 1.0).v_W_m_per_s, (Vec{0, 0, 0}));
  EXPECT_EQ(sample(keys, 9.0).p_W_m, (Vec{2, 0, -4}));
  EXPECT_FALSE(sample(keys, 9.0).grip);
  EXPECT_EQ(sample({}, 1.0).p_W_m, kParked_W_m);
}

TEST(GripperScript, SampledVelocityIsTheDerivativeOfThePosition) {
  std::vector<GripKey> keys{{0.0, {0, 0, 0}, true}, {0.7, {1, -2, 3}, true}, {1.1, {4, 0, 1}, true}};
  keys[1].v_W_m_per_s = {-1, 0.5, 2};  // passes through the second key, at rest in the others
  for (double t = 0.05; t < 1.1; t += 0.05) {
    const double h = 1e-6;
    for (std::size_t i = 0; i < 3; ++i) {
      const double slope = (sample(keys, t + h).p_W_m[i] - sample(keys, t - h).p_W_m[i]) / (2 * h);
      EXPECT_NEAR(sample(keys, t).v_W_m_per_s[i], slope, 1e-3);  // smooth also at t = 0.7, a key
    }
  }
}

}  // namespace
}  // namespace ligature::scene
