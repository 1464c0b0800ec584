#include "infer/web/access.hpp"

#include <gtest/gtest.h>

namespace alight {
namespace {

TEST(RandomToken, IsLongAndNeverTheSame) {
  const std::string token = random_token();
  EXPECT_EQ(token.size(), 32U);
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(token, random_token());
}

TEST(EqualInConstantTime, OnlyTheSameTextIsEqual) {
  EXPECT_TRUE(equal_in_constant_time("correct horse", "correct horse"));
  EXPECT_FALSE(equal_in_constant_time("correct horse", "correct horsf"));
  EXPECT_FALSE(equal_in_constant_time("correct horse", "correct hors"));
  EXPECT_FALSE(equal_in_constant_time("correct hors", "correct horse"));
  EXPECT_FALSE(equal_in_constant_time("", "correct horse"));
  EXPECT_FALSE(equal_in_constant_time("correct horse", ""));
  // What repeats itself must not pass for its beginning.
  EXPECT_FALSE(equal_in_constant_time("abab", "ab"));
}

TEST(NamesThisServer, AddressesAndOwnNamesPassOtherNamesDoNot) {
  const ListenAddress here{"127.0.0.1", 8080};
  for (const char* host :
       {"127.0.0.1:8080", "127.0.0.1", "localhost:8080", "LocalHost", "[::1]:8080", "10.1.2.3:80"})
    EXPECT_TRUE(names_this_server(host, here)) << host;
  for (const char* host : {"", "evil.example:8080", "localhost.evil.example", "127.0.0.1.evil.example:8080",
                           ":8080", "[evil.example]:8080"})
    EXPECT_FALSE(names_this_server(host, here)) << host;
  EXPECT_TRUE(names_this_server("drone.local:8080", {"drone.local", 8080}));
}

TEST(ComesFromOwnPage, OnlyTheSameSchemeHostAndPort) {
  EXPECT_TRUE(comes_from_own_page("http://127.0.0.1:8080", "127.0.0.1:8080"));
  EXPECT_TRUE(comes_from_own_page("", "127.0.0.1:8080"));
  EXPECT_FALSE(comes_from_own_page("http://127.0.0.1:9090", "127.0.0.1:8080"));
  EXPECT_FALSE(comes_from_own_page("https://evil.example", "127.0.0.1:8080"));
  EXPECT_FALSE(comes_from_own_page("null", "127.0.0.1:8080"));
}

}  // namespace
}  // namespace alight
