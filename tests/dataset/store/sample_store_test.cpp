#include "dataset/store/sample_store.hpp"

#include <cmath>

#include <opencv2/imgcodecs.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/sensors/test_flight.hpp"
#include "tests/support/file_text.hpp"

namespace alight::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class SampleStore : public ::testing::Test {
 protected:
  SampleStore() {
    cv::RNG random(3);
    sample_.left = cv::Mat(9, 11, CV_8UC3);
    sample_.right = cv::Mat(9, 11, CV_8UC3);
    random.fill(sample_.left, cv::RNG::UNIFORM, 0, 256);
    random.fill(sample_.right, cv::RNG::UNIFORM, 0, 256);
    sample_.sparse = SparseDepth::empty(sample_.left.size());
    sample_.sparse.depth_m.at<float>(2, 3) = 12.5F;
    sample_.sparse.offset_us.at<std::int32_t>(2, 3) = -731'000;
    sample_.sparse.depth_m.at<float>(8, 10) = 255.0F;
    sample_.sparse.offset_us.at<std::int32_t>(8, 10) = 0;
    sample_.dense_m = cv::Mat(9, 11, CV_32FC1, cv::Scalar(7.25));

    flight_.name = "a";
    flight_.samples = 2;
    flight_.has_right = true;
    flight_.has_dense = true;
    flight_.dropped = {{"images without a pose", 3}, {"odd \"reason\": x", 4}};
    create_flight_folders(dir_, flight_);
    write_sample(dir_, flight_, 0, sample_, 1);
    write_samples(dir_, "a", rows());
    write_dataset_info(dir_, info());
  }

  static std::vector<SampleRow> rows() {
    std::vector<SampleRow> rows(2);
    rows[0].t_ns = kStart_ns + 1;
    rows[0].next = 1;
    rows[0].points = 9;
    rows[0].pixels = 2;
    rows[0].T_world_camera.linear() =
        Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    rows[0].T_world_camera.translation() << 1.25, -1234.5, 88;
    rows[1].index = 1;
    rows[1].t_ns = kStart_ns + 2;
    rows[1].previous = 0;
    rows[1].height_m = 31.5;
    return rows;
  }

  DatasetInfo info() const {
    DatasetInfo info;
    info.rig.intrinsics = {440, 440.5, 175.5, 175.25, 11, 9};
    info.rig.baseline_m = 0.08;
    info.rig.T_camera_imu.translation() << 0.1, 0.2, 0.3;
    info.window_before_s = 1;
    info.window_after_s = 0.5;
    info.accumulation_s = 1.5;
    info.flights = {flight_};
    info.config = "rig: x.yaml  # comment\nlog:\n  a: \"b\"\n";
    return info;
  }

  std::string info_error() {
    return message_of<DataError>([&] { read_dataset_info(dir_); });
  }
  std::string sample_error() {
    return message_of<DataError>([&] { read_sample(dir_, flight_, rows()[0], true); });
  }
  /// Replaces a text in a file.
  void edit(const fs::path& file, const std::string& from, const std::string& to) {
    std::string text = test::file_text(dir_ / file);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << text;
    write_bytes(dir_ / file, text.replace(at, from.size(), to));
  }

  ScratchFolder folder_;
  fs::path dir_ = folder_.path();
  FlightEntry flight_;
  Sample sample_;
};

double difference(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF); }

TEST_F(SampleStore, PicturesComeBackBitForBit) {
  const Sample read = read_sample(dir_, flight_, rows()[0], true);
  EXPECT_EQ(difference(read.left, sample_.left), 0);
  EXPECT_EQ(difference(read.right, sample_.right), 0);
  EXPECT_EQ(difference(read.sparse.depth_m, sample_.sparse.depth_m), 0);
  EXPECT_EQ(difference(read.sparse.offset_us, sample_.sparse.offset_us), 0);
  EXPECT_EQ(difference(read.dense_m, sample_.dense_m), 0);
}

TEST_F(SampleStore, DenseIsReadOnlyWhenAskedFor) {
  fs::remove_all(dir_ / "a" / "dense");
  EXPECT_TRUE(read_sample(dir_, flight_, rows()[0], false).dense_m.empty());
  EXPECT_THAT(sample_error(), HasSubstr("dense/000000.png: is missing"));
}

TEST_F(SampleStore, OffsetsRoundToMillisecondsAndZeroIsAnOffset) {
  SparseDepth sparse = SparseDepth::empty({3, 1});
  sparse.depth_m.at<float>(0, 0) = 1;
  sparse.offset_us.at<std::int32_t>(0, 0) = 1499;
  sparse.depth_m.at<float>(0, 1) = 1;
  sparse.offset_us.at<std::int32_t>(0, 1) = -1500;
  const cv::Mat encoded = encode_offset(sparse);
  EXPECT_EQ(encoded.at<std::uint16_t>(0, 0), 32769);
  EXPECT_EQ(encoded.at<std::uint16_t>(0, 1), 32766);
  EXPECT_EQ(encoded.at<std::uint16_t>(0, 2), 0);
  EXPECT_EQ(decode_offset(encoded).at<std::int32_t>(0, 1), -2000);
}

