#include "scene/sampling.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <unordered_map>

#include "scene/checks.h"
#include "scene/error.h"
#include "scene/random.h"

namespace loam {
namespace {

// A block of 8 x 8 x 8 cells that the region reaches.
constexpr int block_cells = 8;
struct Block {
  std::int64_t x, y, z;
};

std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z) {
  return std::uint64_t(x & 0x1FFFFF) | std::uint64_t(y & 0x1FFFFF) << 21 | std::uint64_t(z & 0x1FFFFF) << 42;
}

[[noreturn]] void refuse_capacity(double needed, std::uint64_t max_count) {
  throw Error(LOAM_ERROR_CAPACITY,
              format("the region needs about %.0f particles, but particle_capacity leaves room for %llu", needed,
                     static_cast<unsigned long long>(max_count)));
}

// The blocks of a grid that the region reaches, in the order z, y, x. They are found from a large cube down, so that a thin region in
// wide bounds costs what it fills.
std::vector<Block> blocks_of(const RegionSampler &region, Vec3<double> origin, double cell, std::uint64_t max_count) {
  struct Cube {
    Block corner;
    std::int64_t blocks; // along an edge
  };
  const double block = cell * block_cells;
  const Vec3<double> extent = region.upper() - origin;
  const double longest = std::max({extent.x, extent.y, extent.z}) / block;
  if (!(longest < double(1 << 20))) {
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("the region is %.3g spacings long, must be under 1e6", longest * block_cells));
  }
  std::int64_t size = 1;
  while (double(size) < longest) size *= 2;
  // A region far thinner than the spacing has many blocks for few particles; that also ends somewhere.
  const std::size_t max_blocks = (std::size_t(1) << 18) + std::size_t(std::min<std::uint64_t>(max_count, 1u << 28) / 8);
  std::vector<Block> blocks;
  std::vector<Cube> stack{{{0, 0, 0}, size}};
  while (!stack.empty()) {
    const Cube cube = stack.back();
    stack.pop_back();
    const double half = 0.5 * double(cube.blocks) * block;
    const Vec3<double> centre =
        origin + Vec3<double>{double(cube.corner.x) * block + half, double(cube.corner.y) * block + half,
                              double(cube.corner.z) * block + half};
    if (region.depth(centre) < -1.7321 * half) continue;
    if (cube.blocks == 1) {
      if (blocks.size() == max_blocks) refuse_capacity(double(max_count) * 1.1, max_count);
      blocks.push_back(cube.corner);
      continue;
    }
    const std::int64_t h = cube.blocks / 2;
    for (int k = 0; k < 8; ++k) {
      stack.push_back(
          {{cube.corner.x + (k & 1) * h, cube.corner.y + (k >> 1 & 1) * h, cube.corner.z + (k >> 2 & 1) * h}, h});
    }
  }
  std::sort(blocks.begin(), blocks.end(), [](const Block &a, const Block &b) {
    if (a.z != b.z) return a.z < b.z;
    return a.y != b.y ? a.y < b.y : a.x < b.x;
  });
  return blocks;
}

// Bridson, "Fast Poisson disk sampling in arbitrary dimensions" (2007), on a background grid whose cells hold one sample at most. The
// samples grow outwards from those that are there; where none reached, a dart into every empty cell starts afresh, so that all parts of a
// region in several parts are filled.
class PoissonDisk {
public:
  PoissonDisk(const RegionSampler &region, double spacing, std::uint32_t seed, std::uint64_t max_count)
      : region_(region), spacing_(spacing), cell_(spacing * 0.577350), max_count_(max_count), random_{seed},
        origin_(region.lower()), blocks_(blocks_of(region, origin_, cell_, max_count)) {
    block_of_.reserve(blocks_.size());
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      block_of_.emplace(key_of(blocks_[b].x, blocks_[b].y, blocks_[b].z), std::int32_t(b));
    }
    cells_.assign(blocks_.size() * cells_in_block, -1);
    around_.resize(blocks_.size() * 27);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      for (int k = 0; k < 27; ++k) {
        around_[27 * b + std::size_t(k)] =
            block_at(blocks_[b].x + k % 3 - 1, blocks_[b].y + k / 3 % 3 - 1, blocks_[b].z + k / 9 - 1);
      }
    }
  }

  std::vector<Vec3<float>> sample() {
    // A region smaller than a cell may be missed by its dart; it gets more.
    for (int attempt = 0; attempt < 64 && points_.empty(); ++attempt) throw_darts();
    return std::move(world_points_);
  }

