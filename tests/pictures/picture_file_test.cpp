#include "pictures/picture_file.hpp"

#include <cstdint>

#include <opencv2/imgcodecs.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {
using ::testing::HasSubstr;
namespace fs = std::filesystem;

cv::Mat ramp() {
  cv::Mat picture(64, 64, CV_16UC1);
  for (int v = 0; v < picture.rows; ++v) {
    for (int u = 0; u < picture.cols; ++u)
      picture.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(1000 * v + u);
  }
  return picture;
}

class PictureFile : public ::testing::Test {
 protected:
  void expect_refused(const fs::path& path) const {
    try {
      write_picture(path, ramp());
      ADD_FAILURE() << path << " was written";
    } catch (const DataError& e) {
      EXPECT_THAT(e.what(), ::testing::StartsWith(path.string() + ": cannot be written"));
      EXPECT_THAT(e.what(), HasSubstr("name a picture file, as .png, in a folder that exists"));
    }
  }
  const test::ScratchFolder scratch_;
};

TEST_F(PictureFile, ComesBackAsItWasAtEveryCompression) {
  const fs::path plain = scratch_.path() / "plain.png";
  const fs::path small = scratch_.path() / "small.png";
  write_picture(plain, ramp(), 0);
  write_picture(small, ramp(), 9);
  EXPECT_LT(fs::file_size(small), fs::file_size(plain));
  for (const fs::path& path : {plain, small})
    EXPECT_EQ(cv::countNonZero(cv::imread(path.string(), cv::IMREAD_UNCHANGED) != ramp()), 0) << path;
}

TEST_F(PictureFile, WithoutAFolderOrAKnownEndingIsRefusedByName) {
  expect_refused(scratch_.path() / "absent" / "picture.png");
  expect_refused(scratch_.path() / "picture.unknown");
}

}  // namespace
}  // namespace alight
