/* Meshes that deform: the same bits for any number of threads and instruction set, and from snapshots. */
#include <gtest/gtest.h>

#include "support/deforming.h"
#include "support/hooks.h"
#include "support/snapshots.h"

namespace loam {
namespace {

/* A block collapses onto a ball that beats, drifts by its vertices and turns by its pose. */
class BeatingBall {
public:
  explicit BeatingBall(std::uint32_t threads = 1, std::uint32_t set = LOAM_INSTRUCTION_SET_AUTO)
      : world_(definition(scene_, threads, set)) {
    scenes::Scene moved = scene_;
    moved.planes.clear();
    world_.add(moved);
    ball_ = deforming::add(world_, mesh_);
  }
  static loam_world_def definition(const scenes::Scene &scene, std::uint32_t threads, std::uint32_t set) {
    loam_world_def def = scenes::world_def(scene);
    def.thread_count = threads;
    def.instruction_set = set;
    def.substeps = 6;
    return def;
  }
  void aim(int frame) {
    const float time = float(frame) / 120, turn[4] = {0, 0, 0.05f * float(frame), 1}, at[3] = {0, 0, 0};
    deforming::move(
        world_, ball_,
        deforming::moved(deforming::squashed(mesh_, 0.3f * std::sin(20 * time), 5), [&](float *x) { x[1] += 0.2f * time; }));
    scenes::require(loam_collider_move(world_.get(), ball_, at, turn), "move");
  }
  void step(int frame) {
    aim(frame);
    world_.step(1.0f / 120);
  }
  scenes::World &world() { return world_; }
  loam_collider_id ball() const { return ball_; }
  const meshes::Mesh &mesh() const { return mesh_; }

private:
  scenes::Scene scene_ = scenes::drop_block(scenes::sand(), 7, 0.02f, 1);
  meshes::Mesh mesh_ = meshes::icosphere(0.02f, 2);
  scenes::World world_;
  loam_collider_id ball_ = 0;
};

bool has(std::uint32_t set) {
  const loam_world_def def = BeatingBall::definition(scenes::drop_block(scenes::sand(), 2, 0), 1, set);
  loam_world *world = nullptr;
  const bool made = loam_world_create(&def, &world) == LOAM_OK;
  loam_world_destroy(world);
  return made;
}

std::uint64_t hash_of(std::uint32_t threads, std::uint32_t set) {
  BeatingBall ball(threads, set);
  for (int frame = 1; frame <= 16; ++frame) ball.step(frame);
  EXPECT_EQ(ball.world().statistics().non_finite, 0u);
  return ball.world().state_hash();
}

TEST(DeformingMesh, HasTheSameBitsForAnyNumberOfThreadsAndInstructionSet) {
  const std::uint64_t expected = hash_of(5, LOAM_INSTRUCTION_SET_AUTO);
  if (hooks::only_races) return;
  for (const std::uint32_t threads : {1u, 2u}) EXPECT_EQ(hash_of(threads, LOAM_INSTRUCTION_SET_AUTO), expected);
  for (std::uint32_t set = LOAM_INSTRUCTION_SET_PORTABLE; set <= LOAM_INSTRUCTION_SET_AVX512; ++set)
    if (has(set)) {
      EXPECT_EQ(hash_of(1, set), expected) << set;
    }
}

/* Saved between two steps with the vertices on their way, and where they rest; into the same world and another. */
TEST(SnapshotOfADeformingMesh, GoesOnWithTheSameBits) {
  BeatingBall straight;
  for (int frame = 1; frame <= 8; ++frame) straight.step(frame);
  straight.aim(9);
  const snapshots::Bytes saved = snapshots::save(straight.world().get());
  const std::uint64_t then = straight.world().state_hash();
  const auto go_on = [](BeatingBall &ball) {
    ball.world().step(1.0f / 120); // on the way
    ball.world().step(1.0f / 120); // at rest
    for (int frame = 11; frame <= 14; ++frame) ball.step(frame);
    return ball.world().state_hash();
  };
  const std::uint64_t expected = go_on(straight);
  BeatingBall other(2);
  other.step(5);
  for (BeatingBall *ball : {&straight, &other}) {
    snapshots::restore(ball->world().get(), saved);
    EXPECT_EQ(ball->world().state_hash(), then);
    EXPECT_EQ(snapshots::save(ball->world().get()), saved);
    EXPECT_EQ(go_on(*ball), expected);
  }
}

TEST(SnapshotOfADeformingMesh, IsNoneForARigidOne) {
  const meshes::Mesh mesh = meshes::icosphere(0.02f, 1);
  const scenes::Scene sand = scenes::drop_block(scenes::sand(), 2, 0);
  scenes::World soft(scenes::world_def(sand), sand), rigid(scenes::world_def(sand), sand);
  (void)deforming::add(soft, mesh);
  (void)deforming::add(rigid, mesh, 0.6f, 0, 0);
  const snapshots::Bytes saved = snapshots::save(soft.get());
  EXPECT_EQ(loam_snapshot_restore(rigid.get(), saved.data(), saved.size()), LOAM_ERROR_SNAPSHOT_MISMATCH);
  EXPECT_NE(std::string(loam_last_error()).find("deforms"), std::string::npos) << loam_last_error();
}

TEST(DeformingMesh, TheStateHashSeesItsVertices) {
  BeatingBall ball;
  const std::uint64_t before = ball.world().state_hash();
  meshes::Mesh other = ball.mesh();
  other.positions[100] += 1e-3f;
  deforming::move(ball.world(), ball.ball(), other);
  EXPECT_NE(ball.world().state_hash(), before);
  deforming::move(ball.world(), ball.ball(), ball.mesh());
  EXPECT_EQ(ball.world().state_hash(), before);
}

} // namespace
} // namespace loam
