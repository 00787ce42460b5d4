/* What users complain of first: sand leaking through a cup that is carried about, a thin floor, a spoon that is drawn through it. Ten seconds of each, at
 * the default step: no particle may ever be on the wrong side. */
#include "hard_case.h"
#include "support/solids.h"

namespace loam {
namespace {

using meshes::Mesh;
using test::block;
using test::HardCase;
using test::Outcome;
using test::ten_seconds;

/* How a collider is moved: where it is, and its turn by an angle about an axis. */
struct Placement {
  float position[3], rotation[4];
};
Placement placement(float x, float y, float z, const float axis[3], float angle) {
  const float size = std::hypot(axis[0], axis[1], axis[2]), half = std::sin(0.5f * angle) / size;
  return {{x, y, z}, {half * axis[0], half * axis[1], half * axis[2], std::cos(0.5f * angle)}};
}

/* A closed cup of 9 cm with walls one triangle thick, half full, is carried around a square at 3 m/s, starting, stopping and turning at once, and spun at
 * 10 rad/s about a slanted axis. */
TEST(Leaks, ACupOfSandCarriedAndSpun) {
  test::shows("a closed cup of sand carried at 3 m/s with sudden turns and spun at 10 rad/s, ten seconds: none outside");
  const Mesh cup = meshes::revolution({{0.04f, -0.045f}, {0.045f, 0.045f}}, 20);
  scenes::Scene sand = test::without_planes(block(scenes::sand(), 5, 0));
  for (std::size_t i = 1; i < sand.positions.size(); i += 3) sand.positions[i] += 1 - 0.038f;
  HardCase hard = ten_seconds({sand});
  hard.collider_speed = 3 + 10 * 0.065;
  loam_collider_id id = 0;
  hard.prepare = [&](scenes::World &world) { id = test::add_mesh(world, cup, 0.5f, 0, 1, 0); };
  const auto at = [](int frame) {
    const int moved = std::max(0, frame - 20), side = moved / 12 % 4;
    const float along = 0.05f * float(moved % 12); // 3 m/s
    const float x = side == 0 ? along : side == 1 ? 0.6f : side == 2 ? 0.6f - along : 0;
    const float y = side == 0 ? 0 : side == 1 ? along : side == 2 ? 0.6f : 0.6f - along;
    const float axis[3] = {0.3f, 1, 0.2f};
    return placement(x, 1 + y, 0, axis, float(moved) / 6); // 10 rad/s
  };
  hard.each = [&](scenes::World &world, int frame) {
    if (frame % 10 == 0) {
      const std::vector<float> positions = world.snapshot().positions;
      const Placement now = at(frame);
      std::size_t outside = 0;
      for (std::size_t i = 0; i < positions.size(); i += 3)
        outside += meshes::winding_number(cup, solids::to_local(&positions[i], now.position, now.rotation).data()) < 0.5;
      EXPECT_EQ(outside, 0u) << "frame " << frame;
    }
    const Placement next = at(frame + 1);
    scenes::require(loam_collider_move(world.get(), id, next.position, next.rotation), "move");
  };
  std::uint64_t hash = 0;
  const Outcome outcome = test::run_once(hard, hash);
  test::record(outcome, hard.steps / 60.0);
}

TEST(Leaks, SandFallsFiveMetresOntoAFloorOneTriangleThick) {
  test::shows("sand falling 5 m onto a floor one triangle thick, ten seconds: none below");
  HardCase hard = ten_seconds({test::without_planes(block(scenes::sand(), 5, 5))});
  hard.prepare = [](scenes::World &world) { test::add_mesh(world, meshes::sheet(4, 1), 0.5f); };
  float lowest = 1;
  hard.each = [&](scenes::World &world, int frame) {
    if (frame % 10 != 0) return;
    const std::vector<float> positions = world.snapshot().positions;
    for (std::size_t i = 0; i < positions.size(); i += 3) lowest = std::min(lowest, positions[i + 1]);
  };
  std::uint64_t hash = 0;
  const Outcome outcome = test::run_once(hard, hash);
  test::record(outcome, hard.steps / 60.0);
  EXPECT_GT(lowest, 0);
  EXPECT_GT(outcome.lowest, 0);
  if (hooks::short_run()) return;
  EXPECT_GT(outcome.peak_speed, 9);
  EXPECT_LT(outcome.statistics.mean_speed, 0.02);
}

/* A paddle one triangle thick sweeps to and fro through sand in a tray at 1.5 m/s, turning at 5 rad/s about the vertical. */
TEST(Leaks, AThinPaddleIsDrawnThroughAHeap) {
  test::shows(
      "a paddle one triangle thick drawn through a heap at 1.5 m/s, ten seconds: nothing gets through it or the tray");
  const Mesh tray = meshes::box(0.085f, 0.06f, 0.06f);
  Mesh paddle = meshes::sheet(0.03f, 2);
  for (std::size_t i = 0; i < paddle.positions.size(); i += 3)
    std::swap(paddle.positions[i], paddle.positions[i + 1]); // upright
  HardCase hard = ten_seconds({test::without_planes(block(scenes::sand(), 6, 0))});
  hard.collider_speed = 1.5 + 5 * 0.03;
  loam_collider_id id = 0;
  const auto at = [](int frame) {
    const float way = std::fmod(1.5f / 60 * float(frame), 0.16f), axis[3] = {0, 1, 0};
    return placement((way < 0.08f ? way : 0.16f - way) - 0.04f, 0.043f, 0, axis, float(frame) / 12);
  };
  const float middle[3] = {0, 0.06f, 0};
  std::vector<solids::Point> before;
  std::size_t crossed = 0, met = 0;
  const auto look = [&](scenes::World &world, int frame) {
    const std::vector<float> positions = world.snapshot().positions;
    const Placement now = at(frame);
    std::vector<solids::Point> local;
    for (std::size_t i = 0; i < positions.size(); i += 3) {
      local.push_back(solids::to_local(&positions[i], now.position, now.rotation));
      if (before.empty()) continue;
      // In front of the paddle's middle before and after: no way around its edge in one frame.
      const solids::Point &from = before[i / 3], &to = local.back();
      const auto in_front = [](const solids::Point &p) { return std::abs(p[0]) < 0.02 && std::hypot(p[1], p[2]) < 0.02; };
      if (!in_front(from) || !in_front(to)) continue;
      ++met;
      crossed += (from[0] > 0) != (to[0] > 0) ? 1 : 0;
    }
    before = local;
    if (frame % 10 == 0) {
      EXPECT_EQ(test::outside(positions, tray, middle), 0u) << "frame " << frame;
    }
  };
  hard.prepare = [&](scenes::World &world) {
    test::add_mesh(world, tray, 0.5f, 0, 0.06f, 0);
    id = test::add_mesh(world, paddle, 0.5f);
    const Placement start = at(0);
    scenes::require(loam_collider_place(world.get(), id, start.position, start.rotation), "place");
  };
  hard.each = [&](scenes::World &world, int frame) {
    look(world, frame);
    const Placement next = at(frame + 1);
    scenes::require(loam_collider_move(world.get(), id, next.position, next.rotation), "move");
  };
  std::uint64_t hash = 0;
  const Outcome outcome = test::run_once(hard, hash);
  test::record(outcome, hard.steps / 60.0);
  EXPECT_EQ(crossed, 0u);
  if (!hooks::short_run()) {
    EXPECT_GT(met, 50u);
  }
}

} // namespace
} // namespace loam