private:
  static constexpr std::size_t cells_in_block = std::size_t(block_cells) * block_cells * block_cells;
  static constexpr int candidates = 30;

  struct Cell {
    std::int64_t x, y, z;
  };

  void throw_darts() {
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      for (std::size_t c = 0; c < cells_in_block; ++c) {
        if (cells_[b * cells_in_block + c] >= 0) continue;
        const Vec3<double> corner = {double(blocks_[b].x * block_cells + std::int64_t(c % block_cells)),
                                     double(blocks_[b].y * block_cells + std::int64_t(c / block_cells % block_cells)),
                                     double(blocks_[b].z * block_cells + std::int64_t(c / block_cells / block_cells))};
        const Vec3<double> inside = {random_.uniform(), random_.uniform(), random_.uniform()};
        if (try_point(origin_ + cell_ * (corner + inside), origin_, 0)) grow();
      }
    }
  }

  void grow() {
    while (!active_.empty()) {
      const std::size_t pick = std::size_t(random_.uniform() * double(active_.size()));
      const std::size_t from = active_[pick];
      const Vec3<double> centre = points_[from];
      bool found = false;
      for (int k = 0; k < candidates && !found; ++k) found = try_point(centre + in_shell(), centre, depths_[from]);
      if (found) continue;
      active_[pick] = active_.back();
      active_.pop_back();
    }
  }

  // Uniform in the shell between one and two spacings.
  Vec3<double> in_shell() {
    for (;;) {
      const Vec3<double> v = {random_.between(-2, 2), random_.between(-2, 2), random_.between(-2, 2)};
      const double square = dot(v, v);
      if (square >= 1 && square <= 4) return spacing_ * v;
    }
  }

  Cell cell_at(Vec3<double> own) const {
    const Vec3<double> p = (1.0 / cell_) * (own - origin_);
    return {std::int64_t(std::floor(p.x)), std::int64_t(std::floor(p.y)), std::int64_t(std::floor(p.z))};
  }

  // The index of a block, or -1 where the region does not reach.
  std::int32_t block_at(std::int64_t x, std::int64_t y, std::int64_t z) const {
    const auto found = block_of_.find(key_of(x, y, z));
    return found == block_of_.end() ? -1 : found->second;
  }

  static std::size_t cell_in_block(std::int64_t x, std::int64_t y, std::int64_t z) {
    return std::size_t((x & 7) + 8 * ((y & 7) + 8 * (z & 7)));
  }

  // Keeps the point if it is in the region and has room. All is asked of the rounded position that the particle will have. `free` is a
  // distance that can be gone from the point `from`, in the region, without leaving the region.
  bool try_point(Vec3<double> wanted, Vec3<double> from, double free) {
    const Vec3<float> world = region_.to_world(wanted);
    const Vec3<double> own = region_.to_own(world);
    const Cell at = cell_at(own);
    const std::int32_t block = block_at(at.x >> 3, at.y >> 3, at.z >> 3);
    if (block < 0) return false;
    std::int32_t &place = cells_[std::size_t(block) * cells_in_block + cell_in_block(at.x, at.y, at.z)];
    if (place >= 0 || !has_room(own, at, std::size_t(block))) return false;
    double depth = free - length(own - from);
    if (!(depth > 0)) {
      if (!region_.contains(own)) return false;
      depth = region_.depth(own);
    }
    if (points_.size() >= max_count_) refuse_capacity(needed(), max_count_);
    place = std::int32_t(points_.size());
    active_.push_back(std::uint32_t(points_.size()));
    points_.push_back(own);
    depths_.push_back(depth);
    world_points_.push_back(world);
    return true;
  }

  double needed() const {
    return std::max(double(max_count_) + 1, 0.57 * region_.volume() / (spacing_ * spacing_ * spacing_));
  }

  bool has_room(Vec3<double> own, const Cell &at, std::size_t block) const {
    const double least = spacing_ * spacing_;
    for (std::int64_t z = (at.z & 7) - 2; z <= (at.z & 7) + 2; ++z) {
      for (std::int64_t y = (at.y & 7) - 2; y <= (at.y & 7) + 2; ++y) {
        for (std::int64_t x = (at.x & 7) - 2; x <= (at.x & 7) + 2; ++x) {
          const std::int64_t side = ((x >> 3) + 1) + 3 * ((y >> 3) + 1) + 9 * ((z >> 3) + 1);
          const std::int32_t neighbour = around_[27 * block + std::size_t(side)];
          if (neighbour < 0) continue;
          const std::int32_t place = cells_[std::size_t(neighbour) * cells_in_block + cell_in_block(x, y, z)];
          if (place < 0) continue;
          const Vec3<double> apart = points_[std::size_t(place)] - own;
          if (dot(apart, apart) < least) return false;
        }
      }
    }
    return true;
  }

  const RegionSampler &region_;
  double spacing_, cell_;
  std::uint64_t max_count_;
  Random random_;
  Vec3<double> origin_;
  std::vector<Block> blocks_;
  std::unordered_map<std::uint64_t, std::int32_t> block_of_;
  std::vector<std::int32_t> around_; // of each block the 27 around it, or -1
  std::vector<std::int32_t> cells_;  // the sample in each cell, or -1
  std::vector<Vec3<double>> points_;
  std::vector<double> depths_; // how far the boundary is at least
  std::vector<Vec3<float>> world_points_;
  std::vector<std::uint32_t> active_;
};

