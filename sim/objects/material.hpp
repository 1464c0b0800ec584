#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace alight::sim {

/// What a surface is made of.
enum class Material : std::uint8_t {
  kGrass,
  kDryGrass,
  kCrop,
  kSoil,
  kGravel,
  kAsphalt,
  kConcrete,
  kPaving,
  kRock,
  kRoofTile,
  kRoofFlat,
  kPlaster,
  kBrick,
  kFoliage,
  kNeedles,
  kBark,
  kWood,
  kCarPaint,
  kGlass,
  kMetal,
  kWater,
  kSnow,
  kBoardWhite,
  kBoardBlack,
  kCount
};

/// Drawings on top of the noise that every material has.
enum class Pattern : std::uint8_t { kNone, kLanes, kTiles, kSlabs, kBricks, kWindows, kFurrows };

/// One row of the material table. Colours are linear (not sRGB) diffuse albedos.
struct MaterialProperties {
  const char* name;
  Eigen::Vector3f albedo_rgb;      ///< the one end of the natural colour variation
  Eigen::Vector3f albedo_alt_rgb;  ///< and the other
  float contrast;                  ///< brightness variation of one octave of noise, relative
  float fine_gain;                 ///< contrast of the finest octave over that of the coarsest
  float lidar_reflectivity;        ///< diffuse, at 905 nm, 0..1; 0: no return (specular)
  bool landable;                   ///< ground that bears a vehicle
  Pattern pattern;
};

/// The row of a material.
const MaterialProperties& properties(Material material);

}  // namespace alight::sim
