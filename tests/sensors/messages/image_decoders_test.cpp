
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sensors/messages/decoders.hpp"
#include "sensors/messages/jpeg_decoder.hpp"
#include "tests/sensors/messages/decoding.hpp"

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

}  // namespace
}  // namespace alight::testing