void refuse_if_too_many(const RegionSampler &region, double density, double spacing, std::uint64_t max_count) {
  const double estimate = density * region.volume() / (spacing * spacing * spacing);
  if (0.8 * estimate > double(max_count)) refuse_capacity(estimate, max_count);
}

bool is_empty(const RegionSampler &region) {
  const Vec3<double> a = region.lower(), b = region.upper();
  return !(a.x < b.x && a.y < b.y && a.z < b.z);
}

void check_definition(const loam_fill_def &def, double r) {
  if (def.sampling > LOAM_SAMPLING_LATTICE) {
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("sampling is %u, must be POISSON_DISK (0) or LATTICE (1)", def.sampling));
  }
  const double least = 0.5 * r, most = 1e6 * r;
  if (def.spacing != 0.0f && !(def.spacing >= least && def.spacing <= most)) {
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("spacing is %g, must be 0 (for the default) or %g (half the kernel radius) to %g",
                       double(def.spacing), least, most));
  }
  check_range("jitter", def.jitter, 0, 0.5);
  check_range("inset", def.inset, 0, most);
  for (int i = 0; i < 3; ++i) check_range(format("velocity[%d]", i).c_str(), def.velocity[i], -1e6, 1e6);
  if (def.reserved != 0) throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("reserved is %u, must be 0", def.reserved));
}

