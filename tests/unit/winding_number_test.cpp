#include "scene/winding_number.h"

#include <gtest/gtest.h>

#include "unit/test_meshes.h"

namespace loam {
namespace {

using test::MeshData;

WindingNumber winding_of(const MeshData &data) { return WindingNumber(make_triangle_mesh(data.view(), "mesh")); }

TEST(WindingNumber, IsOneInsideAndZeroOutside) {
  const WindingNumber box = winding_of(test::box_mesh({1, 2, 3}));
  const WindingNumber sphere = winding_of(test::icosphere_mesh(1, 4));
  const WindingNumber torus = winding_of(test::torus_mesh(1, 0.3f, 64, 32));
  test::Random random{1};
  int inside[3] = {};
  for (int k = 0; k < 2000; ++k) {
    const Vec3<float> f = random.in_box(1.4f);
    const Vec3<double> p{f.x, 2 * f.y, 3 * f.z};
    const bool in_box = std::abs(p.x) < 1 && std::abs(p.y) < 2 && std::abs(p.z) < 3;
    EXPECT_NEAR(box.at(p), in_box ? 1 : 0, 0.1);
    inside[0] += in_box ? 1 : 0;

    const Vec3<double> q{f.x, f.y, f.z};
    const double from_centre = length(q);
    if (std::abs(from_centre - 1) > 0.01) {
      EXPECT_NEAR(sphere.at(q), from_centre < 1 ? 1 : 0, 0.1);
      inside[1] += from_centre < 1 ? 1 : 0;
    }
    const double from_ring = std::hypot(std::hypot(q.x, q.z) - 1, q.y);
    if (std::abs(from_ring - 0.3) > 0.01) {
      EXPECT_NEAR(torus.at(q), from_ring < 0.3 ? 1 : 0, 0.1);
      inside[2] += from_ring < 0.3 ? 1 : 0;
    }
  }
  for (const int count : inside) EXPECT_GT(count, 100);
  EXPECT_NEAR(torus.at({0, 0, 0}), 0, 0.1); // the hole
}

TEST(WindingNumber, TheHierarchyAgreesWithTheSum) {
  MeshData open = test::icosphere_mesh(1, 4); // a third of it missing: the number is not whole
  open.indices.resize(open.indices.size() / 9 * 6);
  const WindingNumber winding = winding_of(open);
  test::Random random{2};
  double furthest_from_whole = 0;
  for (int k = 0; k < 500; ++k) {
    const Vec3<float> f = random.in_box(2);
    const double exact = winding.exactly_at({f.x, f.y, f.z});
    EXPECT_NEAR(winding.at({f.x, f.y, f.z}), exact, 0.1);
    furthest_from_whole = std::max(furthest_from_whole, std::abs(exact - std::round(exact)));
  }
  EXPECT_GT(furthest_from_whole, 0.4);
}

TEST(WindingNumber, CountsOverlapsAndOrientation) {
  MeshData twice = test::box_mesh({1, 1, 1});
  twice.append(test::box_mesh({1, 1, 1}), {1, 0, 0});
  const WindingNumber winding = winding_of(twice);
  EXPECT_NEAR(winding.at({0.5, 0, 0}), 2, 0.1);
  EXPECT_NEAR(winding.at({-0.5, 0, 0}), 1, 0.1);
  EXPECT_NEAR(winding.signed_volume(), 16, 1e-5);

  MeshData reversed = test::box_mesh({1, 1, 1});
  for (std::size_t i = 0; i < reversed.indices.size(); i += 3) std::swap(reversed.indices[i], reversed.indices[i + 1]);
  EXPECT_NEAR(winding_of(reversed).at({0, 0, 0}), -1, 0.1);
  EXPECT_NEAR(winding_of(reversed).signed_volume(), -8, 1e-6);
}

TEST(WindingNumber, OneTriangleSeenFromNearAndFar) {
  MeshData one;
  one.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  one.triangle(0, 1, 2);
  const WindingNumber winding = winding_of(one);
  EXPECT_NEAR(winding.at({0.25, 0.25, -1e-6}), 0.5, 1e-4); // half the sphere of directions
  EXPECT_NEAR(winding.at({0.25, 0.25, 1e-6}), -0.5, 1e-4);
  EXPECT_NEAR(winding.at({0, 0, -100}), 0.5 / (4 * 3.14159265 * 1e4), 1e-8);
}

TEST(WindingNumber, VolumeAndDistance) {
  const WindingNumber torus = winding_of(test::torus_mesh(1, 0.3f, 256, 128));
  EXPECT_NEAR(torus.signed_volume(), 2 * 9.8696044 * 0.09, 2e-3);
  EXPECT_NEAR(torus.distance({0, 0, 0}, 10), 0.7f, 1e-3f);
  EXPECT_NEAR(torus.distance({1, 0, 0}, 10), 0.3f, 1e-3f);
  EXPECT_EQ(torus.distance({1, 0, 0}, 0.1f), 0.1f);
}

} // namespace
} // namespace loam
