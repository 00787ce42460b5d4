/* What a collider whose vertices move does to matter: it carries, pushes and is pushed as a rigid one does that moves alike. */
#include <cmath>
#include <gtest/gtest.h>

#include "support/cloths.h"
#include "support/deforming.h"
#include "support/scenes.h"

namespace loam {
namespace {

using meshes::Mesh;

scenes::Scene without_planes(scenes::Scene scene) {
  scene.planes.clear();
  return scene;
}

/* A floor slides under a block at 0.2 m/s, by its vertices: it moves with the floor once friction has sped it up. */
TEST(DeformingCollider, CarriesByFrictionWhatLiesOnIt) {
  const Mesh floor = meshes::sheet(0.15f, 8);
  scenes::World world(scenes::world_def(scenes::drop_block(scenes::rubber(1e6f), 6, 0)),
                      without_planes(scenes::drop_block(scenes::rubber(1e6f), 6, 0)));
  const loam_collider_id id = deforming::add(world, floor, 0.6f);
  constexpr float speed = 0.2f, frame = 1.0f / 120;
  const auto mean = [&](std::size_t axis) {
    const scenes::Snapshot now = world.snapshot();
    double sum = 0;
    for (std::size_t i = axis; i < now.positions.size(); i += 3) sum += double(now.positions[i]);
    return sum / double(now.count());
  };
  double before = 0;
  for (int k = 1; k <= 48; ++k) {
    if (k == 25) before = mean(0);
    deforming::move(world, id, deforming::moved(floor, [&](float *x) { x[0] += speed * frame * float(k); }));
    world.step(frame);
  }
  const double way = double(speed * frame) * 24;
  EXPECT_NEAR(mean(0) - before, way, 0.02 * way);
  EXPECT_NEAR(mean(1), 0.03, 0.002);
}

/* A floor that rises as a whole, and one that bulges, lift sand. */
TEST(DeformingCollider, LiftsWhatLiesOnItAsARigidOneDoes) {
  const Mesh floor = meshes::sheet(0.1f, 8);
  const scenes::Scene sand = without_planes(scenes::drop_block(scenes::sand(), 5, 0));
  const auto lifted = [&](bool by_vertices) {
    loam_world_def def = scenes::world_def(sand);
    scenes::World world(def, sand);
    const loam_collider_id id = deforming::add(world, floor, 0.6f, 0, by_vertices ? 1 : 0);
    const float upright[4] = {0, 0, 0, 1};
    for (int k = 1; k <= 24; ++k) {
      const float height = 0.05f * float(k) / 24, at[3] = {0, height, 0};
      if (by_vertices)
        deforming::move(world, id, deforming::moved(floor, [&](float *x) { x[1] = height; }));
      else
        scenes::require(loam_collider_move(world.get(), id, at, upright), "move");
      world.step(1.0f / 120);
    }
    return world.snapshot();
  };
  const scenes::Snapshot rigid = lifted(false), soft = lifted(true);
  double lowest = 1, greatest = 0;
  for (std::size_t i = 0; i < rigid.positions.size(); ++i)
    greatest = std::max(greatest, std::abs(double(rigid.positions[i] - soft.positions[i])));
  for (std::size_t i = 1; i < soft.positions.size(); i += 3) lowest = std::min(lowest, double(soft.positions[i]));
  EXPECT_GT(lowest, 0.05);
  EXPECT_LT(greatest, 5e-4); // of 5 cm: rounding, grown by the grains
}

/* One whose vertices are moved to where they are is at rest: the same bits as a mesh that cannot deform. */
TEST(DeformingCollider, AtRestIsARigidOne) {
  const Mesh ball = meshes::icosphere(0.03f, 2);
  const scenes::Scene sand = without_planes(scenes::drop_block(scenes::sand(), 6, 0.03f, 1));
  const auto run = [&](bool deforms) {
    scenes::World world(scenes::world_def(sand), sand);
    const loam_collider_id id = deforming::add(world, ball, 0.6f, 0, deforms ? 1 : 0);
    for (int k = 0; k < 20; ++k) {
      if (deforms && k % 2 == 0) deforming::move(world, id, ball);
      world.step(1.0f / 120);
    }
    return world.snapshot();
  };
  const scenes::Snapshot rigid = run(false), soft = run(true);
  EXPECT_EQ(rigid.positions, soft.positions);
  EXPECT_EQ(rigid.velocities, soft.velocities);
}

/* Sand without gravity falls onto a ball that beats and turns by its vertices: what the ball is told is what the sand lost. */
TEST(DeformingCollider, ReactionIsTheMomentumThatMatterLost) {
  const Mesh ball = meshes::icosphere(0.03f, 2);
  scenes::Scene sand = without_planes(scenes::drop_block(scenes::sand(), 5, 0.03f, 2));
  loam_world_def def = scenes::world_def(sand);
  def.gravity[1] = 0;
  scenes::World world(def, sand);
  const loam_collider_id id = deforming::add(world, ball, 0.6f, 1);
  using Vector = std::array<double, 3>;
  Vector lost{}, lost_moment{}, impulse{}, torque{};
  const auto add_momentum = [&](double sign) {
    const scenes::Snapshot now = world.snapshot();
    for (std::size_t i = 0; i < now.count(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const double mass = sign / double(now.inverse_masses[i]);
        const std::size_t a = 3 * i + (k + 1) % 3, b = 3 * i + (k + 2) % 3;
        lost[k] += mass * double(now.velocities[3 * i + k]);
        lost_moment[k] += mass * (double(now.positions[a]) * double(now.velocities[b]) -
                                  double(now.positions[b]) * double(now.velocities[a]));
      }
  };
  add_momentum(1);
  for (int k = 1; k <= 30; ++k) {
    const float time = float(k) / 120, share = 0.3f * std::sin(30 * time), turn = 4 * time;
    deforming::move(world, id, deforming::moved(deforming::squashed(ball, share, 20 * share), [&](float *x) {
                      const float y = x[1], z = x[2];
                      x[1] = std::cos(turn) * y - std::sin(turn) * z;
                      x[2] = std::sin(turn) * y + std::cos(turn) * z;
                    }));
    world.step(1.0f / 120);
    loam_collider_reaction reaction = {};
    reaction.struct_size = sizeof reaction;
    scenes::require(loam_collider_get_reaction(world.get(), id, &reaction), "reaction");
    for (std::size_t j = 0; j < 3; ++j) {
      impulse[j] += reaction.impulse[j];
      torque[j] += reaction.torque[j];
    }
  }
  add_momentum(-1);
  EXPECT_EQ(world.statistics().speed_limited, 0u);
  const auto size = [](const Vector &v) { return std::hypot(v[0], v[1], v[2]); };
  const auto apart = [&](const Vector &a, const Vector &b) { return size({a[0] - b[0], a[1] - b[1], a[2] - b[2]}); };
  EXPECT_GT(size(lost), 0.05 * 125 * 0.0016 * 2);
  EXPECT_LT(apart(impulse, lost), 0.01 * size(lost));
  EXPECT_LT(apart(torque, lost_moment), 0.01 * std::max(size(lost_moment), 0.03 * size(lost)));
}

/* Sand asleep on a floor wakes when that bulges, and not before. */
TEST(DeformingCollider, WakesWhatSleepsOnIt) {
  const Mesh floor = meshes::sheet(0.1f, 8);
  const scenes::Scene sand = without_planes(scenes::drop_block(scenes::sand(), 5, 0));
  loam_world_def def = scenes::world_def(sand);
  def.sleep_speed = 0.05f;
  def.sleep_delay = 0.05f;
  scenes::World world(def, sand);
  const loam_collider_id id = deforming::add(world, floor, 1);
  for (int k = 0; k < 120 && world.statistics().sleeping < sand.count(); ++k) world.step(1.0f / 120);
  ASSERT_EQ(world.statistics().sleeping, sand.count());
  const auto mean = [&] {
    const scenes::Snapshot now = world.snapshot();
    double sum = 0;
    for (std::size_t i = 1; i < now.positions.size(); i += 3) sum += double(now.positions[i]);
    return sum / double(now.count());
  };
  const double before = mean();
  deforming::move(world, id, floor); // to where it is
  world.step(1.0f / 120);
  EXPECT_EQ(world.statistics().sleeping, sand.count());
  for (int k = 1; k <= 4; ++k) {
    deforming::move(world, id,
                    deforming::moved(floor, [&](float *x) { x[1] = 0.002f * float(k) * (1 - 80 * x[0] * x[0]); }));
    world.step(1.0f / 120);
  }
  EXPECT_LT(world.statistics().sleeping, 20u);
  EXPECT_NEAR(mean() - before, 0.008 * (1 - 80 * 0.02 * 0.02), 0.002);
}

/* A ball grows under a cloth that lies over it: no vertex gets into it. */
TEST(DeformingCollider, PushesCloth) {
  scenes::World world(cloths::world_def(10, 4));
  const Mesh ball = meshes::icosphere(0.06f, 2);
  const loam_collider_id id = deforming::add(world, ball, 0.3f);
  const cloths::Grid grid(16, 16, 0.015f);
  const cloths::Cloth sheet(world.get(), cloths::definition(grid));
  const float at[3] = {0, -0.08f, 0}, upright[4] = {0, 0, 0, 1};
  scenes::require(loam_collider_place(world.get(), id, at, upright), "place");
  double lowest = 1e30;
  for (int k = 1; k <= 40; ++k) {
    const float growth = 1 + 0.5f * float(k) / 40;
    deforming::move(world, id, deforming::moved(ball, [&](float *x) {
                      for (int axis = 0; axis < 3; ++axis) x[axis] *= growth;
                    }));
    world.step(1.0f / 60);
    const cloths::Cloth::Vertices now = sheet.vertices();
    for (std::size_t i = 0; i < now.count(); ++i)
      lowest = std::min(lowest, std::hypot(double(now.positions[3 * i]), double(now.positions[3 * i + 1] - at[1]),
                                           double(now.positions[3 * i + 2])) /
                                    double(0.06f * growth));
  }
  EXPECT_GT(lowest, 0.96); // facets lie within the sphere by 3 %
}

} // namespace
} // namespace loam
