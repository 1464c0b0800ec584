#pragma once

#include <string>
#include <vector>

#include "closed_loop/landing/landing_verdict.hpp"

namespace alight::closed_loop {

/// A share with what chance leaves open.
struct Interval {
  double low = 0;
  double high = 1;
};
/// Wilson's score interval of 95 %: holds near 0 and 1, where the usual one does not (Wilson 1927; Brown, Cai and DasGupta
/// 2001). @returns [0, 1] for no trials
Interval wilson(int successes, int trials);

/// The tables of a campaign as Markdown: overall, by look, by fault, and every landing that did not end well.
std::string campaign_report(const std::vector<LandingResult>& rows, double wanted_radius_m);

}  // namespace alight::closed_loop
