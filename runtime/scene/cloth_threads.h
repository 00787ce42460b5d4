// The threads of a cloth: chains of edges that run along warp or weft.
#pragma once

#include <vector>

#include "scene/cloth_mesh.h"
#include "solver/cloth_backend.h"

namespace loam {

// Edges within 15 degrees of warp or weft, chained where they go on straight. Links may be longer than at rest by a share of `greatest_stretch`; beyond, they resist
// with ten times `stretch_stiffness`.
ClothThreadList make_threads(const ClothMesh &mesh, const Vec3<double> &warp, double greatest_stretch,
                             double stretch_stiffness);

// The direction of the warp in a triangle's plane: along `warp`, or along an axis where the warp stands on it.
Vec3<double> warp_in_plane(const Vec3<double> &warp, const Vec3<double> &normal);

} // namespace loam
