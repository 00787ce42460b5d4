// How the host deforms a mesh: periodic in time, about the origin of the collider's own frame.
#pragma once

#include <vector>

#include "mesh.h"
#include "vector.h"

namespace runner {

// With a = amplitude * sin(2 pi (time - start) / period), and 0 before the start:
struct Deformation {
  enum class Kind {
    squash, // shorter along the axis by the share a, and as much wider across it as keeps its volume
    twist,  // turned about the axis by a degrees for each metre along it
    wave // moved along the axis by amplitude * sin(2 pi ((time - start) / period - distance along `direction` / wavelength)) metres
  };
  Kind kind = Kind::squash;
  Vector3 axis = {0, 1, 0}; // unit
  float amplitude = 0;
  double period = 1, start = 0;  // seconds
  Vector3 direction = {1, 0, 0}; // unit; of a wave
  float wavelength = 0;          // m; of a wave
};

// One after the other, in the order of the list.
Mesh deformed(const Mesh &mesh, const std::vector<Deformation> &deformations, double time);

} // namespace runner
