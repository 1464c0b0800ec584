#include "train/logging/event_file.hpp"

#include <cmath>
#include <csignal>
#include <limits>
#include <numeric>
#include <sstream>

#include <opencv2/imgcodecs.hpp>
#include <sys/resource.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/train/logging/event_reader.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using test::decode;
using test::Fields;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// No file of this process may grow beyond a size while the object lives: a disk that is full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t size_bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{size_bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

class EventFileTest : public testing::Test {
 protected:
  EventFile open(std::optional<std::int64_t> continue_after_step = {}) const {
    return EventFile(folder_, continue_after_step, [] { return 1700000000.25; });
  }
  static std::vector<Fields> events(EventFile& file) {
    file.flush();
    std::ifstream stream(file.path(), std::ios::binary);
    std::stringstream content;
    content << stream.rdbuf();
    return test::decode_records(content.str());
  }
  /// The Summary.Value of the last event.
  static Fields last_value(EventFile& file) { return decode(decode(events(file).back().text(5)).text(1)); }

  const test::ScratchFolder scratch_;
  const fs::path folder_ = scratch_ / "run";
};

TEST_F(EventFileTest, BeginsWithTheVersion) {
  EventFile file = open();
  const std::vector<Fields> all = events(file);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].text(3), "brain.Event:2");
  EXPECT_EQ(all[0].real(1), 1700000000.25);
  EXPECT_THAT(file.path().filename().string(), testing::StartsWith("events.out.tfevents.1700000000."));
}

TEST_F(EventFileTest, LaterFileOfTheSameSecondSortsLater) {
  const EventFile first = open();
  const EventFile second = open();
  EXPECT_LT(first.path().string(), second.path().string());
}

TEST_F(EventFileTest, ContinuedRunVoidsLaterSteps) {
  EventFile file = open(41);
  const std::vector<Fields> all = events(file);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[1].number(2), 42U);
  EXPECT_EQ(decode(all[1].text(7)).number(1), 1U);  // SessionLog.START
}

TEST_F(EventFileTest, Scalar) {
  EventFile file = open();
  file.scalar("loss/total", 300, 0.5);
  EXPECT_EQ(events(file).back().number(2), 300U);
  EXPECT_EQ(last_value(file).text(1), "loss/total");
  EXPECT_EQ(last_value(file).real32(2), 0.5F);
}

TEST_F(EventFileTest, ZerosAreWritten) {
  EventFile file = open();
  file.scalar("loss/total", 0, 0);
  EXPECT_EQ(events(file).back().number(2), 0U);
  EXPECT_EQ(last_value(file).real32(2), 0);
}

TEST_F(EventFileTest, ScalarThatIsNotANumberIsKept) {
  EventFile file = open();
  file.scalar("loss/total", 0, std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(std::isnan(last_value(file).real32(2)));
}

TEST_F(EventFileTest, ImageIsAPngOfTheSamePixels) {
  cv::Mat image(5, 7, CV_8UC3);
  cv::randu(image, 0, 256);
  EventFile file = open();
  file.image("depth", 3, image);
  const Fields written = decode(last_value(file).text(4));
  EXPECT_EQ(written.number(1), 5U);
  EXPECT_EQ(written.number(2), 7U);
  EXPECT_EQ(written.number(3), 3U);
  const std::string& png = written.text(4);
  const cv::Mat decoded = cv::imdecode(std::vector<char>(png.begin(), png.end()), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(decoded.type(), image.type());
  EXPECT_EQ(cv::norm(decoded, image, cv::NORM_INF), 0);
}

TEST_F(EventFileTest, ImageOfAnotherTypeIsRefused) {
  EventFile file = open();
  EXPECT_THROW(file.image("depth", 0, cv::Mat()), std::invalid_argument);
  EXPECT_THROW(file.image("depth", 0, cv::Mat(2, 2, CV_32FC1)), std::invalid_argument);
}

TEST_F(EventFileTest, HistogramCountsEveryFiniteValueOnce) {
  std::vector<float> values(61);
  std::iota(values.begin(), values.end(), -30.F);  // -30 .. 30, two a bucket and the largest in the last
  values.push_back(std::numeric_limits<float>::infinity());
  values.push_back(std::numeric_limits<float>::quiet_NaN());
  EventFile file = open();
  file.histogram("weights", 1, values);
  const Fields written = decode(last_value(file).text(5));
  EXPECT_EQ(written.real(1), -30);
  EXPECT_EQ(written.real(2), 30);
  EXPECT_EQ(written.real(3), 61);
  EXPECT_EQ(written.real(4), 0);
  EXPECT_EQ(written.real(5), 2.0 * 30 * 31 * 61 / 6);  // sum of squares
  std::vector<double> counts(30, 2);
  counts.back() = 3;
  EXPECT_EQ(test::unpack_reals(written.text(7)), counts);
  EXPECT_EQ(test::unpack_reals(written.text(6)).front(), -28);
  EXPECT_EQ(test::unpack_reals(written.text(6)).back(), 30);
}

TEST_F(EventFileTest, HistogramOfEqualValuesHasOneBucket) {
  EventFile file = open();
  file.histogram("weights", 1, {4, 4, 4});
  const Fields written = decode(last_value(file).text(5));
  EXPECT_THAT(test::unpack_reals(written.text(6)), ElementsAre(4));
  EXPECT_THAT(test::unpack_reals(written.text(7)), ElementsAre(3));
}

TEST_F(EventFileTest, HistogramOfNothingIsEmpty) {
  EventFile file = open();
  file.histogram("weights", 1, {});
  const Fields written = decode(last_value(file).text(5));
  EXPECT_EQ(written.real(3), 0);
  EXPECT_THAT(test::unpack_reals(written.text(7)), ElementsAre(0));
}

TEST_F(EventFileTest, TextIsATensorOfThePluginText) {
  EventFile file = open();
  file.text("config", 0, "**bold**");
  const Fields value = last_value(file);
  EXPECT_EQ(decode(decode(value.text(9)).text(1)).text(1), "text");
  const Fields tensor = decode(value.text(8));
  EXPECT_EQ(tensor.number(1), 7U);  // DT_STRING
  EXPECT_EQ(tensor.text(8), "**bold**");
}

TEST_F(EventFileTest, FullDiskNamesTheFile) {
  EventFile file = open();
  std::string message;
  {
    const FullDisk full(64);  // the version fits
    try {
      file.text("config", 0, std::string(1000, 'x'));
      file.flush();
    } catch (const DataError& e) {
      message = e.what();
    }
  }
  EXPECT_THAT(message, HasSubstr(file.path().string()));
  EXPECT_THAT(message, HasSubstr("free space"));
}

TEST_F(EventFileTest, FolderThatCannotBeMadeIsNamed) {
  std::ofstream{folder_};  // a file is in the way
  EXPECT_THROW(open(), DataError);
}

}  // namespace
}  // namespace alight
