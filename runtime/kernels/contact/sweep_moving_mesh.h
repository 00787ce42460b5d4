// The sweep past a mesh whose vertices move, see moving_triangle.h. In the frame of the collider the particle goes straight, and so do the vertices.
#pragma once

#include "kernels/contact/mesh_query.h"
#include "kernels/contact/moving_triangle.h"

namespace loam {

struct SweepMovingMesh {
  const MeshShape &mesh;
  Vec3<float> start;
  SidePasses passes;

  // Changes the way so that it keeps its side; false if it does.
  LOAM_FN bool operator()(Vec3<float> &way) const {
    bool cut = false, pierced = false;
    for (int pass = 0; pass < SidePasses::all; ++pass) {
      bool changed = false;
      pierced = false;
      for_each_triangle(way, [&](const TriangleView &before, const TriangleView &after) {
        const SideKept kept = keep_side(before, after, passes, pass);
        pierced = pierced || kept.pierced;
        changed = changed || kept.changes;
        way = way + kept.more;
      });
      if (!changed) break;
      cut = true;
    }
    if (pierced) go_along(way);
    return cut;
  }

private:
  // Within reach of the way as it is at first; `f` sees a triangle from the way as it is by then.
  template <class F> LOAM_FN void for_each_triangle(const Vec3<float> &way, const F &f) const {
    BallQuery query(mesh.nodes, start);
    const float reach = length(way) + passes.margin;
    for (int i = query.next(reach * reach); i >= 0; i = query.next(reach * reach)) {
      const int count = static_cast<int>(mesh.packets[i].count);
      for (int k = 0; k < count; ++k) {
        const TriangleView before = view(mesh.packets[i], k, start), after = view(mesh.end_packets[i], k, start + way);
        if (!is_line(before) && !is_line(after)) f(before, after); // a line's neighbours have its edges
      }
    }
  }
  LOAM_FN static TriangleView view(const TrianglePacket &packet, int lane, Vec3<float> from) {
    return {lane_of(packet.a, lane) - from, lane_of(packet.b, lane) - from, lane_of(packet.c, lane) - from};
  }
  LOAM_FN static bool is_line(const TriangleView &t) {
    const Vec3<float> ab = t.b - t.a, bc = t.c - t.b, ca = t.a - t.c;
    return t.is_line(square_root(3.0f * maximum(dot(ab, ab), maximum(dot(bc, bc), dot(ca, ca)))));
  }
  LOAM_FN void go_along(Vec3<float> &way) const {
    Company company;
    for_each_triangle(
        way, [&](const TriangleView &before, const TriangleView &after) { (void)company.add(before, after, passes); });
    if (company.weight > 0.0f) way = way + company.mean();
  }
};

} // namespace loam
