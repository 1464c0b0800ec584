#include "infer/autopilot/autopilot_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"

namespace alight {
namespace {

using ::testing::HasSubstr;

std::string error_of(const std::string& text) {
  try {
    parse_config<AutopilotConfig>(text, "file.yaml");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return {};
}

TEST(AutopilotConfig, IsOffByDefaultAndReadsItsOwnPrint) {
  const AutopilotConfig defaults;
  EXPECT_FALSE(defaults.connection);
  const std::string printed = print_config(defaults);
  EXPECT_THAT(printed, HasSubstr("connection: none"));
  EXPECT_EQ(print_config(parse_config<AutopilotConfig>(printed, "printed")), printed);
}

TEST(AutopilotConfig, TakesBothKindsOfConnection) {
  EXPECT_EQ(*parse_config<AutopilotConfig>("connection: udp:localhost:14550", "f").connection,
            "udp:localhost:14550");
  EXPECT_EQ(*parse_config<AutopilotConfig>("connection: serial:/dev/ttyTHS1:921600", "f").connection,
            "serial:/dev/ttyTHS1:921600");
}

TEST(AutopilotConfig, NamesTheLineOfAConnectionThatIsNone) {
  EXPECT_THAT(error_of("system_id: 1\nconnection: tcp:localhost:5760"), HasSubstr("file.yaml:2"));
  EXPECT_THAT(error_of("connection: serial:/dev/ttyTHS1:921601"), HasSubstr("usual baud rate"));
}

TEST(AutopilotConfig, KeepsToMavlinksNumbers) {
  EXPECT_THAT(error_of("system_id: 0"), HasSubstr("system_id"));
  EXPECT_THAT(error_of("component_id: 256"), HasSubstr("component_id"));
  EXPECT_THAT(error_of("max_rate_hz: 0"), HasSubstr("max_rate_hz"));
}

}  // namespace
}  // namespace alight
