/* Cloth that tears. */
#include <gtest/gtest.h>

#include <set>

#include "support/cloths.h"

namespace loam {
namespace {

using cloths::Cloth;
using cloths::Grid;

std::vector<std::uint32_t> indices_of(const Cloth &cloth, std::uint32_t &vertices) {
  loam_cloth_view view = {};
  view.struct_size = sizeof view;
  scenes::require(loam_cloth_map(cloth.world, cloth.id, &view), "loam_cloth_map");
  std::vector<std::uint32_t> indices(view.indices, view.indices + 3 * std::size_t(view.triangle_count));
  vertices = view.vertex_count;
  scenes::require(loam_cloth_unmap(cloth.world, cloth.id), "loam_cloth_unmap");
  return indices;
}

/* Pieces that hang together by edges. */
std::size_t pieces(const std::vector<std::uint32_t> &indices) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> edges;
  std::vector<std::size_t> parent(indices.size() / 3);
  for (std::size_t t = 0; t < parent.size(); ++t) parent[t] = t;
  const auto root = [&](std::size_t t) {
    while (parent[t] != t) t = parent[t];
    return t;
  };
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const std::uint32_t a = indices[i], b = indices[i % 3 == 2 ? i - 2 : i + 1];
    const auto [found, is_new] = edges.try_emplace({std::min(a, b), std::max(a, b)}, i / 3);
    if (!is_new) parent[root(i / 3)] = root(found->second);
  }
  std::set<std::size_t> roots;
  for (std::size_t t = 0; t < parent.size(); ++t) roots.insert(root(t));
  return roots.size();
}

struct Strip {
  double strain = 0; // of its load when it tore; 0: it did not
  std::size_t pieces = 0;
  std::uint32_t vertices = 0;
  float lowest = 0;
};

/* A strip of 0.2 m by 0.4 m that hangs by its upper edge while gravity grows; the strain there is density g length / stiffness. */
Strip load_strip(float tear_strain, float greatest_g, std::uint32_t substeps = 32, float damping = 1e-3f) {
  const Grid grid(8, 16, 0.025f, true);
  scenes::World world(cloths::world_def(20, substeps));
  loam_cloth_def def = cloths::definition(grid);
  def.stretch_stiffness = 300;
  def.greatest_stretch = 0;
  def.damping = damping;
  def.tear_strain = tear_strain;
  const Cloth cloth(world.get(), def);
  std::vector<std::uint32_t> top;
  for (std::uint32_t i = 0; i <= 8; ++i) top.push_back(i);
  cloth.attach(top);
  Strip result;
  const int frames = 180;
  for (int frame = 0; frame < frames; ++frame) {
    const float g = greatest_g * static_cast<float>(frame) / frames, gravity[3] = {0, -g, 0};
    scenes::require(loam_world_set_gravity(world.get(), gravity), "loam_world_set_gravity");
    world.step(1.0f / 60);
    if (world.statistics().cloth_tears > 0 && result.strain == 0) result.strain = 0.15 * double(g) * 0.4 / 300;
  }
  result.pieces = pieces(indices_of(cloth, result.vertices));
  result.lowest = cloth.vertices().lowest();
  EXPECT_TRUE(cloth.vertices().finite());
  return result;
}

TEST(ClothTear, AStripTearsAtItsStrain) {
  const Strip torn = load_strip(0.1f, 1000), other = load_strip(0.12f, 1000), whole = load_strip(0, 1000);
  RecordProperty("strain", std::to_string(torn.strain));
  EXPECT_NEAR(torn.strain / 0.1, 1, 0.05);
  EXPECT_GT(std::fabs(other.strain / 0.1 - 1), 0.1); // another strain shows
  EXPECT_GE(torn.pieces, 2u);
  EXPECT_GT(torn.vertices, 9u * 17u);
  EXPECT_LT(torn.lowest, -2); // what has come off falls
  EXPECT_EQ(whole.strain, 0);
  EXPECT_EQ(whole.pieces, 1u);
  EXPECT_EQ(whole.vertices, 9u * 17u);
  EXPECT_GT(whole.lowest, -0.6f); // 20 % longer at its end, and it swings a little
}

/* Substeps so long for that damping that the strip hangs far longer than its load would stretch it. By the strain that shows it tears under a tenth of the load; by the load, when the
 * soft strip swings at about half of it. */
TEST(ClothTear, WhatHasNotConvergedTearsByItsLoad) {
  const Strip torn = load_strip(0.1f, 1000, 8, 0.02f);
  RecordProperty("strain", std::to_string(torn.strain));
  EXPECT_GT(torn.strain, 0.04);
  EXPECT_LT(torn.strain, 0.11);
  EXPECT_GE(torn.pieces, 2u);
}

/* Pulled to more than twice its length between two corners, with iterations far too few for so light a cloth: its forces show nothing of that. */
TEST(ClothTear, WhatIsPulledApartTears) {
  const Grid grid(9, 9, 0.01f);
  scenes::World world(cloths::world_def(5, 4));
  loam_cloth_def def = cloths::definition(grid);
  def.greatest_stretch = 0.1f;
  def.tear_strain = 0.05f;
  const Cloth cloth(world.get(), def);
  cloth.attach({grid.at(0, 0), grid.at(9, 0)}, {-0.12f, 0, -0.045f, 0.12f, 0, -0.045f}, 1e-4f);
  for (int frame = 0; frame < 20; ++frame) world.step(1.0f / 60);
  EXPECT_GT(cloth.vertices().count(), 100u);
}

TEST(ClothTear, ATornClothKeepsItsMass) {
  const Grid grid(8, 16, 0.025f, true);
  scenes::World world(cloths::world_def(5, 4));
  loam_cloth_def def = cloths::definition(grid);
  def.greatest_stretch = 0;
  def.tear_strain = 0.05f;
  def.bending_stiffness = 1e-3f;
  const Cloth cloth(world.get(), def);
  cloth.attach({grid.at(0, 0), grid.at(8, 0)}, {-0.3f, 0, 0, 0.3f, 0, 0});
  std::uint64_t tears = 0;
  for (int frame = 0; frame < 60; ++frame) {
    world.step(1.0f / 60);
    tears += world.statistics().cloth_tears;
  }
  ASSERT_GT(tears, 0u);
  const Cloth::Vertices now = cloth.vertices();
  EXPECT_EQ(now.count(), 9u * 17u + tears);
  EXPECT_TRUE(now.finite());
  scenes::require(
      loam_cloth_release(world.get(), cloth.id, std::vector<std::uint32_t>{grid.at(0, 0), grid.at(8, 0)}.data(), 2),
      "loam_cloth_release");
  double mass = 0;
  for (const float inverse_mass : cloth.vertices().inverse_masses) mass += 1 / double(inverse_mass);
  EXPECT_NEAR(mass / (0.15 * 0.2 * 0.4), 1, 1e-5);
}

} // namespace
} // namespace loam
