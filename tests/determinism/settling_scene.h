/* The scene of the determinism tests: a column of sand beside a block of plasticine, on a plane, around a tilted mesh. */
#pragma once

#include <gtest/gtest.h>

#include "support/hooks.h"
#include "support/meshes.h"
#include "support/scenes.h"

namespace loam::test {

struct SettlingScene {
  scenes::Scene sand = scenes::axisymmetric_column(scenes::sand(), 5, 1);
  scenes::Scene clay = scenes::drop_block(scenes::plasticine(), 5, 0.06f, 1);
  meshes::Mesh ball = meshes::icosphere(0.02f, 2);

  loam_world_def definition() const {
    loam_world_def def = scenes::world_def(sand);
    def.particle_capacity = sand.count() + clay.count();
    def.substeps = 4;
    def.iterations = 3;
    return def;
  }
  /* The state's hash after so many frames of 1/240 s, the mesh moving through the heap all the while. */
  std::uint64_t hash_after(const loam_world_def &def, int frames, const loam_accuracy_def *accuracy = nullptr) const {
    scenes::World world(def, sand);
    if (accuracy != nullptr) scenes::require(loam_world_use_accuracy(world.get(), accuracy), "accuracy");
    scenes::Scene block = clay;
    block.planes.clear();
    world.add(block);
    loam_collider_def collider;
    scenes::require(loam_collider_def_default(&collider, sizeof collider), "default");
    collider.kind = LOAM_COLLIDER_MESH;
    collider.mesh = ball.view();
    collider.position[0] = -0.08f;
    loam_collider_id id = 0;
    scenes::require(loam_collider_create(world.get(), &collider, &id), "collider");
    for (int frame = 1; frame <= frames; ++frame) {
      const float at[3] = {-0.08f + 0.001f * float(frame), 0.015f, 0}, turn[4] = {0, 0, 0.01f * float(frame), 1};
      scenes::require(loam_collider_move(world.get(), id, at, turn), "move");
      world.step(1.0f / 240);
    }
    EXPECT_EQ(world.statistics().non_finite, 0u);
    return world.state_hash();
  }
};

} // namespace loam::test
