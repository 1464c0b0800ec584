#include <cstdlib>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "infer/replay/replay.hpp"
#include "tests/support/file_text.hpp"

namespace alight {
namespace {

/// The first line of a file, a comment that is written by hand.
std::string header_of(const std::string& text) { return text.substr(0, text.find('\n') + 1); }

/// The file says of itself that it holds the program's defaults, written out: it is its first line and what --print-config
/// prints. ALIGHT_WRITE_DEFAULTS=1 in the environment writes it anew.
template <class Config>
void expect_written_out(const std::string& name) {
  const std::string path = std::string(ALIGHT_SOURCE_DIR) + "/configs/" + name;
  const std::string text = test::file_text(path);
  const std::string wanted = header_of(text) + print_config(Config{});
  ASSERT_NE(header_of(text).find("defaults, written out"), std::string::npos) << path;
  if (std::getenv("ALIGHT_WRITE_DEFAULTS") != nullptr) std::ofstream(path) << wanted;
  EXPECT_EQ(text, wanted) << path << ": run this test with ALIGHT_WRITE_DEFAULTS=1";
}

TEST(WrittenDefaults, OfTheOnboardProgram) { expect_written_out<ReplayConfig>("infer/default.yaml"); }
TEST(WrittenDefaults, OfTheLandingSite) { expect_written_out<LandingConfig>("landing/default.yaml"); }

}  // namespace
}  // namespace alight
