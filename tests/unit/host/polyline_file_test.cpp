#include <gtest/gtest.h>

#include "host/errors.hpp"
#include "host/knot_command.hpp"
#include "host/polyline_file.hpp"
#include "synthetic_log.hpp"

namespace ligature::host {
namespace {

class PolylineFile : public ::testing::Test {
 protected:
  Polyline read(std::string_view text, std::optional<double> at_s = {}) {
    test::write_text(path_, text);
    return read_polyline_csv(path_, at_s);
  }
  std::string refusal(std::string_view text) {
    try {
      read(text);
    } catch (const BadInput& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos);
      return what.substr(path_.size());
    }
    return "accepted";
  }

  test::TestFolder folder_;
  std::string path_ = folder_.file("line.csv");
};

constexpr std::string_view kShapes =
    "t_s,node,x_m,y_m,z_m\n0,0,1,0,0\n0,1,2,0,0\n0,2,3,0,0\n0.5,0,4,0,0\n0.5,1,5,0,0\n0.5,2,6,0,0\n"
    "1,0,7,0,0\n1,1,8,0,0\n1,2,9,0,0\n";

TEST_F(PolylineFile, ReadsCoordinatesByName) {
  const auto line = read("# made by hand\nz,x,y,label\n3,1,2,9\n6, 4 ,5,9\r\n9,7,+8,9 # end\n\n");
  ASSERT_EQ(line.points.size(), 3U);
  EXPECT_EQ(line.points[0], (std::array{1.0, 2.0, 3.0}));
  EXPECT_EQ(line.points[2], (std::array{7.0, 8.0, 9.0}));
  EXPECT_FALSE(line.time_s);
}

TEST_F(PolylineFile, ReadsThreeNumbersARowWithoutHeader) {
  EXPECT_EQ(read("1,2,3\n4,5,6\n7,8,1e-3\n").points.size(), 3U);
}

TEST_F(PolylineFile, ReadsOtherSeparatorsCapitalsAndNumberedRows) {
  for (const auto text : {"X;Y;Z\n1;2;3\n4;5;6\n7;8;9\n", "1 2 3\n4\t5  6\n 7 8 9 \n", "x y z\n1 2 3\n4 5 6\n7 8 9",
                          "1 1 2 3\n2 4 5 6\n3 7 8 9\n", "1,1,2,3\n2,4,5,6\n3,7,8,9\n"}) {
    const auto line = read(text);
    ASSERT_EQ(line.points.size(), 3U) << text;
    EXPECT_EQ(line.points[1], (std::array{4.0, 5.0, 6.0})) << text;
  }
}

TEST_F(PolylineFile, TakesTheLastShapeOrTheNearest) {
  EXPECT_EQ(read(kShapes).points[0][0], 7.0);
  EXPECT_EQ(read(kShapes, 0.6).points[0][0], 4.0);
  EXPECT_EQ(read(kShapes, 0.6).time_s, 0.5);
  EXPECT_EQ(read(kShapes, -9.0).points[0][0], 1.0);
  EXPECT_EQ(read(kShapes, 99.0).points[0][0], 7.0);
}

TEST_F(PolylineFile, AShapeThatWasCutOffIsNotTaken) {
  std::string cut(kShapes.substr(0, kShapes.rfind("1,2,9")));
  const auto line = read(cut);
  EXPECT_EQ(line.points[0][0], 4.0);
  EXPECT_EQ(line.points.size(), 3U);
  EXPECT_TRUE(line.last_is_cut_off);
  EXPECT_FALSE(read(kShapes).last_is_cut_off);
  EXPECT_EQ(read(cut + "1,2,9").points[0][0], 4.0);  // cut off within a row
  EXPECT_EQ(read(cut, 99.0).points[0][0], 4.0);
  EXPECT_EQ(refusal("t_s,node,x,y,z\n0,0,1,2,3\n0,1,1,2"), ": its only shape is cut off; allowed: a whole one");
}

TEST_F(PolylineFile, AByteOrderMarkIsNoData) {
  EXPECT_EQ(read("\xEF\xBB\xBFx,y,z\n1,2,3\n4,5,6\n7,8,9\n").points.size(), 3U);
  EXPECT_EQ(read("\xEF\xBB\xBF"
                 "1,2,3\n4,5,6\n7,8,9\n")
                .points.size(),
            3U);
}

TEST_F(PolylineFile, WhatIsQuotedFitsOnALine) {
  EXPECT_EQ(refusal("x,y,z\n1,\x1B[31m,3\n"), ":2: found '\\x1B[31m', allowed a finite number");
  EXPECT_LT(refusal("x,y,z\n1," + std::string(5000, 'a') + ",3\n").size(), 150U);
}

TEST_F(PolylineFile, RefusesFoldersAndTextsWithoutEnd) {
  EXPECT_THROW(static_cast<void>(read_polyline_csv(folder_.path().string(), {})), BadInput);
  EXPECT_THROW(static_cast<void>(read_polyline_csv("/dev/zero", {})), BadInput);  // not a regular file
  EXPECT_FALSE(is_lcm_log("/dev/zero"));
  EXPECT_EQ(refusal(std::string((64U << 20) + 10, '7')), ": found more than 64 MB, allowed at most that");
}

TEST_F(PolylineFile, RefusesABadRowWithItsLine) {
  EXPECT_EQ(refusal("x,y,z\n1,2,3\n1,2\n"), ":3: found 2 fields, allowed 3");
  EXPECT_EQ(refusal("x,y,z\n# a\n1,two,3\n"), ":3: found 'two', allowed a finite number");
  EXPECT_EQ(refusal("x,y,z\n1,nan,3\n"), ":2: found 'nan', allowed a finite number");
  EXPECT_EQ(refusal("x,y,z\n1,1e999,3\n"), ":2: found '1e999', allowed a finite number");
  EXPECT_EQ(refusal("x,y,z\n1,,3\n"), ":2: found '', allowed a finite number");
  EXPECT_TRUE(refusal("x,y\n1,2\n").starts_with(":1: header"));
  EXPECT_TRUE(refusal("t_s,node,x,y,z\n0,0,1,2,3\n0,2,1,2,3\n").starts_with(":3: found node 2, allowed 1"));
  EXPECT_EQ(refusal("x,y,z\n1,2,3\n"), ": found 1 points, allowed 3 or more");
  EXPECT_EQ(refusal(""), ": found 0 points, allowed 3 or more");
  EXPECT_THROW(static_cast<void>(read_polyline_csv(folder_.file("missing.csv"), {})), BadInput);
}

TEST_F(PolylineFile, RefusesAHeaderThatHasAColumnTwice) {
  EXPECT_EQ(refusal("x,y,z,X\n1,2,3,4\n"), ":1: header 'x,y,z,X' has two columns for 'x', allowed one");
  EXPECT_TRUE(refusal("x,y,z,z_m\n1,2,3,4\n").ends_with("has two columns for 'z_m', allowed one"));
  EXPECT_TRUE(refusal("t_s,time,node,x,y,z\n").ends_with("has two columns for 'time', allowed one"));
  EXPECT_TRUE(refusal("t_s,node,node,x,y,z\n").ends_with("has two columns for 'node', allowed one"));
  EXPECT_EQ(read("x,y,z,,\n1,2,3,,\n4,5,6,,\n7,8,9,,\n").points.size(), 3U) << "what is not read may be doubled";
}

TEST_F(PolylineFile, ALogGivesItsLastOrNearestShape) {
  LogWriter log(folder_.file("a.lcmlog"), false);
  test::write(log, kThreadChannel, test::thread_of(1000, test::overhand_points(100)));
  test::write(log, kThreadChannel, test::thread_of(2000, test::straight_points(50)));
  log.write(0, kThreadChannel, {});
  log.close();
  const std::string path = folder_.file("a.lcmlog");
  EXPECT_TRUE(is_lcm_log(path));
  EXPECT_EQ(read_polyline_log(path, {}).time_s, 2.0);
  EXPECT_EQ(read_polyline_log(path, 1.2).points.size(), 102U);
}

TEST_F(PolylineFile, AnInvariantThatCouldNotBeComputedIsNull) {
  test::write_text(path_, "x,y,z\n0,0,0\n1,0,0\n0,0,0\n1,0,0\n");
  EXPECT_EQ(describe_knot({.file = path_, .closed = true, .json = true}),
            "{\"type\":\"unknown\",\"handedness\":\"none\",\"determinant\":null,\"alexander\":null,"
            "\"common_name\":null,\"candidates\":[]}\n");
  EXPECT_NE(describe_knot({.file = path_, .closed = true}).find("no invariant"), std::string::npos);
}

TEST_F(PolylineFile, TheKnotOfAFileIsPrintedAsTheDesignSays) {
  std::string csv = "x,y,z\n";
  for (const auto& p : test::overhand_points(100))
    csv += std::to_string(p[0]) + "," + std::to_string(p[1]) + "," + std::to_string(p[2]) + "\n";
  test::write_text(path_, csv);
  const auto line = describe_knot({.file = path_, .json = true});
  EXPECT_TRUE(line.starts_with("{\"type\":\"3_1\",\"handedness\":\"")) << line;
  EXPECT_TRUE(
      line.ends_with("\",\"determinant\":3,\"alexander\":[1,-1,1],\"common_name\":\"overhand\",\"candidates\":[]}\n"))
      << line;
  EXPECT_TRUE(describe_knot({.file = path_}).starts_with("3_1 "));
  EXPECT_THROW(static_cast<void>(describe_knot({.file = path_, .at_s = 1.0})), BadInput);
}

}  // namespace
}  // namespace ligature::host
