#include "sim/objects/material.hpp"

#include <array>

namespace alight::sim {
namespace {

using Rgb = Eigen::Vector3f;

// Albedos: order of magnitude from the ASTER/ECOSTRESS spectral library, reflectivity at 905 nm likewise;
// clear glass and still water send the beam elsewhere. Rows in the order of the enum.
const std::array<MaterialProperties, static_cast<std::size_t>(Material::kCount)> kMaterials = {{
    {"grass", Rgb(.070F, .105F, .030F), Rgb(.135F, .140F, .050F), .15F, 2.8F, .50F, true, Pattern::kNone},
    {"dry_grass", Rgb(.210F, .175F, .085F), Rgb(.150F, .150F, .060F), .13F, 3.0F, .50F, true, Pattern::kNone},
    {"crop", Rgb(.055F, .120F, .025F), Rgb(.110F, .150F, .040F), .20F, 1.8F, .55F, false, Pattern::kNone},
    {"soil", Rgb(.140F, .092F, .058F), Rgb(.195F, .140F, .095F), .11F, 3.0F, .30F, true, Pattern::kFurrows},
    {"gravel", Rgb(.270F, .250F, .220F), Rgb(.210F, .190F, .165F), .10F, 4.5F, .30F, true, Pattern::kNone},
    {"asphalt", Rgb(.075F, .075F, .078F), Rgb(.105F, .103F, .100F), .07F, 5.0F, .10F, true, Pattern::kLanes},
    {"concrete", Rgb(.330F, .320F, .300F), Rgb(.270F, .260F, .240F), .07F, 2.8F, .35F, true, Pattern::kSlabs},
    {"paving", Rgb(.250F, .235F, .215F), Rgb(.300F, .270F, .240F), .08F, 2.6F, .30F, true, Pattern::kSlabs},
    {"rock", Rgb(.220F, .205F, .185F), Rgb(.150F, .145F, .135F), .14F, 2.4F, .30F, true, Pattern::kNone},
    {"roof_tile", Rgb(.290F, .105F, .060F), Rgb(.210F, .085F, .055F), .12F, 1.0F, .35F, false,
     Pattern::kTiles},
    {"roof_flat", Rgb(.200F, .195F, .190F), Rgb(.150F, .150F, .150F), .12F, 1.4F, .25F, false,
     Pattern::kNone},
    {"plaster", Rgb(.560F, .530F, .460F), Rgb(.500F, .460F, .390F), .06F, 1.0F, .60F, false,
     Pattern::kWindows},
    {"brick", Rgb(.270F, .120F, .080F), Rgb(.220F, .105F, .075F), .10F, 1.0F, .40F, false, Pattern::kBricks},
    {"foliage", Rgb(.048F, .092F, .020F), Rgb(.095F, .130F, .034F), .28F, .9F, .50F, false, Pattern::kNone},
    {"needles", Rgb(.030F, .060F, .022F), Rgb(.055F, .082F, .028F), .28F, .9F, .45F, false, Pattern::kNone},
    {"bark", Rgb(.120F, .090F, .065F), Rgb(.085F, .065F, .050F), .22F, 1.2F, .30F, false, Pattern::kNone},
    {"wood", Rgb(.250F, .180F, .105F), Rgb(.190F, .140F, .085F), .18F, 1.1F, .40F, false, Pattern::kNone},
    {"car_paint", Rgb(.500F, .500F, .500F), Rgb(.500F, .500F, .500F), .015F, .5F, .40F, false,
     Pattern::kNone},
    {"glass", Rgb(.030F, .034F, .040F), Rgb(.045F, .050F, .055F), .05F, .5F, .03F, false, Pattern::kNone},
    {"metal", Rgb(.330F, .330F, .340F), Rgb(.270F, .270F, .280F), .06F, .8F, .45F, false, Pattern::kNone},
    {"water", Rgb(.022F, .036F, .036F), Rgb(.030F, .046F, .042F), .09F, .6F, .00F, false, Pattern::kNone},
    {"snow", Rgb(.780F, .790F, .810F), Rgb(.765F, .777F, .802F), .012F, 1.2F, .70F, true, Pattern::kNone},
    // A calibration board: matt paper and the carbon black of a laser printer.
    {"board_white", Rgb(.800F, .800F, .790F), Rgb(.800F, .800F, .790F), 0.F, 1.F, .80F, false,
     Pattern::kNone},
    {"board_black", Rgb(.045F, .045F, .045F), Rgb(.045F, .045F, .045F), 0.F, 1.F, .12F, false,
     Pattern::kNone},
}};

}  // namespace

const MaterialProperties& properties(Material material) {
  return kMaterials[static_cast<std::size_t>(material)];
}

}  // namespace alight::sim
