#include "sim/world/world.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "sim/truth/surface_truth.hpp"
#include "tests/sim/test_worlds.hpp"

namespace alight::sim {
namespace {

constexpr std::array<Look, 5> kLooks = {Look::kVillage, Look::kForest, Look::kFarmland, Look::kRocky,
                                        Look::kUrban};

WorldConfig config_of(Look look, int seed, double size_m) {
  WorldConfig config;
  config.look = look;
  config.seed = seed;
  config.size_m = size_m;
  return config;
}

TEST(World, EveryLookHasSafeGroundAndDangerInTheMiddle) {
  for (const Look look : kLooks) {
    for (const int seed : {1, 2, 3}) {
      const World world(config_of(look, seed, 100));
      const Renderer renderer(world);
      const SurfaceTruth truth(renderer);
      const std::string name = to_string(look) + " " + std::to_string(seed);
      EXPECT_GE(truth.largest_safe_circle(30).radius_m, 3.0) << name;
      const double safe_share = cv::countNonZero(truth.safe()) / static_cast<double>(truth.safe().total());
      EXPECT_LT(safe_share, 0.95) << name;
      double steepest = 0;
      cv::minMaxLoc(truth.slope_rad(), nullptr, &steepest);
      EXPECT_GT(steepest, 10 * 0.0174533) << name;
    }
  }
}

TEST(World, SameSeedSameImageOtherSeedAnother) {
  for (const Look look : kLooks) {
    const World first(config_of(look, 5, 60));
    const World second(config_of(look, 5, 60));
    const World other(config_of(look, 6, 60));
    const Eigen::Isometry3d T = test::camera_above(0, 0, 25);
    const View a = Renderer(first).render_camera(test::intrinsics(), T, true);
    const View b = Renderer(second).render_camera(test::intrinsics(), T, true);
    const View c = Renderer(other).render_camera(test::intrinsics(), T, true);
    EXPECT_EQ(cv::norm(a.image, b.image, cv::NORM_INF), 0) << to_string(look);
    EXPECT_EQ(cv::norm(a.depth_m, b.depth_m, cv::NORM_INF), 0) << to_string(look);
    EXPECT_GT(cv::norm(a.depth_m, c.depth_m, cv::NORM_INF), 0.1) << to_string(look);
  }
}

/// What a world consists of, so roughly that last digits of a mathematical library do not show.
struct WorldSummary {
  std::size_t placements = 0;
  std::size_t triangles = 0;
  long placements_m = 0;  ///< sum of their distances to the origin
  long vertices_m = 0;    ///< likewise, each in its mesh

  explicit WorldSummary(const World& world) : placements(world.placements().size()) {
    double sum_m = 0;
    for (const Placement& placement : world.placements()) {
      sum_m += placement.T_world_mesh.translation().cast<double>().norm();
    }
    placements_m = std::lround(sum_m);
    sum_m = 0;
    for (const TriangleMesh& mesh : world.meshes()) {
      triangles += mesh.triangles.size();
      for (const Eigen::Vector3f& vertex : mesh.vertices) sum_m += vertex.cast<double>().norm();
    }
    vertices_m = std::lround(sum_m);
  }
};

// C++ leaves the order of arguments to the compiler: a number drawn among them makes another world with another compiler.
TEST(World, ASeedsWorldIsTheSameWithEveryCompiler) {
  WorldConfig config = config_of(Look::kVillage, 4, 60);
  for (const Hardship hardship : all_hardships()) config.hard.names.push_back(to_string(hardship));
  const WorldSummary village{World(config)};
  EXPECT_EQ(village.placements, 198U);
  EXPECT_EQ(village.triangles, 114060U);
  EXPECT_EQ(village.placements_m, 4441);
  EXPECT_EQ(village.vertices_m, 1726527);
}

TEST(World, GroundHeightIsTheTerrainMeshs) {
  const World world(config_of(Look::kRocky, 3, 60));
  EXPECT_NEAR(world.ground_height_m(0, 0), 0, 1e-6);
  // The mesh's surfaces come from a cover map, which from_meshes() has not.
  TriangleMesh mesh = world.terrain()->mesh();
  mesh.triangle_surfaces.assign(mesh.triangles.size(), 0);
  const World painted = World::from_meshes({mesh}, {test::surface_of(Material::kSoil)}, 60);
  const Renderer renderer(painted);
  for (double x_m = -40; x_m < 40; x_m += 3.7) {
    for (double y_m = -40; y_m < 40; y_m += 4.1) {
      const Hit hit = renderer.cast({x_m, y_m, 100}, {0, 0, -1});
      ASSERT_TRUE(hit.hit);
      EXPECT_NEAR(100 - hit.range_m, world.ground_height_m(x_m, y_m), 1e-3);
    }
  }
}

TEST(World, SunFollowsTheConfiguration) {
  WorldConfig config = config_of(Look::kVillage, 1, 60);
  config.sun_elevation_deg = 30;
  config.sun_azimuth_deg = 90;
  const Eigen::Vector3d sun = World(config).sun_direction();
  EXPECT_NEAR(sun.x(), 0, 1e-9);
  EXPECT_NEAR(sun.y(), std::sqrt(3.0) / 2, 1e-9);
  EXPECT_NEAR(sun.z(), 0.5, 1e-9);
}

TEST(World, ConfigReadsBackWhatItPrints) {
  WorldConfig config = config_of(Look::kRocky, 9, 120);
  config.sun_elevation_deg = 40;
  const auto again = parse_config<WorldConfig>(print_config(config), "printed");
  EXPECT_EQ(again.look, Look::kRocky);
  EXPECT_EQ(again.seed, 9);
  EXPECT_EQ(again.size_m, 120);
  EXPECT_EQ(again.sun_elevation_deg, 40.0);
  EXPECT_FALSE(again.sun_azimuth_deg.has_value());
  EXPECT_THROW(parse_config<WorldConfig>("look: desert\n", "text"), ConfigError);
  EXPECT_THROW(parse_config<WorldConfig>("size_m: 5\n", "text"), ConfigError);
}

}  // namespace
}  // namespace alight::sim
