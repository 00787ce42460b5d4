#include "picture/surface.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <unordered_map>

// The level set is that of Zhu and Bridson 2005, "Animating sand as a fluid": the distance to the weighted mean of the particles around, less
// a radius; flat layers of particles get a flat surface. It is meshed by naive surface nets (Gibson 1998): a vertex in every cell of
// the grid that the surface crosses, a quadrilateral across every edge that it crosses. The grid is kept only near particles.

namespace runner {
namespace {

constexpr float reach = 2.4f;   // of a particle, in spacings
constexpr float radius = 0.62f; // by which the surface lies outside the means, in spacings
constexpr float cell = 0.4f;    // of the grid, in spacings
constexpr float gap = 0.2f;     // between the surface and a barrier, in spacings: more than smoothing moves it
constexpr int smoothing = 8;    // passes over the finished mesh

constexpr int edge = 8;            // nodes of a block along each axis
constexpr int outermost = 1 << 20; // nodes from the origin along each axis that a block's key can hold

struct Block {
  int low[3];
  std::array<float, edge * edge * edge> weight{}; // then the level set
  std::array<Vector3, edge * edge * edge> mean{};
  std::array<std::uint32_t, edge * edge * edge>
      vertex{}; // of the cell whose lowest corner the node is; 0: none, else from 1
};

struct Node {
  int x, y, z;
  Node plus(int axis, int by) const {
    return {x + (axis == 0 ? by : 0), y + (axis == 1 ? by : 0), z + (axis == 2 ? by : 0)};
  }
};

class Grid {
public:
  explicit Grid(float size) : size_(size) {}

  Vector3 position(Node n) const {
    return {size_ * static_cast<float>(n.x), size_ * static_cast<float>(n.y), size_ * static_cast<float>(n.z)};
  }
  void add(Vector3 particle, float particle_reach) {
    int low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = static_cast<int>(std::floor((particle[axis] - particle_reach) / size_));
      high[axis] = static_cast<int>(std::ceil((particle[axis] + particle_reach) / size_));
    }
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x) {
          const auto [block, at] = make({x, y, z});
          const Vector3 away = position({x, y, z}) - particle;
          const float share = 1 - dot(away, away) / (particle_reach * particle_reach);
          if (share <= 0) continue;
          const float weight = share * share * share;
          block->weight[at] += weight;
          block->mean[at] += weight * particle;
        }
  }
  void finish(float surface_radius, float barrier_gap, const Barrier &barrier) {
    each_node([&](Block &block, std::size_t at, Node node) {
      const float weight = block.weight[at];
      float &level = block.weight[at];
      level = outside;
      if (weight <= 1e-6f) return;
      const Vector3 mean = (1 / weight) * block.mean[at], away = position(node) - mean;
      const float distance = length(away);
      level = distance - surface_radius;
      if (barrier && level < 2 * size_ && distance > 0)
        level = std::fmax(level, distance + barrier_gap - barrier(mean, (1 / distance) * away, distance + 2 * size_));
    });
  }
  float level(Node n) {
    const auto [block, at] = find(n);
    return block != nullptr ? block->weight[at] : outside;
  }
  std::uint32_t *vertex(Node n) {
    const auto [block, at] = find(n);
    return block != nullptr ? &block->vertex[at] : nullptr;
  }
  template <class Visit> void each_node(const Visit &visit) {
    for (Block *block : order_)
      for (int z = 0; z < edge; ++z)
        for (int y = 0; y < edge; ++y)
          for (int x = 0; x < edge; ++x)
            visit(*block, static_cast<std::size_t>((z * edge + y) * edge + x),
                  Node{block->low[0] + x, block->low[1] + y, block->low[2] + z});
  }
  static constexpr float outside = 1e30f;

private:
  struct Place {
    Block *block;
    std::size_t at;
  };
  static int block_of(int n) { return n >= 0 ? n / edge : -((edge - 1 - n) / edge); }
  static std::uint64_t key_of(Node n) {
    const auto part = [](int i) { return static_cast<std::uint64_t>(block_of(i) + outermost) & 0x1fffff; };
    return part(n.x) | part(n.y) << 21 | part(n.z) << 42;
  }
  static std::size_t at_of(const Block &block, Node n) {
    return static_cast<std::size_t>(((n.z - block.low[2]) * edge + n.y - block.low[1]) * edge + n.x - block.low[0]);
  }
  Place find(Node n) {
    const std::uint64_t key = key_of(n);
    if (last_ == nullptr || key != last_key_) {
      const auto found = blocks_.find(key);
      if (found == blocks_.end()) return {nullptr, 0};
      last_ = found->second.get();
      last_key_ = key;
    }
    return {last_, at_of(*last_, n)};
  }
  Place make(Node n) {
    if (const Place place = find(n); place.block != nullptr) return place;
    auto block = std::make_unique<Block>();
    block->low[0] = block_of(n.x) * edge;
    block->low[1] = block_of(n.y) * edge;
    block->low[2] = block_of(n.z) * edge;
    order_.push_back(block.get());
    blocks_.emplace(key_of(n), std::move(block));
    return find(n);
  }

