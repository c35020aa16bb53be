// Messages for Foxglove and PlotJuggler.
#include "host/viewer_topics.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <nlohmann/json.hpp>

#include "synthetic_log.hpp"

namespace ligature::host {
namespace {

using Json = nlohmann::json;

TEST(ViewerTopics, ATickHasEveryColumnOnce) {
  TickJson json;
  std::size_t fields = 0;
  for (const auto& text : json.write(test::tick_of(3), 1)) fields += Json::parse(text).size();
  EXPECT_EQ(fields, tick_columns().size() + 1);  // and the session
}

TEST(ViewerTopics, ANumberThatChangesAndReturnsIsRightEachTime) {
  TickJson json;
  auto tick = test::tick_of(0);
  for (const double value : {0.1, 0.1, -0.0, 0.1 + 0.2, 0.0, 1e-300}) {
    tick.f_device_N[0][2] = value;
    const double read = Json::parse(json.write(tick, 1)[kLeftTopic]).at("device_f_z_N");
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read), std::bit_cast<std::uint64_t>(value)) << value;
  }
}

TEST(ViewerTopics, WhatIsNotFiniteIsNull) {
  TickJson json;
  auto tick = test::tick_of(0);
  tick.potential_J = std::numeric_limits<double>::quiet_NaN();
  tick.kinetic_J = std::numeric_limits<double>::infinity();
  const Json rig = Json::parse(json.write(tick, 1)[kRigTopic]);
  EXPECT_TRUE(rig.at("potential_J").is_null());
  EXPECT_TRUE(rig.at("kinetic_J").is_null());
}

TEST(ViewerTopics, SchemasDescribeEveryFieldThatIsSent) {
  TickJson json;
  const auto& messages = json.write(test::tick_of(0), 2);
  for (std::size_t topic = 0; topic < messages.size(); ++topic) {
    const Json told = Json::parse(viewer_topics()[topic].schema).at("properties");
    const Json sent = Json::parse(messages[topic]);
    for (const auto& [name, value] : sent.items()) EXPECT_TRUE(told.contains(name)) << name;
  }
}

}  // namespace
}  // namespace ligature::host
