#include "infer/landing/ground/site_selection.hpp"

#include <cstdio>

namespace alight {

std::string describe(const SiteSelection& selection) {
  if (selection.status == SiteStatus::kNoDepth) return "no depth";
  if (!selection.largest) return "no flat area";
  char text[64];
  std::snprintf(text, sizeof text, selection.found() ? "landing site of %.1f m" : "largest circle %.1f m",
                selection.largest->radius_m);
  return text;
}

}  // namespace alight
