#include "scene/sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "scene/error.h"
#include "unit/test_meshes.h"

namespace loam {
namespace {

using test::MeshData;

constexpr std::uint64_t plenty = 1u << 24;
const loam_region everything{};

loam_region box(float half) {
  loam_region region{};
  region.kind = LOAM_REGION_BOX;
  for (float &h : region.half_extents) h = half;
  return region;
}

loam_region inside_of(const MeshData &mesh) {
  loam_region region{};
  region.kind = LOAM_REGION_MESH;
  region.mesh = mesh.view();
  return region;
}

loam_fill_def fill_of(const loam_region &region) {
  loam_fill_def def{};
  def.struct_size = sizeof def;
  def.region = region;
  def.jitter = 0.12f;
  def.seed = 1;
  return def;
}

// The least distance between two points, found through a grid.
double least_distance(const std::vector<Vec3<float>> &points, double cell) {
  std::map<std::tuple<long, long, long>, std::vector<std::size_t>> grid;
  const auto key = [&](const Vec3<float> &p) {
    return std::make_tuple(std::lround(std::floor(p.x / cell)), std::lround(std::floor(p.y / cell)),
                           std::lround(std::floor(p.z / cell)));
  };
  for (std::size_t i = 0; i < points.size(); ++i) grid[key(points[i])].push_back(i);
  double least = cell;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [x, y, z] = key(points[i]);
    for (long a = x - 1; a <= x + 1; ++a) {
      for (long b = y - 1; b <= y + 1; ++b) {
        for (long c = z - 1; c <= z + 1; ++c) {
          const auto found = grid.find({a, b, c});
          if (found == grid.end()) continue;
          for (const std::size_t j : found->second) {
            if (j <= i) continue;
            const Vec3<double> d{double(points[i].x) - points[j].x, double(points[i].y) - points[j].y,
                                 double(points[i].z) - points[j].z};
            least = std::min(least, length(d));
          }
        }
      }
    }
  }
  return least;
}

TEST(PoissonDisk, KeepsItsDistanceAndIsDense) {
  const RegionSampler region(box(1), everything, 0);
  const float d = 0.06f;
  const std::vector<Vec3<float>> points = sample_poisson_disk(region, d, 1, plenty);
  EXPECT_GE(least_distance(points, 0.1), double(d) * (1 - 1e-6));
  // Count per volume; the outermost layer is half a spacing deep on each side.
  const double density = double(points.size()) * d * d * d / std::pow(2 + 0.8 * d, 3);
  RecordProperty("density", std::to_string(density));
  EXPECT_GT(density, 0.5);
  EXPECT_LT(density, 0.65);
  // No hole wider than two spacings anywhere: dense, not only on average.
  test::Random random{5};
  for (int k = 0; k < 200; ++k) {
    const Vec3<float> p = random.in_box(1);
    float nearest = 10;
    for (const Vec3<float> &q : points) nearest = std::min(nearest, length(q - p));
    EXPECT_LT(nearest, 1.5f * d);
  }
}

TEST(PoissonDisk, StaysInTheRegionAndFillsEveryPartOfIt) {
  // Two balls far apart and a torus between: three parts in one mesh.
  MeshData mesh = test::torus_mesh(1, 0.25f, 48, 24);
  mesh.append(test::icosphere_mesh(0.5f, 3), {4, 0, 0});
  mesh.append(test::icosphere_mesh(0.5f, 3), {-4, 1, 0});
  const float d = 0.07f;
  const RegionSampler region(inside_of(mesh), everything, 0);
  const std::vector<Vec3<float>> points = sample_poisson_disk(region, d, 3, plenty);
  int right = 0, left = 0, middle = 0;
  for (const Vec3<float> &p : points) {
    const double in_right = length(p - Vec3<float>{4, 0, 0}), in_left = length(p - Vec3<float>{-4, 1, 0});
    const double in_torus = std::hypot(std::hypot(p.x, p.z) - 1, p.y);
    EXPECT_TRUE(in_right < 0.5 || in_left < 0.5 || in_torus < 0.252); // chords bulge on the hole's side
    ++(in_right < 0.5 ? right : in_left < 0.5 ? left : middle);
  }
  EXPECT_NEAR(double(right) / left, 1, 0.06);
  EXPECT_NEAR(double(middle) / right, 2 * 9.87 * 0.0625 / 0.5236, 0.25); // volumes 1.234 and 0.524
  EXPECT_GE(least_distance(points, 0.1), double(d) * (1 - 1e-6));
}

TEST(PoissonDisk, TheSeedDecides) {
  const RegionSampler region(box(1), everything, 0);
  const auto same = [](const std::vector<Vec3<float>> &a, const std::vector<Vec3<float>> &b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](Vec3<float> p, Vec3<float> q) {
             return p.x == q.x && p.y == q.y && p.z == q.z;
           });
  };
  const auto first = sample_poisson_disk(region, 0.1f, 1, plenty);
  EXPECT_TRUE(same(first, sample_poisson_disk(region, 0.1f, 1, plenty)));
  EXPECT_FALSE(same(first, sample_poisson_disk(region, 0.1f, 2, plenty)));
  const auto lattice = sample_lattice(region, 0.1f, 0.12f, 1, plenty);
  EXPECT_TRUE(same(lattice, sample_lattice(region, 0.1f, 0.12f, 1, plenty)));
  EXPECT_FALSE(same(lattice, sample_lattice(region, 0.1f, 0.12f, 2, plenty)));
}