  float size_;
  std::unordered_map<std::uint64_t, std::unique_ptr<Block>> blocks_;
  std::vector<Block *> order_; // of creation: the same surface every time
  Block *last_ = nullptr;
  std::uint64_t last_key_ = 0;
};

// A vertex for the cell from `low` to the node diagonally opposite, if the surface crosses it: the mean of the crossings of its edges.
bool vertex_in(Grid &grid, Node low, Vector3 &vertex) {
  float level[8];
  Vector3 corner[8];
  int inside = 0;
  for (int i = 0; i < 8; ++i) {
    const Node node = {low.x + (i & 1), low.y + (i >> 1 & 1), low.z + (i >> 2)};
    level[i] = grid.level(node);
    corner[i] = grid.position(node);
    inside += level[i] < 0;
  }
  if (inside == 0 || inside == 8) return false;
  Vector3 sum;
  int crossings = 0;
  for (int i = 0; i < 8; ++i)
    for (const int bit : {1, 2, 4}) {
      const int j = i | bit;
      if (j == i || (level[i] < 0) == (level[j] < 0)) continue;
      sum += mix(corner[i], corner[j], std::fmin(1.0f, level[i] / (level[i] - level[j])));
      ++crossings;
    }
  vertex = (1 / static_cast<float>(crossings)) * sum;
  return true;
}

void smooth(Mesh &mesh) {
  std::vector<Vector3> sums(mesh.vertices.size());
  std::vector<int> counts(mesh.vertices.size());
  for (int pass = 0; pass < smoothing; ++pass) {
    std::fill(sums.begin(), sums.end(), Vector3{});
    std::fill(counts.begin(), counts.end(), 0);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) { // every edge is met once from either end
      const std::uint32_t a = mesh.indices[i], b = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
      sums[a] += mesh.vertices[b];
      ++counts[a];
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
      if (counts[i] > 0) mesh.vertices[i] = mix(mesh.vertices[i], (1 / static_cast<float>(counts[i])) * sums[i], 0.6f);
  }
}

} // namespace

Mesh make_surface(const std::vector<Vector3> &particles, float spacing, const Barrier &barrier) {
  Grid grid(cell * spacing);
  const float limit = static_cast<float>(outermost) * cell * spacing; // of what the keys can tell apart
  for (const Vector3 particle : particles)
    if (std::fabs(particle.x) < limit && std::fabs(particle.y) < limit && std::fabs(particle.z) < limit)
      grid.add(particle, reach * spacing);
  grid.finish(radius * spacing, gap * spacing, barrier);

  Mesh mesh;
  grid.each_node([&](Block &block, std::size_t at, Node node) {
    Vector3 vertex;
    if (!vertex_in(grid, node, vertex)) return;
    mesh.vertices.push_back(vertex);
    block.vertex[at] = static_cast<std::uint32_t>(mesh.vertices.size());
  });
  grid.each_node([&](Block &block, std::size_t at, Node node) {
    const bool inside = block.weight[at] < 0;
    for (int axis = 0; axis < 3; ++axis) {
      if ((grid.level(node.plus(axis, 1)) < 0) == inside) continue;
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      std::uint32_t corner[4];
      const Node cells[4] = {node.plus(u, -1).plus(v, -1), node.plus(v, -1), node, node.plus(u, -1)};
      for (int i = 0; i < 4; ++i) {
        const std::uint32_t *vertex = grid.vertex(cells[i]);
        corner[i] = vertex != nullptr ? *vertex : 0;
      }
      if (corner[0] == 0 || corner[1] == 0 || corner[2] == 0 || corner[3] == 0) continue;
      if (!inside) std::swap(corner[1], corner[3]);
      for (const int i : {0, 1, 2, 0, 2, 3}) mesh.indices.push_back(corner[i] - 1);
    }
  });
  smooth(mesh);
  return mesh;
}

} // namespace runner
