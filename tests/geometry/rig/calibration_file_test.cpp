#include "geometry/rig/calibration_file.hpp"

#include <fstream>

#include <opencv2/core/persistence.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/rig/rig.hpp"
#include "geometry/rig/stereo_rectification.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class CalibrationFile : public ::testing::Test {
 protected:
  fs::path file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  static std::string error_of(const fs::path& path, const std::string& entry = "",
                              const std::optional<cv::Size>& resolution = {}) {
    try {
      read_calibration_file(path, entry, resolution);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "";
  }
  const test::ScratchFolder folder_;
};

/// As ROS's camera_calibration writes it.
constexpr const char* kRos = R"(image_width: 640
image_height: 480
camera_name: narrow_stereo
camera_matrix:
  rows: 3
  cols: 3
  data: [601.5, 0., 320.25, 0., 602.5, 240.75, 0., 0., 1.]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.25, 0.0625, 0.001, -0.002, 0.]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
)";

TEST_F(CalibrationFile, ReadsRosCameraInfo) {
  const CalibratedCamera camera = read_calibration_file(file("ros.yaml", kRos), "", {});
  EXPECT_EQ(camera.camera.intrinsics, (PinholeIntrinsics{601.5, 602.5, 320.25, 240.75, 640, 480}));
  EXPECT_EQ(camera.camera.distortion_model, DistortionModel::kRadtan);
  EXPECT_EQ(camera.camera.distortion_coeffs, (std::vector<double>{-0.25, 0.0625, 0.001, -0.002, 0}));
  EXPECT_FALSE(camera.T_camera_previous.has_value());
}

/// Written by OpenCV itself.
TEST_F(CalibrationFile, ReadsWhatOpenCvWrites) {
  const fs::path path = folder_ / "opencv.yml";
  cv::FileStorage storage(path.string(), cv::FileStorage::WRITE);
  storage << "image_width" << 320 << "image_height" << 240;
  storage << "camera_matrix" << cv::Mat(cv::Matx33d(300.5, 0, 160, 0, 301.5, 120, 0, 0, 1));
  storage << "distortion_coefficients"
          << cv::Mat(std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}, true);
  storage.release();
  const CalibratedCamera camera = read_calibration_file(path, "", {});
  EXPECT_EQ(camera.camera.intrinsics, (PinholeIntrinsics{300.5, 301.5, 160, 120, 320, 240}));
  EXPECT_EQ(camera.camera.distortion_coeffs, (std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}));
  cv::FileStorage fisheye(path.string(), cv::FileStorage::WRITE);
  fisheye << "image_width" << 320 << "image_height" << 240 << "fisheye_model" << 1;
  fisheye << "camera_matrix" << cv::Mat(cv::Matx33d(300.5, 0, 160, 0, 301.5, 120, 0, 0, 1));
  fisheye << "distortion_coefficients" << cv::Mat(std::vector<double>{0.1, 0.2, 0.3, 0.4}, true);
  fisheye.release();
  EXPECT_EQ(read_calibration_file(path, "", {}).camera.distortion_model, DistortionModel::kEquidistant);
}

