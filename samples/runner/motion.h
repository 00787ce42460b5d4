// How the host moves a collider: at constant velocity and spin for a while.
#pragma once

#include <array>
#include <vector>

#include "vector.h"

namespace runner {

struct Pose {
  Vector3 position;
  std::array<float, 4> rotation = {0, 0, 0, 1}; // unit quaternion x, y, z, w
};

Vector3 rotate(const std::array<float, 4> &rotation, Vector3 v);

// Several may act at once: their velocities add up, and their spins act in the order of the list.
struct Motion {
  double start = 0, stop = 1e30; // seconds
  Vector3 velocity;              // m/s
  Vector3 spin_axis = {0, 1, 0}; // unit, through the collider's origin, in the world's directions
  double spin = 0;               // radians a second
};

// Where motions have taken what was at `start` at time 0.
Pose pose_at(const Pose &start, const std::vector<Motion> &motions, double time);

} // namespace runner
