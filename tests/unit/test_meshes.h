// Meshes for the tests of the geometry, and a small generator of random numbers.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <loam/collider.h>

#include "math/vector.h"

namespace loam::test {

struct MeshData {
  std::vector<Vec3<float>> vertices;
  std::vector<std::uint32_t> indices;

  loam_mesh view() const {
    return {&vertices.front().x, indices.data(), std::uint32_t(vertices.size()), std::uint32_t(indices.size() / 3)};
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { indices.insert(indices.end(), {a, b, c}); }
  void append(const MeshData &other, Vec3<float> offset = {0, 0, 0}) {
    const auto base = std::uint32_t(vertices.size());
    for (const Vec3<float> &v : other.vertices) vertices.push_back(v + offset);
    for (const std::uint32_t i : other.indices) indices.push_back(base + i);
  }
};

inline MeshData box_mesh(Vec3<float> half) {
  MeshData mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(
        {(i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y, (i & 4) != 0 ? half.z : -half.z});
  }
  const std::uint32_t quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto &q : quads) {
    mesh.triangle(q[0], q[1], q[2]);
    mesh.triangle(q[0], q[2], q[3]);
  }
  return mesh;
}

inline MeshData icosphere_mesh(float radius, int subdivisions) {
  MeshData mesh;
  const float t = 1.618034f;
  mesh.vertices = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                   {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  mesh.indices = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
                  3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1};
  for (int s = 0; s < subdivisions; ++s) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, fresh] = middles.try_emplace({std::min(a, b), std::max(a, b)}, std::uint32_t(mesh.vertices.size()));
      if (fresh) {
        const Vec3<float> sum = mesh.vertices[a] + mesh.vertices[b];
        mesh.vertices.push_back((length(mesh.vertices[0]) / length(sum)) * sum);
      }
      return found->second;
    };
    std::vector<std::uint32_t> old;
    old.swap(mesh.indices);
    for (std::size_t i = 0; i < old.size(); i += 3) {
      const std::uint32_t a = old[i], b = old[i + 1], c = old[i + 2];
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      mesh.triangle(a, ab, ca);
      mesh.triangle(b, bc, ab);
      mesh.triangle(c, ca, bc);
      mesh.triangle(ab, bc, ca);
    }
  }
  for (Vec3<float> &v : mesh.vertices) v = (radius / length(v)) * v;
  return mesh;
}

// A torus about the y axis.
inline MeshData torus_mesh(float ring_radius, float tube_radius, std::uint32_t around, std::uint32_t across) {
  MeshData mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const float u = 6.2831853f * float(i) / float(around), v = 6.2831853f * float(j) / float(across);
      const float distance = ring_radius + tube_radius * std::cos(v);
      mesh.vertices.push_back({distance * std::cos(u), tube_radius * std::sin(v), distance * std::sin(u)});
    }
  }
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const std::uint32_t a = i * across + j, b = i * across + (j + 1) % across,
                          c = (i + 1) % around * across + (j + 1) % across, d = (i + 1) % around * across + j;
      mesh.triangle(a, b, c);
      mesh.triangle(a, c, d);
    }
  }
  return mesh;
}

// A square in the plane y = 0, tessellated unevenly into cells x cells x 2 triangles, facing up.
inline MeshData floor_mesh(float half, std::uint32_t cells, float unevenness = 0.3f) {
  MeshData mesh;
  const float size = 2 * half / float(cells);
  for (std::uint32_t j = 0; j <= cells; ++j) {
    for (std::uint32_t i = 0; i <= cells; ++i) {
      const bool border = i == 0 || j == 0 || i == cells || j == cells;
      const float push = border ? 0.0f : unevenness * size * float(int(i * 7 + j * 13) % 5 - 2) / 4.0f;
      mesh.vertices.push_back({-half + size * float(i) + push, 0, -half + size * float(j) - push});
    }
  }
  for (std::uint32_t j = 0; j < cells; ++j) {
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.triangle(a, c, b);
      mesh.triangle(b, c, d);
    }
  }
  return mesh;
}

// A linear congruential generator (Knuth's MMIX constants); its high bits are good enough here and the same everywhere.
struct Random {
  std::uint64_t state = 1;
  double uniform() {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return double(state >> 11) * 0x1p-53;
  }
  float between(float low, float high) { return low + (high - low) * float(uniform()); }
  Vec3<float> in_box(float half) { return {between(-half, half), between(-half, half), between(-half, half)}; }
  Vec3<float> direction() {
    for (;;) {
      const Vec3<float> v = in_box(1);
      const float l = length(v);
      if (l > 0.1f && l < 1) return (1 / l) * v;
    }
  }
};

} // namespace loam::test
