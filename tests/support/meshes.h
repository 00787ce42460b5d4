/* Triangle meshes for tests, as a host holds them: plain arrays of the public interface. Closed meshes are counter-clockwise seen from outside. */
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <loam/loam.h>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace loam::meshes {

struct Mesh {
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;

  std::uint32_t vertex(float x, float y, float z) {
    positions.insert(positions.end(), {x, y, z});
    return std::uint32_t(positions.size() / 3 - 1);
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { indices.insert(indices.end(), {a, b, c}); }
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }
  void append(const Mesh &other, float dx = 0, float dy = 0, float dz = 0) {
    const auto base = std::uint32_t(positions.size() / 3);
    for (std::size_t i = 0; i < other.positions.size(); i += 3)
      vertex(other.positions[i] + dx, other.positions[i + 1] + dy, other.positions[i + 2] + dz);
    for (const std::uint32_t index : other.indices) indices.push_back(base + index);
  }
  loam_mesh view() const {
    return {positions.data(), indices.data(), std::uint32_t(positions.size() / 3), std::uint32_t(indices.size() / 3)};
  }
};

inline Mesh box(float half_x, float half_y, float half_z) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertex((i & 1) != 0 ? half_x : -half_x, (i & 2) != 0 ? half_y : -half_y, (i & 4) != 0 ? half_z : -half_z);
  const std::uint32_t quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto &q : quads) mesh.quad(q[0], q[1], q[2], q[3]);
  return mesh;
}

inline Mesh icosphere(float radius, int subdivisions) {
  constexpr float t = std::numbers::phi_v<float>;
  Mesh mesh;
  mesh.positions = {-1, t,  0,  1, t, 0,  -1, -t, 0,  1, -t, 0, 0,  -1, t,  0,  1, t,
                    0,  -1, -t, 0, 1, -t, t,  0,  -1, t, 0,  1, -t, 0,  -1, -t, 0, 1};
  mesh.indices = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
                  3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1};
  for (int s = 0; s < subdivisions; ++s) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto next = std::uint32_t(mesh.positions.size() / 3);
      const auto [found, fresh] = middles.try_emplace({std::min(a, b), std::max(a, b)}, next);
      if (fresh)
        for (std::size_t k = 0; k < 3; ++k)
          mesh.positions.push_back((mesh.positions[3 * a + k] + mesh.positions[3 * b + k]) / 2);
      return found->second;
    };
    const std::vector<std::uint32_t> old = std::exchange(mesh.indices, {});
    for (std::size_t i = 0; i < old.size(); i += 3) {
      const std::uint32_t a = old[i], b = old[i + 1], c = old[i + 2];
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      mesh.triangle(a, ab, ca);
      mesh.triangle(b, bc, ab);
      mesh.triangle(c, ca, bc);
      mesh.triangle(ab, bc, ca);
    }
  }
  for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
    float *p = &mesh.positions[i];
    const float scale = radius / std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (int k = 0; k < 3; ++k) p[k] *= scale;
  }
  return mesh;
}

/* A closed surface of revolution about the y axis through (radius, height) pairs, heights rising; its ends are capped at their points on the axis. */
inline Mesh revolution(const std::vector<std::pair<float, float>> &profile, std::uint32_t around) {
  Mesh mesh;
  for (const auto &[radius, height] : profile)
    for (std::uint32_t k = 0; k < around; ++k) {
      const float angle = 2 * std::numbers::pi_v<float> * float(k) / float(around);
      mesh.vertex(radius * std::cos(angle), height, radius * std::sin(angle));
    }
  const std::uint32_t bottom = mesh.vertex(0, profile.front().second, 0), top = mesh.vertex(0, profile.back().second, 0);
  const auto last = std::uint32_t(profile.size() - 1) * around;
  for (std::uint32_t k = 0; k < around; ++k) {
    const std::uint32_t next = (k + 1) % around;
    mesh.triangle(bottom, k, next);
    mesh.triangle(top, last + next, last + k);
    for (std::uint32_t ring = 0; ring < last; ring += around)
      mesh.quad(ring + k, ring + around + k, ring + around + next, ring + next);
  }
  return mesh;
}

/* Two bulbs of `radius` joined by a neck: the shape of an hourglass, 4 radii high, its neck in the origin. */
inline Mesh hourglass(float radius, float neck, std::uint32_t around = 24) {
  std::vector<std::pair<float, float>> profile;
  constexpr int rings = 20;
  for (int k = 0; k <= rings; ++k) {
    const float height = -2 + 4 * float(k) / rings, bulb = std::fabs(height) - 1;
    const float width = std::sqrt(std::max(0.0f, 1 - bulb * bulb));
    profile.emplace_back(std::max(neck, radius * width), radius * height);
  }
  return revolution(profile, around);
}

/* A square in the plane y = 0 of cells x cells x 2 triangles, facing up: open at its border. */
inline Mesh sheet(float half, std::uint32_t cells) {
  Mesh mesh;
  const float size = 2 * half / float(cells);
  for (std::uint32_t j = 0; j <= cells; ++j)
    for (std::uint32_t i = 0; i <= cells; ++i) mesh.vertex(-half + size * float(i), 0, -half + size * float(j));
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * (cells + 1) + i;
      mesh.quad(a, a + cells + 1, a + cells + 2, a + 1);
    }
  return mesh;
}

/* How often the mesh winds around a point: 1 inside, 0 outside (Van Oosterom and Strackee 1983). */
inline double winding_number(const Mesh &mesh, const double point[3]) {
  double solid_angle = 0;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    double corner[3][3], length[3];
    for (std::size_t v = 0; v < 3; ++v) {
      for (std::size_t k = 0; k < 3; ++k) corner[v][k] = double(mesh.positions[3 * mesh.indices[t + v] + k]) - point[k];
      length[v] = std::hypot(corner[v][0], corner[v][1], corner[v][2]);
    }
    const auto dot = [&](int a, int b) {
      return corner[a][0] * corner[b][0] + corner[a][1] * corner[b][1] + corner[a][2] * corner[b][2];
    };
    const double triple = corner[0][0] * (corner[1][1] * corner[2][2] - corner[1][2] * corner[2][1]) -
                          corner[0][1] * (corner[1][0] * corner[2][2] - corner[1][2] * corner[2][0]) +
                          corner[0][2] * (corner[1][0] * corner[2][1] - corner[1][1] * corner[2][0]);
    solid_angle += 2 * std::atan2(triple, length[0] * length[1] * length[2] + dot(0, 1) * length[2] + dot(1, 2) * length[0] +
                                              dot(2, 0) * length[1]);
  }
  return solid_angle / (4 * std::numbers::pi);
}

} // namespace loam::meshes
