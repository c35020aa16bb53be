#include "host/view/access.hpp"

#include <gtest/gtest.h>

#include "host/errors.hpp"
#include "host/view/live.hpp"
#include "tests/unit/host/synthetic_log.hpp"

namespace ligature::host::view {
namespace {

TEST(Access, OnlyPagesOfThisServerMayOpenTheSocket) {
  EXPECT_TRUE(is_own_origin("http://127.0.0.1:8737", "127.0.0.1:8737"));
  EXPECT_TRUE(is_own_origin("", "127.0.0.1:8737"));  // no Origin header: not a browser
  EXPECT_FALSE(is_own_origin("http://evil.example", "127.0.0.1:8737"));
  EXPECT_FALSE(is_own_origin("http://127.0.0.1:8738", "127.0.0.1:8737"));  // another server on this machine
  EXPECT_FALSE(is_own_origin("https://127.0.0.1:8737", "127.0.0.1:8737"));
  EXPECT_FALSE(is_own_origin("null", "127.0.0.1:8737"));  // a local file or a sandboxed frame
  EXPECT_FALSE(is_own_origin("http://", ""));
}

TEST(Access, NamesOfOtherSitesThatPointHereAreTurnedAway) {
  EXPECT_TRUE(is_own_host("127.0.0.1:8737", "lab"));
  EXPECT_TRUE(is_own_host("[::1]:8737", "lab"));
  EXPECT_TRUE(is_own_host("localhost:8737", "lab"));
  EXPECT_TRUE(is_own_host("lab:8737", "lab"));
  EXPECT_FALSE(is_own_host("rebind.evil.example:8737", "lab"));
  EXPECT_FALSE(is_own_host("127.0.0.1.evil.example", "lab"));
  EXPECT_FALSE(is_own_host("", ""));
  EXPECT_TRUE(is_own_host("[::1]", "lab"));
  for (const char* malformed :
       {"[::1", "[::1:8737", "[::1]x:8737", "127.0.0.1:8737@evil", "::1", "[]", ":8737", "[::1]]"})
    EXPECT_FALSE(is_own_host(malformed, "lab")) << malformed;
}

TEST(Access, AnEmptyTokenIsNobodys) {
  EXPECT_FALSE(is_token("", ""));
  EXPECT_FALSE(is_token("abc", ""));
  EXPECT_FALSE(is_token("abd", "abc"));
  EXPECT_FALSE(is_token("ab", "abc"));
  EXPECT_TRUE(is_token("abc", "abc"));
}

TEST(Access, EveryStartHasAnotherToken) {
  EXPECT_EQ(make_token().size(), 32U);
  EXPECT_NE(make_token(), make_token());
}

TEST(Access, BeyondThisMachineCommandsNeedTheFile) {
  const test::TestFolder folder;
  EXPECT_TRUE(access_for({.listen = "127.0.0.1", .port = 0}, "").gives_token);
  EXPECT_TRUE(access_for({.listen = "0.0.0.0", .port = 0}, "").token.empty());
  std::FILE* file = std::fopen(folder.file("token").c_str(), "w");
  std::fputs("0123456789abcdef\n", file);
  std::fclose(file);
  const Access open_access = access_for({.listen = "0.0.0.0", .port = 0}, folder.file("token"));
  EXPECT_EQ(open_access.token, "0123456789abcdef");
  EXPECT_FALSE(open_access.gives_token);
  EXPECT_THROW((void)read_token_file(folder.file("missing")), BadInput);
  file = std::fopen(folder.file("short").c_str(), "w");
  std::fputs("secret\n", file);
  std::fclose(file);
  EXPECT_THROW((void)read_token_file(folder.file("short")), BadInput);
}

TEST(Access, AnIpv6AddressStandsInBracketsInTheUrl) {
  EXPECT_EQ(url_of({.listen = "127.0.0.1", .port = 0}, 8737), "http://127.0.0.1:8737/");
  EXPECT_EQ(url_of({.listen = "::1", .port = 0}, 8737), "http://[::1]:8737/");
}

}  // namespace
}  // namespace ligature::host::view
