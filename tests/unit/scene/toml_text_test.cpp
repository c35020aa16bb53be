#include "protocol/scene/toml_text.hpp"

#include <gtest/gtest.h>

namespace ligature::scene {
namespace {

TEST(TomlText, ACharacterThatTheParserCannotBearIsRefusedWithItsLine) {
  const auto parsed = parse_toml("[suture]\nEI_N_m2 = \xCC\x9B-7\n", "a.toml");
  ASSERT_TRUE(std::holds_alternative<Error>(parsed));
  EXPECT_EQ(std::get<Error>(parsed).text,
            "a.toml:2: not TOML: a character outside ASCII, allowed in comments and in quotes");
}

TEST(TomlText, CommentsAndQuotesMayHoldAnything) {
  EXPECT_EQ(line_of_stray_character("\xEF\xBB\xBF" "a = 1  # \xC3\xA9\n"), 0);
  EXPECT_EQ(line_of_stray_character("a = \"\xC3\xA9 \\\" \xC3\xA9\"  # x\nb = '\xC3\xA9\\'\n"), 0);
  EXPECT_EQ(line_of_stray_character("a = \"\"\"\xC3\xA9\n\"\xC3\xA9\"\n\"\"\"\nb = \"\"\n"), 0);
}

TEST(TomlText, TheFirstStrayCharacterOutsideThemIsFound) {
  EXPECT_EQ(line_of_stray_character("a = '\\'\xC3\xA9\n"), 1) << "no escapes between single quotes";
  EXPECT_EQ(line_of_stray_character("# '\nb = \xC3\xA9\n"), 2);
  EXPECT_EQ(line_of_stray_character("a = 'open\nb = \xC3\xA9\n"), 2) << "the parser stops at the first line anyhow";
  EXPECT_EQ(line_of_stray_character("a = \"\"\"\n\n\"\"\"\xC3\xA9"), 3);
}

}  // namespace
}  // namespace ligature::scene