TEST(PoissonDisk, AThinRegionInWideBoundsIsCheap) {
  // A rod 6 m long and 2 cm thick across the diagonal: its cells are one in thousands of its bounds'.
  MeshData across = test::box_mesh({0.01f, 3, 0.01f});
  const Vec4<float> q{0.3f, 0.1f, 0.4f, 0.86023f};
  for (Vec3<float> &v : across.vertices) v = rotate(q, v);
  const auto points = sample_poisson_disk(RegionSampler(inside_of(across), everything, 0), 0.005f, 1, plenty);
  EXPECT_NEAR(double(points.size()), 0.57 * 0.0024 / 1.25e-7, 0.4 * 0.57 * 0.0024 / 1.25e-7);
}

TEST(Lattice, FillsABoxExactlyAndKeepsApart) {
  const RegionSampler region(box(0.5f), everything, 0);
  EXPECT_EQ(sample_lattice(region, 0.1f, 0, 1, plenty).size(), 1000u);
  EXPECT_NEAR(least_distance(sample_lattice(region, 0.1f, 0, 1, plenty), 0.2), 0.1, 1e-6);
  const auto jittered = sample_lattice(region, 0.1f, 0.12f, 1, plenty);
  EXPECT_EQ(jittered.size(), 1000u);
  EXPECT_GT(least_distance(jittered, 0.2), 0.075);
  EXPECT_LT(least_distance(jittered, 0.2), 0.085);
  const auto wild = sample_lattice(region, 0.1f, 0.5f, 1, plenty);
  EXPECT_EQ(wild.size(), 1000u);
  EXPECT_GT(least_distance(wild, 0.2), 1e-4);
  double mean[3] = {}, square = 0;
  const auto regular = sample_lattice(region, 0.1f, 0, 1, plenty);
  for (std::size_t i = 0; i < jittered.size(); ++i) {
    const Vec3<float> moved = jittered[i] - regular[i];
    const float m[3] = {moved.x, moved.y, moved.z};
    for (int k = 0; k < 3; ++k) {
      EXPECT_LE(std::fabs(m[k]), 0.012f + 1e-6f);
      mean[k] += m[k] / 1000;
      square += m[k] * m[k] / 3000;
    }
  }
  for (const double m : mean) EXPECT_NEAR(m, 0, 6e-4); // 0.012 / sqrt(3) / sqrt(1000) = 2.2e-4
  EXPECT_NEAR(std::sqrt(square), 0.012 / std::sqrt(3), 2e-4);
}

