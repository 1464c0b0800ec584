#include "infer/web/listen_address.hpp"

#include <gtest/gtest.h>

#include "foundation/errors.hpp"

namespace alight {
namespace {

TEST(ListenAddress, WithoutAHostItIsTheLoopback) {
  const ListenAddress address = parse_listen_address(":8080");
  EXPECT_EQ(address.text(), "127.0.0.1:8080");
  EXPECT_TRUE(address.loopback());
}

TEST(ListenAddress, WhatOnlyThisComputerReaches) {
  for (const char* text : {"127.0.0.1:1", "127.9.9.9:1", "localhost:1", "[::1]:1"})
    EXPECT_TRUE(parse_listen_address(text).loopback()) << text;
  for (const char* text :
       {"0.0.0.0:1", "192.168.1.5:1", "[::]:1", "drone.local:1", "localhost.evil:1", "127.evil:1"})
    EXPECT_FALSE(parse_listen_address(text).loopback()) << text;
}

TEST(ListenAddress, Version6KeepsItsBracketsInText) {
  const ListenAddress address = parse_listen_address("[::]:65535");
  EXPECT_EQ(address.host, "::");
  EXPECT_EQ(address.port, 65535);
  EXPECT_EQ(address.text(), "[::]:65535");
}

TEST(ListenAddress, WhatIsNotHostAndPortIsRefusedWithAnExample) {
  for (const char* text :
       {"", "8080", ":", ":http", ":65536", ":-1", ":8080x", "::1:8080", "127.0.0.1", "[drone]:1"}) {
    try {
      parse_listen_address(text);
      ADD_FAILURE() << text;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find("expected host:port, such as :8080"), std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace alight
