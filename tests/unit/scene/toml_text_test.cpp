#include "protocol/scene/toml_text.hpp"

#include <gtest/gtest.h>

namespace ligature::scene {
namespace {

TEST(TomlText, ACharacterThatTheParserCannotBearIsRefusedWithItsLine) {
  const auto parsed = parse_toml("[suture]\nEI_N_m2 = \xCC\x9B-7\n", "a.toml");
  ASSERT_TRUE(std::holds_alternative<Error>(parsed));
  EXPECT_EQ(std::get<Error>(parsed).text,
            "a.toml:2: a character outside ASCII, allowed in comments; in quotes write \\u00e9 for it");
}

TEST(TomlText, CommentsMayHoldAnythingAndQuotesItsEscape) {
  EXPECT_EQ(line_of_stray_character("\xEF\xBB\xBF"
                                    "a = 1  # \xC3\xA9\n"),
            0);
  EXPECT_EQ(line_of_stray_character("a = \"#\\\"#\"  # \xC3\xA9\nb = '\\'  # \xC3\xA9\n"), 0);
  EXPECT_EQ(line_of_stray_character("a = \"\"\"#\n\"#\"\n\"\"\"  # \xC3\xA9\n"), 0);
  const auto parsed = parse_toml("a = \"\\u00e9\"", "a.toml");
  EXPECT_EQ(std::get<toml::table>(parsed)["a"].value<std::string>(), "\xC3\xA9");
}

TEST(TomlText, TheFirstStrayCharacterIsFound) {
  EXPECT_EQ(line_of_stray_character("a = '#\xC3\xA9'\n"), 1) << "what looks like a comment is in quotes";
  EXPECT_EQ(line_of_stray_character("# '\nb = \xC3\xA9\n"), 2) << "a quote in a comment opens none";
  EXPECT_EQ(line_of_stray_character("a = 'open\nb = \xC3\xA9\n"), 2) << "an open quote ends with its line";
  EXPECT_EQ(line_of_stray_character("a = \"\"\"\n\n#\xC3\xA9\"\"\""), 3);
}

}  // namespace
}  // namespace ligature::scene
