#include "elastica.h"

#include <cmath>
#include <utility>

namespace loam::reference {

namespace {

struct Section {
  double slope, curvature, drop, length; // length: how far along the undeformed beam
};

Section moved(const Section &from, double by, const Section &rate) {
  return {from.slope + by * rate.slope, from.curvature + by * rate.curvature, from.drop + by * rate.drop,
          from.length + by * rate.length};
}

/* The far end of a beam that has this curvature at its clamp: Runge-Kutta of fourth order. */
Section end_of_beam(double own_weight, double tip_load, double clamp_curvature) {
  const int steps = 400;
  const double h = 1.0 / steps;
  const auto rate = [&](double s, const Section &at) {
    return Section{at.curvature, -(own_weight * (1 - s) + tip_load) * std::cos(at.slope), std::sin(at.slope),
                   std::cos(at.slope)};
  };
  Section section = {0, clamp_curvature, 0, 0};
  for (int step = 0; step < steps; ++step) {
    const double s = step * h;
    const Section first = rate(s, section), second = rate(s + h / 2, moved(section, h / 2, first)),
                  third = rate(s + h / 2, moved(section, h / 2, second)), fourth = rate(s + h, moved(section, h, third));
    for (const auto &[share, part] : {std::pair(h / 6, first), {h / 3, second}, {h / 3, third}, {h / 6, fourth}})
      section = moved(section, share, part);
  }
  return section;
}

} // namespace

Elastica elastica(double own_weight, double tip_load) {
  // A beam that stays straight has the largest moment at its clamp, so that shooting by bisection has its bounds.
  double low = 0, high = own_weight / 2 + tip_load;
  for (int halving = 0; halving < 50; ++halving) {
    const double middle = (low + high) / 2;
    (end_of_beam(own_weight, tip_load, middle).curvature > 0 ? high : low) = middle;
  }
  const Section end = end_of_beam(own_weight, tip_load, (low + high) / 2);
  return {end.drop, 1 - end.length, end.slope};
}

} // namespace loam::reference
