#include "beams.h"

#include <loam/world.h>
#include <map>

#include "finite_elements.h"

namespace loam::accuracy {

using test::Cantilever;

std::vector<Beam> beams(bool quick) {
  std::vector<Beam> result;
  for (const int exponent : {4, 5, 6}) {
    if (quick && exponent != 5) continue;
    Cantilever beam;
    beam.length = 12;
    beam.load = 0.5; // without control of zero-energy modes one of load 1 has no equilibrium
    beam.gravity *= std::pow(10, exponent) / beam.youngs_modulus();
    result.push_back({"E 1e" + std::to_string(exponent) + " Pa", beam});
  }
  return result;
}

namespace {

Cantilever any_of_them() { return beams(true).front().cantilever; }

} // namespace

const reference::Vectors &settled_beam(std::uint32_t multiplier) {
  static std::map<std::uint32_t, reference::Vectors> known;
  if (!known.contains(multiplier)) {
    Cantilever beam = any_of_them();
    if (multiplier == LOAM_MULTIPLIER_SCALAR) beam.zero_energy_stiffness = 0;
    known[multiplier] = test::settled(beam);
  }
  return known[multiplier];
}

double exact_drop(std::uint32_t multiplier) { return test::exact_drop(any_of_them(), settled_beam(multiplier)); }

double finite_element_drop(const Cantilever &beam) {
  const double thickness = beam.layers * Cantilever::spacing, width = beam.width * Cantilever::spacing;
  const int elements[3] = {std::max(4, beam.length / beam.layers * 2), 2, 2};
  reference::FiniteElements body(reference::HenckySolid::from(reference::Material<double>::from(beam.material())),
                                 {beam.metres(), thickness, width}, elements);
  body.set_body_force({0, -Cantilever::density * beam.gravity, 0});
  for (std::size_t node = 0; node < body.node_count(); ++node)
    for (int axis = 0; axis < 3; ++axis)
      if (body.rest_position(node)[0] == 0) body.hold(node, axis);
  body.solve(4);
  double drop = 0, nodes = 0;
  for (std::size_t node = 0; node < body.node_count(); ++node)
    if (body.rest_position(node)[0] > beam.metres() * (1 - 1e-9)) {
      drop += body.rest_position(node)[1] - body.position(node)[1];
      nodes += 1;
    }
  return drop / nodes / beam.metres();
}

} // namespace loam::accuracy
