#include "dataset/messages/decoders.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <set>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cloud_message.hpp"
#include "dataset/messages/jpeg_decoder.hpp"
#include "decoding.hpp"

namespace alight::testing {
namespace {

using ::testing::HasSubstr;

cv::Mat noisy(int type) {
  cv::Mat picture(40, 61, type);
  cv::RNG random(5);
  random.fill(picture, cv::RNG::UNIFORM, 0, 256);
  cv::blur(picture, picture, {5, 5});
  return picture;
}

struct Sample {
  LogRole role;
  std::string type;
  std::vector<std::uint8_t> bytes;
};

/// One message of every row of the table, but for the pictures, which have their own tests.
std::vector<Sample> one_of_every_row() {
  sensor_msgs::Imu imu;
  imu.orientation.w = 1;
  std::vector<Sample> samples = {
      {LogRole::kImage, "sensor_msgs/Image", bytes_of(image_message(kStart_ns, 5, 3, "bgr8"))},
      {LogRole::kLidar, "livox_ros_driver/CustomMsg", bytes_of(livox_message(kStart_ns, 4))},
      {LogRole::kLidar, "livox_ros_driver2/CustomMsg", bytes_of(livox_message(kStart_ns, 4))},
      {LogRole::kLidar, "sensor_msgs/PointCloud2",
       bytes_of(cloud_message(kStart_ns, velodyne_layout(), {{5, 0, 0, 1, 2, 0.05}, {6, 0, 0, 1, 2, 0.1}}))},
      {LogRole::kAttitude, "geometry_msgs/QuaternionStamped", bytes_of(attitude_message(kStart_ns))},
      {LogRole::kAttitude, "sensor_msgs/Imu", bytes_of(imu)},
      {LogRole::kPosition, "sensor_msgs/NavSatFix", bytes_of(fix_message(kStart_ns))},
      {LogRole::kPosition, "geometry_msgs/PointStamped", bytes_of(geometry_msgs::PointStamped())},
      {LogRole::kHeight, "std_msgs/Float32", bytes_of(float_message(1))},
      {LogRole::kCameraInfo, "sensor_msgs/CameraInfo", bytes_of(camera_info_message(kStart_ns))},
  };
  for (const LogRole role : {LogRole::kAttitude, LogRole::kPosition}) {
    samples.push_back({role, "geometry_msgs/PoseStamped", bytes_of(pose_message(kStart_ns))});
    samples.push_back({role, "nav_msgs/Odometry", bytes_of(odometry_message(kStart_ns))});
    samples.push_back({role, "geometry_msgs/TransformStamped", bytes_of(transform_message(kStart_ns))});
    samples.push_back({role, "tf2_msgs/TFMessage", bytes_of(tf_message(kStart_ns))});
    samples.push_back({role, "tf/tfMessage", bytes_of(tf_message(kStart_ns))});
  }
  return samples;
}

DecodeOptions world_to_body() {
  DecodeOptions options;
  options.frames = {"world", "body"};
  return options;
}

TEST(Decoders, EveryRowRefusesEveryCutOffMessageAndTrailingBytes) {
  const DecodeOptions options = world_to_body();
  std::set<std::pair<LogRole, std::string>> covered;
  for (const auto& [role, type, bytes] : one_of_every_row()) {
    covered.insert({role, type});
    EXPECT_TRUE(decode(role, type, bytes, kStart_ns, options).has_value()) << type;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const std::vector<std::uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_THROW(decode(role, type, cut, kStart_ns, options), DecodeError) << type << " " << size;
    }
    std::vector<std::uint8_t> longer = bytes;
    longer.push_back(0);
    EXPECT_THROW(decode(role, type, longer, kStart_ns, options), DecodeError) << type;
  }
  for (const Decoder& decoder : decoders()) {
    const bool picture = decoder.type == "sensor_msgs/CompressedImage";
    EXPECT_TRUE(picture || covered.count({decoder.role, decoder.type}) != 0) << decoder.type;
  }
}

/// Damaged bytes either still make a message or are a DecodeError: nothing else is thrown, nothing is read that is not
/// there (the sanitizers see that).
TEST(Decoders, DamagedMessagesAreDecodeErrorsAtWorst) {
  std::mt19937 random(5);
  int refused = 0;
  for (const auto& [role, type, bytes] : one_of_every_row()) {
    for (int i = 0; i < 3000; ++i) {
      std::vector<std::uint8_t> damaged = bytes;
      const int flips = 1 + i % 4;
      for (int k = 0; k < flips; ++k)
        damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
      try {
        decode(role, type, damaged, kStart_ns, world_to_body());
      } catch (const DecodeError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 10'000);
}

TEST(Decoders, AMessageTypeIsFoundOnlyForItsRole) {
  EXPECT_EQ(find_decoder(LogRole::kLidar, "sensor_msgs/Image"), nullptr);
  EXPECT_EQ(
      accepted_types(LogRole::kPosition),
      "sensor_msgs/NavSatFix, geometry_msgs/PointStamped, geometry_msgs/PoseStamped, nav_msgs/Odometry, "
      "geometry_msgs/TransformStamped, tf2_msgs/TFMessage, tf/tfMessage");
}

TEST(ImageDecoder, ColourBecomesBgr) {
  sensor_msgs::Image message = image_message(kStart_ns + 7, 1, 1, "rgb8");
  message.data = {10, 20, 30};
  const auto rgb = decoded<CameraImage>(LogRole::kImage, message);
  EXPECT_EQ(rgb.t_ns, kStart_ns + 7);
  EXPECT_EQ(rgb.image.at<cv::Vec3b>(0, 0), cv::Vec3b(30, 20, 10));
  message.encoding = "bgr8";
  EXPECT_EQ(decoded<CameraImage>(LogRole::kImage, message).image.at<cv::Vec3b>(0, 0), cv::Vec3b(10, 20, 30));
}

TEST(ImageDecoder, RowsMayBePadded) {
  sensor_msgs::Image message = image_message(kStart_ns, 2, 2, "mono8");
  message.step = 3;
  message.data = {1, 2, 99, 3, 4, 99};
  const cv::Mat image = decoded<CameraImage>(LogRole::kImage, message).image;
  ASSERT_EQ(image.type(), CV_8UC1);
  EXPECT_EQ(image.at<std::uint8_t>(0, 1), 2);
  EXPECT_EQ(image.at<std::uint8_t>(1, 0), 3);
}

TEST(ImageDecoder, AlphaIsDroppedAndChannelsAreSorted) {
  sensor_msgs::Image message = image_message(kStart_ns, 1, 1, "rgba8");
  message.step = 4;
  message.data = {10, 20, 30, 99};
  EXPECT_EQ(decoded<CameraImage>(LogRole::kImage, message).image.at<cv::Vec3b>(0, 0), cv::Vec3b(30, 20, 10));
  message.encoding = "bgra8";
  EXPECT_EQ(decoded<CameraImage>(LogRole::kImage, message).image.at<cv::Vec3b>(0, 0), cv::Vec3b(10, 20, 30));
}

TEST(ImageDecoder, SixteenBitGreyKeepsTheHighByteOfEitherByteOrder) {
  sensor_msgs::Image message = image_message(kStart_ns, 2, 1, "mono16");
  message.step = 5;  // padded to an odd step
  message.data = {0x34, 0x12, 0xFF, 0xFF, 0x77};
  const cv::Mat little = decoded<CameraImage>(LogRole::kImage, message).image;
  ASSERT_EQ(little.type(), CV_8UC1);
  EXPECT_EQ(little.at<std::uint8_t>(0, 0), 0x12);
  EXPECT_EQ(little.at<std::uint8_t>(0, 1), 0xFF);
  message.is_bigendian = 1;
  EXPECT_EQ(decoded<CameraImage>(LogRole::kImage, message).image.at<std::uint8_t>(0, 0), 0x34);
}

/// White and black in video range (16 .. 235).
TEST(ImageDecoder, YuvPairsShareTheirColour) {
  sensor_msgs::Image message = image_message(kStart_ns, 2, 1, "yuv422");
  message.step = 4;
  message.data = {128, 235, 128, 16};  // u y v y
  const cv::Mat uyvy = decoded<CameraImage>(LogRole::kImage, message).image;
  EXPECT_EQ(uyvy.at<cv::Vec3b>(0, 0), cv::Vec3b(255, 255, 255));
  EXPECT_EQ(uyvy.at<cv::Vec3b>(0, 1), cv::Vec3b(0, 0, 0));
  message.encoding = "yuv422_yuy2";
  message.data = {235, 128, 16, 128};
  EXPECT_EQ(cv::norm(decoded<CameraImage>(LogRole::kImage, message).image, uyvy, cv::NORM_INF), 0);
  message.width = 1;
  EXPECT_THAT(error(LogRole::kImage, message), HasSubstr("odd width"));
}

/// A flat red scene seen through each pattern: only the pixels under a red filter are bright.
TEST(ImageDecoder, BayerPatternsKeepTheColour) {
  const std::vector<std::pair<std::string, cv::Point>> red_pixel = {
      {"bayer_rggb8", {0, 0}}, {"bayer_grbg8", {1, 0}}, {"bayer_gbrg8", {0, 1}}, {"bayer_bggr8", {1, 1}}};
  for (const auto& [encoding, red] : red_pixel) {
    sensor_msgs::Image message = image_message(kStart_ns, 8, 8, encoding);
    for (int v = 0; v < 8; ++v) {
      for (int u = 0; u < 8; ++u) {
        message.data[static_cast<std::size_t>(v * 8 + u)] = (u % 2 == red.x && v % 2 == red.y) ? 200 : 0;
      }
    }
    const auto pixel = decoded<CameraImage>(LogRole::kImage, message).image.at<cv::Vec3b>(4, 4);
    EXPECT_EQ(pixel, cv::Vec3b(0, 0, 200)) << encoding;
  }
}

TEST(ImageDecoder, SizesThatLieAreRefused) {
  sensor_msgs::Image message = image_message(kStart_ns, 4, 3, "mono8");
  message.height = 4;
  EXPECT_THAT(error(LogRole::kImage, message), HasSubstr("12 bytes, but 4 rows of 4"));
  message = image_message(kStart_ns, 4, 3, "mono8");
  message.width = 5;
  EXPECT_THAT(error(LogRole::kImage, message), HasSubstr("5 pixels mono8"));
  message.width = 0xFFFFFFFF;
  message.height = 0xFFFFFFFF;
  EXPECT_THAT(error(LogRole::kImage, message), HasSubstr("4294967295"));
  message = image_message(kStart_ns, 4, 3, "mono8");
  message.encoding = "16UC1";
  EXPECT_THAT(error(LogRole::kImage, message), HasSubstr("encoding \"16UC1\" is none of mono8"));
}

sensor_msgs::CompressedImage compressed(const std::string& extension, const cv::Mat& image) {
  sensor_msgs::CompressedImage message;
  message.header = header_at(kStart_ns);
  message.format = "whatever the driver writes";
  cv::imencode(extension, image, message.data);
  return message;
}

/// tests/fuzz/types.txt; of several names of one message, one is enough.
TEST(Decoders, EveryDecodeFunctionHasAFuzzTarget) {
  std::ifstream file(ALIGHT_SOURCE_DIR "/tests/fuzz/types.txt");
  std::set<std::string> fuzzed;
  for (std::string type; std::getline(file, type);) fuzzed.insert(type);
  std::set<DecodeFunction> covered;
  for (const Decoder& decoder : decoders()) {
    if (fuzzed.count(decoder.type) != 0) covered.insert(decoder.decode);
  }
  for (const Decoder& decoder : decoders()) EXPECT_EQ(covered.count(decoder.decode), 1u) << decoder.type;
}

TEST(CompressedImageDecoder, JpegPixelsAreOpenCvs) {
  for (const cv::Mat& picture : {noisy(CV_8UC3), noisy(CV_8UC1)}) {
    for (const int quality : {40, 95}) {
      std::vector<std::uint8_t> bytes;
      cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
      const cv::Mat ours = decode_jpeg(bytes.data(), bytes.size(), 1000);
      const cv::Mat theirs = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
      ASSERT_EQ(ours.type(), theirs.type());
      EXPECT_EQ(cv::norm(ours, theirs, cv::NORM_INF), 0);
    }
  }
}

TEST(CompressedImageDecoder, ADamagedJpegIsNoImageAndAPaddedOneIs) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", noisy(CV_8UC3), bytes);
  std::vector<std::uint8_t> padded = bytes;
  padded.insert(padded.end(), 100, 0);
  EXPECT_NO_THROW(decode_jpeg(padded.data(), padded.size(), 1000));
  EXPECT_THROW(decode_jpeg(bytes.data(), bytes.size() / 2, 1000), DecodeError);
  EXPECT_THROW(decode_jpeg(bytes.data(), bytes.size(), 30), DecodeError);
  std::vector<std::uint8_t> scratched = bytes;
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 40; ++i) scratched[i] = 0xFF;
  EXPECT_THROW(decode_jpeg(scratched.data(), scratched.size(), 1000), DecodeError);
}

TEST(CompressedImageDecoder, ReadsJpegAndPng) {
  const cv::Mat colour(48, 64, CV_8UC3, cv::Scalar(200, 100, 50));
  const cv::Mat from_jpeg = decoded<CameraImage>(LogRole::kImage, compressed(".jpg", colour)).image;
  EXPECT_LE(cv::norm(from_jpeg, colour, cv::NORM_INF), 3);
  const cv::Mat from_png = decoded<CameraImage>(LogRole::kImage, compressed(".png", colour)).image;
  EXPECT_EQ(cv::norm(from_png, colour, cv::NORM_INF), 0);
  const cv::Mat grey(48, 64, CV_8UC1, cv::Scalar(77));
  EXPECT_EQ(decoded<CameraImage>(LogRole::kImage, compressed(".png", grey)).image.type(), CV_8UC1);
}

TEST(CompressedImageDecoder, RefusesEveryCutOffPicture) {
  cv::Mat noise(48, 64, CV_8UC3);
  cv::randu(noise, 0, 255);
  for (const char* extension : {".jpg", ".png"}) {
    const sensor_msgs::CompressedImage whole = compressed(extension, noise);
    for (const double share : {0.0, 0.01, 0.3, 0.7, 0.99}) {
      sensor_msgs::CompressedImage cut = whole;
      cut.data.resize(static_cast<std::size_t>(share * static_cast<double>(whole.data.size())));
      EXPECT_NE(error(LogRole::kImage, cut), "") << extension << " " << share;
    }
  }
}

TEST(CompressedImageDecoder, RefusesOtherPixelTypes) {
  const cv::Mat deep(4, 4, CV_16UC1, cv::Scalar(1000));
  EXPECT_THAT(error(LogRole::kImage, compressed(".png", deep)), HasSubstr("neither 8-bit grey"));
}

TEST(LivoxDecoder, EveryPointHasItsOwnTime) {
  livox_ros_driver::CustomMsg message = livox_message(kStart_ns, 3);
  message.timebase = 5;  // the sensor's own clock must not matter
  const auto packet = decoded<LidarPacket>(LogRole::kLidar, message);
  ASSERT_EQ(packet.returns.size(), 3u);
  EXPECT_EQ(packet.t_ns, kStart_ns);
  EXPECT_EQ(packet.returns[2].t_ns, kStart_ns + message.points[2].offset_time);
  EXPECT_EQ(packet.returns[2].p_lidar,
            Eigen::Vector3f(message.points[2].x, message.points[2].y, message.points[2].z));
  EXPECT_EQ(packet.returns[2].reflectivity, 2);
}

TEST(LivoxDecoder, DropsAndCountsWhatIsNoEcho) {
  livox_ros_driver::CustomMsg message = livox_message(kStart_ns, 6);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  message.points[0].x = message.points[0].y = message.points[0].z = 0;
  message.points[1].y = nan;
  message.points[2].x = inf;
  message.points[3].x = 1000;
  message.points[4].x = 0.1F;
  message.points[4].y = message.points[4].z = 0;
  const auto packet = decoded<LidarPacket>(LogRole::kLidar, message);
  EXPECT_EQ(packet.returns.size(), 1u);
  EXPECT_EQ(packet.dropped, 5);
}

TEST(LivoxDecoder, CountsThatLieAreRefused) {
  livox_ros_driver::CustomMsg message = livox_message(kStart_ns, 3);
  message.point_num = 4;
  EXPECT_THAT(error(LogRole::kLidar, message), HasSubstr("point_num is 4, but 3 points follow"));
  std::vector<std::uint8_t> bytes = bytes_of(livox_message(kStart_ns, 0));
  const std::uint32_t huge = 0xFFFFFFFF;  // both counts agree on 80 GB
  std::memcpy(bytes.data() + bytes.size() - 4, &huge, 4);
  std::memcpy(bytes.data() + bytes.size() - 12, &huge, 4);
  EXPECT_THAT(message_of<DecodeError>([&] { decode(LogRole::kLidar, "livox_ros_driver/CustomMsg", bytes); }),
              HasSubstr("4294967295 points announced, but 0 bytes"));
}

TEST(QuaternionDecoder, NormalisesAndRefusesTheZeroQuaternion) {
  geometry_msgs::QuaternionStamped message = attitude_message(kStart_ns);
  message.quaternion.w = 0.8;
  message.quaternion.z = 0.6001;
  const auto sample = decoded<AttitudeSample>(LogRole::kAttitude, message);
  EXPECT_NEAR(sample.q_world_imu.norm(), 1, 1e-15);
  EXPECT_NEAR(sample.q_world_imu.z(), 0.6, 1e-3);
  message.quaternion.w = message.quaternion.z = 0;
  EXPECT_THAT(error(LogRole::kAttitude, message), HasSubstr("quaternion of length 0"));
  message.quaternion.w = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error(LogRole::kAttitude, message), "");
}

TEST(ImuDecoder, GivesItsOrientation) {
  sensor_msgs::Imu message;
  message.header = header_at(kStart_ns + 3);
  message.orientation.x = 1;
  message.angular_velocity.x = 9;
  const auto sample = decoded<AttitudeSample>(LogRole::kAttitude, message);
  EXPECT_EQ(sample.t_ns, kStart_ns + 3);
  EXPECT_EQ(sample.q_world_imu.x(), 1);
  message.orientation_covariance[0] = -1;  // "no orientation" in sensor_msgs/Imu
  EXPECT_FALSE(decode(LogRole::kAttitude, "sensor_msgs/Imu", bytes_of(message)).has_value());
}

TEST(FixDecoder, GivesThePositionUnlessThereIsNoFix) {
  sensor_msgs::NavSatFix message = fix_message(kStart_ns);
  const auto sample = decoded<PositionSample>(LogRole::kPosition, message);
  const auto& fix = std::get<GeodeticPosition>(sample.position);
  EXPECT_EQ(fix.latitude_deg, message.latitude);
  EXPECT_EQ(fix.longitude_deg, message.longitude);
  EXPECT_EQ(fix.altitude_m, message.altitude);
  message.status.status = sensor_msgs::NavSatStatus::STATUS_NO_FIX;
  EXPECT_FALSE(decode(LogRole::kPosition, "sensor_msgs/NavSatFix", bytes_of(message)).has_value());
  message.status.status = 0;
  message.latitude = 91;
  EXPECT_THAT(error(LogRole::kPosition, message), HasSubstr("latitude 91"));
  message.latitude = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error(LogRole::kPosition, message), "");
}