TEST(Fill, MassFillsTheRegion) {
  const float r = 0.05f;
  loam_fill_def def = fill_of(box(0.5f));
  FillResult result = fill(def, r, plenty);
  EXPECT_NEAR(result.volume_per_particle * double(result.positions.size()), 1, 1e-6);
  EXPECT_NEAR(result.volume_per_particle / (r * r * r), 1, 0.1); // spacing 0.83 r: a particle has about r^3
  EXPECT_GE(least_distance(result.positions, 0.1), 0.83 * r * (1 - 1e-6));
  def.sampling = LOAM_SAMPLING_LATTICE;
  result = fill(def, r, plenty);
  EXPECT_EQ(result.positions.size(), 8000u);
  EXPECT_NEAR(result.volume_per_particle, double(r) * r * r, 1e-9);

  // The inset applies to the region, not to the cut.
  const MeshData ball = test::icosphere_mesh(0.5f, 3);
  def = fill_of(inside_of(ball));
  def.cut = box(1);
  def.cut.center[1] = 1;
  def.inset = r / 2;
  result = fill(def, r, plenty);
  float lowest = 1, furthest = 0;
  for (const Vec3<float> &p : result.positions) {
    lowest = std::min(lowest, p.y);
    furthest = std::max(furthest, length(p));
  }
  EXPECT_GE(lowest, 0);
  EXPECT_LT(lowest, 0.3f * r);
  EXPECT_LE(furthest, 0.475f);
  EXPECT_GT(furthest, 0.46f);
  EXPECT_NEAR(result.volume_per_particle * double(result.positions.size()) / (2.0 / 3 * 3.14159 * 0.1072), 1, 0.02);
}

TEST(Fill, ALargeMeshIsSampledInSeconds) {
  const MeshData torus = test::torus_mesh(1, 0.4f, 80, 40); // 6400 triangles
  loam_fill_def def = fill_of(inside_of(torus));
  def.inset = 0.01f;
  const FillResult result = fill(def, 0.04f, plenty);
  EXPECT_GT(result.positions.size(), 40000u);
}

TEST(Fill, BadFieldsAreNamed) {
  const auto expect = [](const loam_fill_def &def, const std::string &part, loam_status status = LOAM_ERROR_INVALID_ARGUMENT,
                         std::uint64_t room = plenty) {
    try {
      fill(def, 0.1f, room);
      ADD_FAILURE() << "accepted, but should say " << part;
    } catch (const Error &error) {
      EXPECT_EQ(error.status(), status) << error.what();
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const loam_fill_def good = fill_of(box(0.5f));
  EXPECT_NO_THROW(fill(good, 0.1f, plenty));
  loam_fill_def bad = good;
  bad.sampling = 2;
  expect(bad, "sampling is 2");
  bad = good;
  bad.spacing = 0.04f;
  expect(bad, "spacing is 0.04, must be 0 (for the default) or 0.05");
  for (const float value : {-1.0f, nan, inf}) {
    bad = good;
    bad.spacing = value;
    expect(bad, "spacing is ");
    bad = good;
    bad.jitter = value;
    expect(bad, "jitter is ");
    bad = good;
    bad.inset = value;
    expect(bad, "inset is ");
  }
  bad = good;
  bad.velocity[2] = inf;
  expect(bad, "velocity[2] is inf");
  bad = good;
  bad.reserved = 1;
  expect(bad, "reserved is 1");
  bad = good;
  bad.inset = 0.5f;
  expect(bad, "region is empty");
  bad = good;
  bad.cut = box(0.1f);
  bad.cut.center[0] = 3;
  expect(bad, "region is empty");
  bad.cut.center[0] = nan;
  expect(bad, "cut.center[0]");
  bad = good;
  bad.region.center[1] = 1e6f;
  expect(bad, "must be within 100000");
  expect(good, "the region needs about", LOAM_ERROR_CAPACITY, 100);
  expect(good, "particle_capacity leaves room for 900", LOAM_ERROR_CAPACITY, 900);
  bad = good;
  bad.region = box(5e4f); // 1e18 particles: refused before any memory is taken
  expect(bad, "the region needs about", LOAM_ERROR_CAPACITY);
}

} // namespace
} // namespace loam
