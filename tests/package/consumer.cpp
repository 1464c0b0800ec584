// A program of another project: the site selection without torch, and the engine with a checkpoint.
#include <cstdio>

#include "geometry/depth_map.hpp"
#include "infer/depth_engine.hpp"
#include "infer/landing/site_selection.hpp"
#include "infer/network_predictor.hpp"

int main(int argc, char** argv) {
  const alight::PinholeIntrinsics camera{440, 440, 175.5, 175.5, 352, 352};
  const cv::Mat level_ground_m(camera.size(), CV_32FC1, cv::Scalar(12));
  Eigen::Matrix3d R_world_camera;
  R_world_camera << 1, 0, 0, 0, -1, 0, 0, 0, -1;  // looks down
  const alight::SiteSelection site = alight::SiteSelector({}, camera).select(level_ground_m, R_world_camera);
  if (!site.found()) return 1;
  alight::RectifiedRig rig;
  rig.intrinsics = camera;
  if (argc > 1) alight::make_network_predictor(argv[1], rig);
  std::printf("%s\n", alight::describe(site).c_str());
  return 0;
}