TEST(HeightDecoder, TakesTheReceiveTime) {
  const auto result = decode(LogRole::kHeight, "std_msgs/Float32", bytes_of(float_message(12.5F)), 42);
  const auto sample = std::get<HeightSample>(result.value());
  EXPECT_EQ(sample.t_ns, 42);
  EXPECT_EQ(sample.height_m, 12.5);
  EXPECT_NE(error(LogRole::kHeight, float_message(std::numeric_limits<float>::quiet_NaN())), "");
}

TEST(Stamps, TheReceiveTimeCountsWhereTheConfigurationSaysSo) {
  DecodeOptions options;
  options.stamp = StampSource::kReceive;
  const std::int64_t receive_ns = kStart_ns + 5'000'000;
  EXPECT_EQ(
      decoded<AttitudeSample>(LogRole::kAttitude, attitude_message(kStart_ns), options, receive_ns).t_ns,
      receive_ns);
  EXPECT_EQ(
      decoded<PositionSample>(LogRole::kPosition, odometry_message(kStart_ns), options, receive_ns).t_ns,
      receive_ns);
  EXPECT_EQ(decoded<CameraImage>(LogRole::kImage, image_message(7, 4, 4, "mono8"), options, receive_ns).t_ns,
            receive_ns);
  const auto packet = decoded<LidarPacket>(LogRole::kLidar, livox_message(12'345, 3), options, receive_ns);
  EXPECT_EQ(packet.returns[1].t_ns, receive_ns + livox_message(0, 3).points[1].offset_time);
}

TEST(HeaderReading, RefusesAStampWithTooManyNanoseconds) {
  std::vector<std::uint8_t> bytes = bytes_of(attitude_message(kStart_ns));
  const std::uint32_t too_many = 1'000'000'000;
  std::memcpy(bytes.data() + 8, &too_many, 4);
  EXPECT_THAT(
      message_of<DecodeError>([&] { decode(LogRole::kAttitude, "geometry_msgs/QuaternionStamped", bytes); }),
      HasSubstr("stamp"));
}

}  // namespace
}  // namespace alight::testing