TEST_F(SampleStore, TablesComeBack) {
  const auto read = read_samples(dir_, "a");
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].t_ns, kStart_ns + 1);
  EXPECT_EQ(read[0].next, 1);
  EXPECT_EQ(read[0].previous, -1);
  EXPECT_EQ(read[0].points, 9);
  EXPECT_EQ(read[0].pixels, 2);
  EXPECT_TRUE(std::isnan(read[0].height_m));
  EXPECT_EQ(read[1].height_m, 31.5);
  EXPECT_TRUE(read[0].T_world_camera.isApprox(rows()[0].T_world_camera, 1e-9));
}

TEST_F(SampleStore, InfoComesBack) {
  const DatasetInfo read = read_dataset_info(dir_);
  EXPECT_EQ(read.format_version, kDatasetFormatVersion);
  EXPECT_TRUE(read.rig.intrinsics == info().rig.intrinsics);
  EXPECT_EQ(read.rig.baseline_m, 0.08);
  EXPECT_TRUE(read.rig.T_camera_imu.isApprox(info().rig.T_camera_imu));
  EXPECT_EQ(read.accumulation_s, 1.5);
  EXPECT_EQ(read.config, info().config);
  ASSERT_EQ(read.flights.size(), 1u);
  EXPECT_EQ(read.flights[0].dropped, flight_.dropped);
  EXPECT_TRUE(read.flights[0].has_right);
}

TEST_F(SampleStore, AFolderThatIsNoDatasetSaysHowToMakeOne) {
  fs::remove(dir_ / "dataset.yaml");
  EXPECT_THAT(info_error(), AllOf(HasSubstr("dataset.yaml"), HasSubstr("alight-dataset build")));
}

TEST_F(SampleStore, ANewerFormatIsRefusedWhateverElseTheFileHolds) {
  edit("dataset.yaml", "format_version: 1", "format_version: 2\nnew_key: 1");
  EXPECT_THAT(info_error(), AllOf(HasSubstr("dataset.yaml"), HasSubstr("version 2"), HasSubstr("newer")));
}

TEST_F(SampleStore, DamagedInfoNamesTheLine) {
  edit("dataset.yaml", "fx_px: 440", "fx_px: -1");
  EXPECT_THAT(info_error(), HasSubstr("rig.fx_px"));
  edit("dataset.yaml", "format_version: 1", "format_ver: 1");
  EXPECT_THAT(info_error(), HasSubstr("no format_version"));
  write_bytes(dir_ / "dataset.yaml", "a: [1\nb");
  EXPECT_THAT(info_error(), HasSubstr("dataset.yaml:"));
  write_bytes(dir_ / "dataset.yaml", "just words");
  EXPECT_THAT(info_error(), HasSubstr("dataset.yaml"));
}

TEST_F(SampleStore, AFlightNameCannotLeaveTheFolder) {
  edit("dataset.yaml", "name: a", "name: ../a");
  EXPECT_THAT(info_error(), HasSubstr("../a"));
}

TEST_F(SampleStore, EveryCutOffPictureIsNamed) {
  for (const char* name : {"left", "right", "depth", "offset", "dense"}) {
    const fs::path path = dir_ / "a" / name / "000000.png";
    const std::string whole = test::file_text(path);
    for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 40) {
      write_bytes(path, whole.substr(0, size));
      EXPECT_THAT(sample_error(), AllOf(HasSubstr(path.string()), HasSubstr("cut off"))) << size;
    }
    fs::remove(path);
    EXPECT_THAT(sample_error(), AllOf(HasSubstr(path.string()), HasSubstr("missing")));
    write_bytes(path, whole);
  }
  EXPECT_EQ(sample_error(), "");
}

TEST_F(SampleStore, PicturesOfTheWrongSizeOrTypeAreNamed) {
  const fs::path depth = dir_ / "a" / "depth" / "000000.png";
  cv::imwrite(depth.string(), cv::Mat::zeros(9, 12, CV_16UC1));
  EXPECT_THAT(sample_error(), AllOf(HasSubstr(depth.string()), HasSubstr("12x9")));
  cv::imwrite(depth.string(), cv::Mat::zeros(9, 11, CV_8UC1));
  EXPECT_THAT(sample_error(), AllOf(HasSubstr(depth.string()), HasSubstr("pixel type")));
}

TEST_F(SampleStore, BadTableLinesAreNamed) {
  const auto error = [&] { return message_of<DataError>([&] { read_samples(dir_, "a"); }); };
  edit("a/samples.csv", "nan", "x");
  EXPECT_THAT(error(), AllOf(HasSubstr("samples.csv:2"), HasSubstr("height_m"), HasSubstr("\"x\"")));
  write_samples(dir_, "a", rows());
  edit("a/samples.csv", "31.500", "31.500,7");
  EXPECT_THAT(error(), AllOf(HasSubstr("samples.csv:3"), HasSubstr("more columns")));
  write_samples(dir_, "a", rows());
  edit("a/samples.csv", ",9,2,nan", "");
  EXPECT_THAT(error(), AllOf(HasSubstr("samples.csv:2"), HasSubstr("ends early")));
  write_samples(dir_, "a", rows());
  edit("a/samples.csv", "-1234.5", "inf");
  EXPECT_THAT(error(), HasSubstr("samples.csv:2"));
  auto wrong = rows();
  wrong[0].next = 5;
  write_samples(dir_, "a", wrong);
  EXPECT_THAT(error(), AllOf(HasSubstr("samples.csv:2"), HasSubstr("out of order")));
  fs::remove(dir_ / "a" / "samples.csv");
  EXPECT_THAT(error(), HasSubstr("samples.csv"));
}

}  // namespace
}  // namespace alight::testing