// Further out, neighbouring particles would share a rounded position.
void check_place(const RegionSampler &region, double r) {
  const Vec3<double> a = region.lower(), b = region.upper();
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3<float> p =
        region.to_world({(corner & 1) != 0 ? b.x : a.x, (corner & 2) != 0 ? b.y : a.y, (corner & 4) != 0 ? b.z : a.z});
    const double furthest = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    if (!(furthest <= 1e6 * r)) {
      throw Error(
          LOAM_ERROR_INVALID_ARGUMENT,
          format("region reaches out to %g, must be within %g (a million kernel radii) of the origin", furthest, 1e6 * r));
    }
  }
}

FillResult fill_checked(const loam_fill_def &def, float kernel_radius, std::uint64_t max_count) {
  const RegionSampler region(def.region, def.cut, def.inset);
  if (is_empty(region) || !(region.volume() > 0)) {
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("region is empty: its cut or its inset of %g leaves nothing", double(def.inset)));
  }
  check_place(region, kernel_radius);
  FillResult result;
  if (def.sampling == LOAM_SAMPLING_LATTICE) {
    const float spacing = def.spacing != 0.0f ? def.spacing : kernel_radius;
    result.positions = sample_lattice(region, spacing, def.jitter, def.seed, max_count);
  } else {
    const float spacing = def.spacing != 0.0f ? def.spacing : 0.83f * kernel_radius;
    result.positions = sample_poisson_disk(region, spacing, def.seed, max_count);
  }
  if (result.positions.empty()) {
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, "region is so small against the spacing that no particle fell into it");
  }
  result.volume_per_particle = region.volume() / double(result.positions.size());
  return result;
}

} // namespace

std::vector<Vec3<float>> sample_poisson_disk(const RegionSampler &region, float spacing, std::uint32_t seed,
                                             std::uint64_t max_count) {
  if (is_empty(region)) return {};
  refuse_if_too_many(region, 0.57, spacing, max_count);
  return PoissonDisk(region, spacing, seed, max_count).sample();
}

std::vector<Vec3<float>> sample_lattice(const RegionSampler &region, float spacing, float jitter, std::uint32_t seed,
                                        std::uint64_t max_count) {
  if (is_empty(region)) return {};
  refuse_if_too_many(region, 1.0, spacing, max_count);
  const double d = spacing;
  const Vec3<double> extent = region.upper() - region.lower();
  const auto margin = [d](double length) { return 0.5 * (length - d * std::max(1.0, std::round(length / d))); };
  const Vec3<double> origin = region.lower() + Vec3<double>{margin(extent.x), margin(extent.y), margin(extent.z)};
  // Neighbours moved towards each other by half a spacing would meet.
  const double amplitude = std::min<double>(jitter, 0.499) * d;
  std::vector<Vec3<float>> points;
  for (const Block &block : blocks_of(region, origin, d, max_count)) {
    for (int c = 0; c < block_cells * block_cells * block_cells; ++c) {
      const std::int64_t x = block.x * block_cells + c % block_cells,
                         y = block.y * block_cells + c / block_cells % block_cells,
                         z = block.z * block_cells + c / block_cells / block_cells;
      const Vec3<double> site = origin + d * Vec3<double>{double(x) + 0.5, double(y) + 0.5, double(z) + 0.5};
      if (!region.contains(site)) continue;
      if (points.size() >= max_count)
        refuse_capacity(std::max(double(max_count) + 1, region.volume() / (d * d * d)), max_count);
      Random random{key_of(x, y, z)};
      random.state = random.next() ^ seed;
      const Vec3<double> moved =
          site + amplitude * Vec3<double>{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
      const Vec3<float> world = region.to_world(moved);
      points.push_back(region.contains(region.to_own(world)) ? world : region.to_world(site));
    }
  }
  return points;
}

FillResult fill(const loam_fill_def &def, float kernel_radius, std::uint64_t max_count) {
  check_definition(def, kernel_radius);
  try {
    return fill_checked(def, kernel_radius, max_count);
  } catch (const std::bad_alloc &) {
    throw Error(LOAM_ERROR_OUT_OF_MEMORY, "no memory to fill the region");
  }
}

} // namespace loam