TEST_F(CalibrationFile, ReadsAnyCameraOfAKalibrChain) {
  const fs::path path = file("camchain.yaml", R"(cam0:
  camera_model: pinhole
  distortion_coeffs: [0.1, 0.2, 0.3, 0.4]
  distortion_model: equidistant
  intrinsics: [458.5, 457.5, 367.25, 248.5]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
cam2:
  T_cn_cnm1: [[1, 0, 0, -0.11], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
  camera_model: pinhole
  distortion_coeffs: []
  distortion_model: none
  intrinsics: [458.5, 457.5, 367.25, 250.5]
  resolution: [752, 480]
  timeshift_cam_imu: -0.004
  rostopic: /cam2/image_raw
)");
  EXPECT_EQ(read_calibration_file(path, "", {}).camera.distortion_model, DistortionModel::kEquidistant);
  const CalibratedCamera camera = read_calibration_file(path, "cam2", {});
  EXPECT_EQ(camera.camera.intrinsics.cy_px, 250.5);
  EXPECT_EQ(camera.T_camera_previous->translation().x(), -0.11);
  EXPECT_EQ(camera.timeshift_cam_imu_s, -0.004);
  EXPECT_THAT(error_of(path, "cam1"), AllOf(HasSubstr("camchain.yaml"), HasSubstr("no entry cam1")));
}

TEST_F(CalibrationFile, MistakesNameTheFile) {
  EXPECT_THAT(error_of(folder_ / "absent.yaml"),
              AllOf(HasSubstr("absent.yaml"), HasSubstr("calibration_file")));
  EXPECT_THAT(error_of(file("other.yaml", "a: 1\n")), HasSubstr("is no calibration that is known"));
  EXPECT_THAT(error_of(file("list.yaml", "- 1\n")), HasSubstr("no keys"));
  std::string text = kRos;
  text.replace(text.find("plumb_bob"), 9, "thin_lens");
  EXPECT_THAT(error_of(file("a.yaml", text)), HasSubstr("thin_lens"));
  text = kRos;
  text.replace(text.find("0., 0., 1."), 10, "0., 0.");
  EXPECT_THAT(error_of(file("b.yaml", text)),
              AllOf(HasSubstr("b.yaml"), HasSubstr("expected 9 numbers, got 8")));
  text = kRos;
  text.replace(text.find("image_width"), 11, "image_wide_");
  EXPECT_THAT(error_of(file("c.yaml", text)), HasSubstr("has no image_width"));
  EXPECT_THAT(error_of(file("d.yaml", kRos), "", cv::Size(320, 240)),
              HasSubstr("640x480 pixels, but the rig says 320x240"));
}

TEST_F(CalibrationFile, ARigTakesItsLensFromTheFileBesideIt) {
  file("left.yaml", kRos);
  const fs::path rig_file = file("rig.yaml", "cam0:\n  calibration_file: left.yaml\n  rostopic: /image\n");
  const Rig rig = load_rig(rig_file);
  EXPECT_EQ(rig.cam0.camera.intrinsics.fx_px, 601.5);
  EXPECT_EQ(rig.cam0.topic, "/image");
  EXPECT_EQ(format_rig(parse_rig(format_rig(rig), "again")), format_rig(rig)) << "needs no file any more";
}

/// The maker's own files, on machines that have them.
class MyntEyeFiles : public CalibrationFile {
 protected:
  void SetUp() override {
    if (!fs::is_directory(kData)) GTEST_SKIP() << kData << " is not there";
  }
  fs::path rig(const std::string& params, const std::string& resolution = "[640, 400]") const {
    const std::string lens = "  calibration_file: " + (fs::absolute(kData) / params).string() +
                             "\n  resolution: " + resolution + "\n  calibration_entry: ";
    return file("rig.yaml", "cam0:\n" + lens + "left\ncam1:\n" + lens + "right\n");
  }
  static const fs::path kData;
};
const fs::path MyntEyeFiles::kData =
    fs::path(ALIGHT_SOURCE_DIR) / ".." / "shared" / "data" / "calib_mynteye_s210a";

TEST_F(MyntEyeFiles, PinholeAndFisheyeAreReadAsTheMakerMeansThem) {
  const Rig pinhole = load_rig(rig("img.params.pinhole"));
  EXPECT_EQ(pinhole.cam0.camera.intrinsics.fx_px, 1.9739641213416058e+02);
  EXPECT_EQ(pinhole.cam1->camera.intrinsics.cy_px, 2.1871688038954812e+02);
  EXPECT_EQ(pinhole.cam0.camera.distortion_model, DistortionModel::kRadtan);
  EXPECT_EQ(pinhole.cam0.camera.distortion_coeffs[3], -3.7752063658256863e-03);
  const Rig fisheye = load_rig(rig("img.params.equidistant"));
  EXPECT_EQ(fisheye.cam0.camera.distortion_model, DistortionModel::kEquidistant);
  EXPECT_EQ(fisheye.cam0.camera.intrinsics.fx_px, 3.6797709792391299e+02);
  EXPECT_EQ(fisheye.cam0.camera.distortion_coeffs[0], -1.3549950401924169e-02);
  for (const Rig& each : {pinhole, fisheye}) {
    EXPECT_NEAR(each.T_cam1_cam0.translation().x(), -0.0822702, 1e-7)
        << "millimetres, the right eye to the right";
    EXPECT_NEAR(StereoRectifier(each).rig().baseline_m, 0.0823, 1e-4);
  }
}

TEST_F(MyntEyeFiles, TheResolutionIsChosen) {
  EXPECT_EQ(load_rig(rig("img.params.pinhole", "[1280, 800]")).cam0.camera.intrinsics.width_px, 1280);
  EXPECT_THAT(error_of(kData / "img.params.pinhole", "left"),
              AllOf(HasSubstr("set resolution"), HasSubstr("640x400, 1280x800")));
  EXPECT_THAT(error_of(kData / "img.params.pinhole", "left", cv::Size(752, 480)), HasSubstr("752x480"));
  EXPECT_THAT(error_of(kData / "img.params.pinhole", "top", cv::Size(640, 400)), HasSubstr("left or right"));
  EXPECT_THAT(error_of(kData / "imu.params", "left"), HasSubstr("is no calibration that is known"));
}

}  // namespace
}  // namespace alight
