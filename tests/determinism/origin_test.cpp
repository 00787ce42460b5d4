/* Shifting the origin by a multiple of a power of two, towards the matter, is exact: the world is then, bit for bit, one that was made there. */
#include <cmath>

#include <gtest/gtest.h>

#include "support/cloths.h"
#include "support/scenes.h"

namespace loam {
namespace {

/* Sand on a plane beside a ball, under a sheet that hangs at a corner, all of it at `at`. */
class World {
public:
  explicit World(const std::vector<float> &positions, const float at[3]) : world_(definition()) {
    scenes::Scene sand = scenes::jittered_block(scenes::sand(), 300);
    sand.planes.clear();
    sand.positions = positions;
    world_.add(sand);
    loam_collider_def collider;
    scenes::require(loam_collider_def_default(&collider, sizeof collider), "default");
    std::copy(at, at + 3, collider.position);
    loam_collider_id id = 0;
    scenes::require(loam_collider_create(world_.get(), &collider, &id), "plane");
    collider.kind = LOAM_COLLIDER_SPHERE;
    collider.radius = 0.03f;
    scenes::require(loam_collider_create(world_.get(), &collider, &id), "ball");
    const cloths::Grid grid(5, 5, 0.0625f);
    loam_cloth_def cloth_def = cloths::definition(grid);
    std::copy(at, at + 3, cloth_def.position);
    cloth_def.position[1] += 0.25f;
    const cloths::Cloth cloth(world_.get(), cloth_def);
    cloth.attach({0});
  }
  static loam_world_def definition() {
    loam_world_def def = scenes::world_def(scenes::jittered_block(scenes::sand(), 300));
    def.substeps = 4;
    return def;
  }
  void shift(const float by[3]) { scenes::require(loam_world_shift_origin(world_.get(), by), "shift"); }
  scenes::World &operator*() { return world_; }
  scenes::World *operator->() { return &world_; }

private:
  scenes::World world_;
};

std::vector<float> far_positions(const float at[3]) {
  std::vector<float> positions = scenes::jittered_block(scenes::sand(), 300).positions;
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] += at[i % 3];
  return positions;
}

TEST(Origin, AShiftTowardsTheMatterIsExact) {
  const float at[3] = {1024, -256, 512}, here[3] = {0, 0, 0};
  const std::vector<float> far = far_positions(at);
  std::vector<float> near = far;
  for (std::size_t i = 0; i < near.size(); ++i) near[i] -= at[i % 3];
  World shifted(far, at), made(near, here);
  EXPECT_NE(shifted->state_hash(), made->state_hash());
  shifted.shift(at);
  EXPECT_EQ(shifted->state_hash(), made->state_hash());
  for (int frame = 0; frame < 5; ++frame) {
    shifted->step(4e-3f);
    made->step(4e-3f);
  }
  EXPECT_EQ(shifted->state_hash(), made->state_hash());
}

/* Every distance is what it was; by a shift that is no such multiple, most are not. */
TEST(Origin, DistancesStayToTheLastBit) {
  const float at[3] = {1024, -256, 512};
  const std::vector<float> far = far_positions(at);
  const auto changed = [&](const float by[3]) {
    World world(far, at);
    world.shift(by);
    const scenes::Snapshot after = world->snapshot();
    std::size_t count = 0;
    for (std::size_t i = 0; i < far.size(); ++i)
      count += double(after.positions[i]) != double(far[i]) - double(by[i % 3]) ? 1 : 0;
    return count;
  };
  const float exact[3] = {1024, -256, 512}, half[3] = {768, -128, 256.5f}, rounded[3] = {1000.1f, -250.3f, 500.7f};
  EXPECT_EQ(changed(exact), 0u);
  EXPECT_EQ(changed(half), 0u);
  const float away[3] = {-3000.1f, 1000.3f, -3000.7f};
  EXPECT_EQ(changed(rounded), 0u); /* towards the origin, and a multiple of the last places */
  EXPECT_GT(changed(away), far.size() / 2);
}

/* Far out, sand is coarse: what the shift is for. */
TEST(Origin, AShiftAndBackGoesOnAsIfNothingHadBeen) {
  const float here[3] = {0, 0, 0}, by[3] = {16, -8, 4}, back[3] = {-16, 8, -4};
  const std::vector<float> positions = far_positions(here);
  World still(positions, here), moved(positions, here);
  for (int frame = 0; frame < 10; ++frame) {
    still->step(4e-3f);
    moved->step(4e-3f);
    moved.shift(frame % 2 == 0 ? by : back);
  }
  const scenes::Snapshot a = still->snapshot(), b = moved->snapshot();
  double worst = 0;
  for (std::size_t i = 0; i < a.positions.size(); ++i)
    worst = std::max(worst, std::fabs(double(a.positions[i]) - double(b.positions[i])));
  EXPECT_LT(worst, 0.002); /* a fifth of a kernel radius: other cells, other orders of visits */
}

} // namespace
} // namespace loam
