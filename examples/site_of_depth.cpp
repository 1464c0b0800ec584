// The largest safe circle in one depth map of a camera that looks straight down.
//   site_of_depth [depth.png]      16-bit PNG in 1/256 m; without: level ground 12 m below
#include <cstdio>

#include <alight/geometry/depth_map.hpp>
#include <alight/infer/landing/site_selector.hpp>
#include <opencv2/imgcodecs.hpp>

int main(int argc, char** argv) {
  cv::Mat depth_m(352, 352, CV_32FC1, cv::Scalar(12));
  if (argc > 1) {
    const cv::Mat png = cv::imread(argv[1], cv::IMREAD_UNCHANGED);
    if (png.type() != CV_16UC1) return std::fprintf(stderr, "%s: is no 16-bit PNG\n", argv[1]), 1;
    depth_m = alight::decode_depth(png);
  }
  const alight::PinholeIntrinsics camera{
      440, 440, 0.5 * (depth_m.cols - 1), 0.5 * (depth_m.rows - 1), depth_m.cols, depth_m.rows};
  Eigen::Matrix3d R_world_camera;
  R_world_camera << 1, 0, 0, 0, -1, 0, 0, 0, -1;  // right is east, down in the image is south
  const alight::SiteSelection selection = alight::SiteSelector({}, camera).select(depth_m, R_world_camera);
  std::printf("%s\n", alight::describe(selection).c_str());
  if (!selection.largest) return 1;
  const alight::LandingSite& circle = *selection.largest;
  std::printf("radius %.2f m, %.2f m east and %.2f m north of the camera, %.2f m below it\n", circle.radius_m,
              circle.p_world.x(), circle.p_world.y(), -circle.p_world.z());
}
