/* Colliders of imperfect meshes: a heap falls onto each, and none of it may pass a surface, blow up, or stick. */
#include "hard_case.h"

namespace loam {
namespace {

using meshes::Mesh;
using test::block;
using test::HardCase;
using test::Outcome;
using test::survive;
using test::without_planes;

class MeshCollider : public test::OfASolver {
protected:
  /* Sand falls 3 cm onto the mesh, which stands at height 0, 0.2 m above the ground. */
  HardCase heap_on(const Mesh &mesh) const {
    scenes::Scene heap = block(scenes::sand(), 6, 0.24f);
    HardCase hard(GetParam(), {heap});
    hard.prepare = [mesh](scenes::World &world) { test::add_mesh(world, mesh, 0.6f, 0, 0.2f, 0); };
    return hard;
  }
};
INSTANTIATE_TEST_SUITE_P(Solvers, MeshCollider, test::both_solvers(), test::solver_name);

std::size_t below(const Outcome &outcome, float height) {
  std::size_t count = 0;
  for (std::size_t i = 1; i < outcome.end.positions.size(); i += 3) count += outcome.end.positions[i] < height ? 1 : 0;
  return count;
}

TEST_P(MeshCollider, AnOpenSheetHoldsTheHeap) {
  test::shows("sand falls onto an open sheet");
  const Outcome outcome = survive(heap_on(meshes::sheet(0.3f, 5)));
  EXPECT_EQ(below(outcome, 0.2f), 0u);
  EXPECT_LT(outcome.statistics.mean_speed, 0.2);
}

TEST_P(MeshCollider, AThinPlateHoldsTheHeap) {
  test::shows("onto a plate a thousandth of a kernel radius thick");
  const Outcome outcome = survive(heap_on(meshes::box(0.3f, 1e-5f, 0.3f))); // a thousandth of r
  EXPECT_EQ(below(outcome, 0.2f), 0u);
  EXPECT_LT(outcome.statistics.mean_speed, 0.2);
}

TEST_P(MeshCollider, SliversAMetreLongAndAHairWideHoldTheHeap) {
  test::shows("onto needles a metre long and half a millimetre wide");
  Mesh fan; // a sheet made of needles
  constexpr int needles = 600;
  for (int k = 0; k <= needles; ++k) {
    fan.vertex(-0.5f, 0, -0.15f + 0.3f * float(k) / needles);
    fan.vertex(0.5f, 0, -0.15f + 0.3f * float(k) / needles);
  }
  for (std::uint32_t k = 0; k < needles; ++k) fan.quad(2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1);
  const Outcome outcome = survive(heap_on(fan));
  EXPECT_EQ(below(outcome, 0.2f), 0u);
  EXPECT_LT(outcome.statistics.mean_speed, 0.2);
}

TEST_P(MeshCollider, DegenerateAndRepeatedTrianglesDoNoHarm) {
  test::shows("onto a mesh with every triangle three times, and some without area");
  Mesh mesh = meshes::sheet(0.3f, 3);
  const Mesh once = mesh;
  mesh.append(once); // every triangle twice
  mesh.append(once, 0, -1e-7f, 0);
  mesh.triangle(0, 0, 1);
  mesh.triangle(0, 1, 2); // on a line
  const std::uint32_t far = mesh.vertex(0.3f, 1e-9f, 0.3f);
  mesh.triangle(0, far, far);
  const Outcome outcome = survive(heap_on(mesh));
  EXPECT_EQ(below(outcome, 0.2f), 0u);
  EXPECT_LT(outcome.statistics.mean_speed, 0.2);
}

TEST_P(MeshCollider, NonManifoldFinsHoldTheHeap) {
  test::shows("onto a mesh with three triangles at an edge");
  Mesh mesh = meshes::sheet(0.3f, 4);
  for (std::uint32_t k = 0; k < 4; ++k) { // fins on inner edges, upward and downward
    const std::uint32_t a = 5 * k + 2, b = 5 * k + 7;
    mesh.triangle(a, b, mesh.vertex(0, 0.02f, -0.2f + 0.1f * float(k)));
    mesh.triangle(a, b, mesh.vertex(0, -0.05f, -0.2f + 0.1f * float(k)));
  }
  const Outcome outcome = survive(heap_on(mesh));
  EXPECT_EQ(below(outcome, 0.2f), 0u);
  EXPECT_LT(outcome.statistics.mean_speed, 0.3);
}

TEST_P(MeshCollider, ASelfIntersectingMeshHoldsTheHeap) {
  test::shows("onto bodies that run through each other");
  Mesh mesh = meshes::box(0.3f, 0.02f, 0.3f);
  mesh.append(meshes::box(0.02f, 0.05f, 0.3f)); // a ridge through the plate
  mesh.append(meshes::icosphere(0.03f, 1), 0.05f, 0.01f, 0);
  const Outcome outcome = survive(heap_on(mesh));
  EXPECT_EQ(below(outcome, 0.22f), 0u);
  EXPECT_LT(outcome.statistics.mean_speed, 0.3);
}

TEST_P(MeshCollider, ATriangleSmallerThanAParticleIsMetAndPassed) {
  test::shows("a single triangle smaller than a particle");
  Mesh speck;
  speck.triangle(speck.vertex(0, 0, 0), speck.vertex(0, 0, 1e-3f), speck.vertex(1e-3f, 0, 0));
  HardCase hard = heap_on(speck);
  const Outcome outcome = survive(hard);
  EXPECT_GT(below(outcome, 0.2f), outcome.end.count() / 2); // it fell on to the ground
  EXPECT_GT(outcome.lowest, 0.0025);
}

/* Shot at thirty metres a second at a closed surface from inside: nothing comes out. */
TEST_P(MeshCollider, NothingLeavesAClosedMesh) {
  test::shows("sand shot at the inside of a closed ball at up to 30 m/s: none comes out");
  const Mesh ball = meshes::icosphere(0.08f, 2);
  scenes::Scene sand = without_planes(block(scenes::sand(), 7, 0));
  for (std::size_t i = 0; i < sand.positions.size(); i += 3) {
    sand.positions[i + 1] -= 0.04f;
    for (std::size_t k = 0; k < 3; ++k) sand.velocities[i + k] = 600 * sand.positions[i + k];
  }
  HardCase hard(GetParam(), {sand});
  hard.prepare = [&](scenes::World &world) { test::add_mesh(world, ball); };
  hard.def.substeps = 16;
  hard.step_seconds = 1.0f / 240;
  const float at[3] = {0, 0, 0};
  hard.each = [&](scenes::World &world, int step) {
    if (step % 10 == 0) {
      EXPECT_EQ(test::outside(world.snapshot().positions, ball, at), 0u);
    }
  };
  const Outcome outcome = survive(hard);
  EXPECT_EQ(test::outside(outcome.end.positions, ball, at), 0u);
  EXPECT_LT(outcome.statistics.mean_speed, 1);
}

} // namespace
} // namespace loam
