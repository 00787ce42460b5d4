// Free distances leave out queries that would find nothing: with them and without, states have the same bits.
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "cpu/kernel_table.h"
#include "scene/material.h"
#include "scenes.h"
#include "solver/backend.h"
#include "solver/collider_motion.h"
#include "support/hooks.h"
#include "unit/contact_scene.h"

namespace loam {
namespace {

using test::MeshData;
using test::turn;

constexpr float radius = 0.01f;
constexpr Pose at_origin = {{0, 0, 0}, {0, 0, 0, 1}};

// A block of sand falls into a bowl; a paddle that also stretches sweeps through, a plate comes, is placed elsewhere, and goes.
class Scene {
public:
  Scene(bool keep, unsigned threads) {
    const SolverSettings settings = {radius, 0.2f, 0.75f, 20.0f, false, false, true, 1.0f, 2000, 0, keep};
    ExecutionSettings execution = {};
    execution.thread_count = threads;
    execution.instruction_set = best_instruction_set();
    backend_ = make_cpu_backend(settings, execution);
    backend_->set_materials({{make_law(scenes::sand(35, 2e5f)), "sand", true}});
    input_.seconds = 1.0f / 60;
    input_.substeps = hooks::only_races ? 1 : hooks::short_run() ? 3 : 8;
    input_.iterations = 2;
    input_.gravity = {0, -9.81f, 0};
    add_block({0, 0, 0});
    bowl_ = add_mesh(test::icosphere_mesh(0.12f, 3), at_origin);
    paddle_ = add_mesh(blade_, {{-0.08f, -0.03f, 0}, {0, 0, 0, 1}}, true);
    input_.colliders.push_back({backend_->add_shape(PlaneShape{}), {0.5f, 0, 0}, at_origin, at_origin});
    place(2, {{0, -0.11f, 0}, {0, 0, 0, 1}});
  }

  std::uint64_t run() {
    for (int s = 0; s < 40; ++s) {
      Pose paddle = input_.colliders[1].start;
      paddle.position.x += s < 25 ? 0.004f : 0.0f;
      paddle.rotation = s < 20 ? multiply(turn({0, 1, 0.3f}, 0.1f), paddle.rotation) : paddle.rotation;
      input_.colliders[1].end = paddle;
      if (s % 4 != 3) {
        MeshData blade = blade_;
        for (Vec3<float> &v : blade.vertices) v = {v.x, (1 + 0.1f * float(s % 4)) * v.y, v.z + 0.1f * v.y * float(s % 3)};
        backend_->move_vertices(paddle_, &blade.vertices[0].x, s == 22);
      }
      input_.colliders[2].end = {{0, -0.11f + (s < 10 ? 0.001f * float(s) : 0.01f), 0},
                                 s < 30 ? turn({0, 0, 1}, 0.0f) : turn({0, 0, 1}, 0.002f)};
      if (s == 8) plate_ = add_mesh(test::floor_mesh(0.05f, 6), {{0, 0.05f, 0}, {0, 0, 0, 1}});
      if (s == 12) place(3, {{0.02f, -0.02f, 0}, turn({1, 0, 0}, 0.4f)});
      if (s == 16) add_block({0, 0.06f, 0});
      if (s == 24) {
        input_.colliders.pop_back();
        backend_->remove_shape(plate_);
      }
      backend_->step(input_);
      for (ColliderState &collider : input_.colliders) collider.start = collider.end;
    }
    EXPECT_GT(backend_->statistics().contacts, 50u);
    EXPECT_EQ(backend_->statistics().non_finite, 0u);
    return backend_->state_hash();
  }

private:
  void add_block(Vec3<float> centre) {
    std::vector<float> positions;
    const float spacing = 0.6f * radius;
    const int count = hooks::only_races ? 300 : 1000;
    for (int i = 0; i < count; ++i)
      positions.insert(positions.end(),
                       {centre.x + spacing * (float(i % 10) - 4.5f), centre.y + spacing * (float(i / 10 % 10) - 4.5f),
                        centre.z + spacing * (float(i / 100) - 4.5f)});
    NewParticles particles = {};
    particles.volume = spacing * spacing * spacing;
    particles.inverse_mass = 1 / (1600 * particles.volume);
    particles.first_id = std::uint32_t(backend_->particle_count());
    particles.positions = positions.data();
    particles.count = std::uint32_t(count);
    backend_->add_particles(particles);
  }
  int add_mesh(const MeshData &data, const Pose &pose, bool deforms = false) {
    const int mesh = backend_->add_shape(build_bounding_volume_hierarchy(make_triangle_mesh(data.view(), "mesh"), deforms));
    input_.colliders.push_back({mesh, {0.5f, 0, 0}, pose, pose});
    return mesh;
  }
  void place(std::size_t collider, const Pose &pose) {
    input_.colliders[collider].start = input_.colliders[collider].end = pose;
  }

  const MeshData blade_ = test::box_mesh({0.005f, 0.04f, 0.08f});
  std::unique_ptr<Backend> backend_;
  StepInput input_{};
  int bowl_ = -1, paddle_ = -1, plate_ = -1;
};

TEST(FreeDistances, LeaveNoTraceInTheState) {
  const std::uint64_t expected = Scene(true, hooks::only_races ? 2 : 3).run();
  if (hooks::only_races) return;
  EXPECT_EQ(Scene(false, 1).run(), expected);
  if (!hooks::short_run()) {
    EXPECT_EQ(Scene(true, 1).run(), expected);
  }
}

ColliderView view_between(const Pose &start, const Pose &end) {
  ColliderView view = {};
  view.start = start;
  view.end = end;
  return view;
}

TEST(FreeDistances, TheMotionOfCollidersIsBounded) {
  test::Random random{4};
  for (int k = 0; k < 2000; ++k) {
    const float size = k % 2 == 0 ? 1e-3f : 0.2f;
    const Pose start = {random.in_box(2), turn(random.direction(), random.between(0, 6))};
    const Pose end = {start.position + random.in_box(size),
                      multiply(turn(random.direction(), random.between(0, size)), start.rotation)};
    const ColliderView view = view_between(start, end);
    ColliderMotion motion;
    motion.include(view, 0.5f);
    const Vec3<float> point = 0.5f * random.direction();
    EXPECT_LE(length(to_world(end, point) - to_world(start, point)), motion.greatest());
    // Anything at this distance is out of the range, even with the way that the collider would carry it.
    const float enough = motion.enough(0.1f);
    const Vec3<float> outside = (0.5f + enough) * random.direction();
    EXPECT_GE(enough, 0.1f + length(to_world(end, outside) - to_world(start, outside)));
  }
  ColliderMotion rest, turning;
  rest.include(view_between(at_origin, at_origin), 1);
  EXPECT_EQ(rest.greatest(), 0);
  EXPECT_FLOAT_EQ(rest.enough(1), 1.00001f);
  turning.include(view_between(at_origin, {{0, 0, 0}, turn({0, 0, 1}, 0.01f)}), INFINITY);
  EXPECT_TRUE(std::isinf(turning.enough(1)));
}

TEST(FreeDistances, LeaveOutMostQueries) {
  test::ContactScene scene;
  scene.add_mesh(test::icosphere_mesh(1, 3), 0.5f);
  test::Random random{4};
  for (int i = 0; i < 1000; ++i) scene.add(random.between(0.2f, 0.9f) * random.direction());
  std::vector<float> free(1000, 0.0f);
  int count = 0;
  Contact contact;
  const FindContacts kernel{scene.positions.data(),
                            scene.velocities.data(),
                            scene.colliders.data(),
                            1,
                            scene.substep,
                            scene.stand_off(),
                            scene.radius,
                            &contact,
                            1,
                            &count,
                            {free.data(), 1.5f * scene.radius}};
  for (int i = 0; i < 1000; ++i) kernel(i);
  double sum = 0;
  for (int i = 0; i < 1000; ++i) {
    const float distance = 1 - length(scene.x(std::size_t(i)));
    EXPECT_LE(free[std::size_t(i)], distance);
    EXPECT_TRUE(kernel.free_distances.suffices(i));
    sum += free[std::size_t(i)] / distance;
  }
  EXPECT_GT(sum / 1000, 0.4); // boxes of triangles of 0.15 m
  const SpendFreeDistances spend{free.data(), scene.positions.data(), scene.velocities.data(), scene.substep, 0.05f};
  scene.velocities[0] = {0, 20, 0, 1000};
  const float before = free[0];
  spend(0);
  EXPECT_NEAR(free[0], before - 0.05 - 20 * scene.substep, 1e-5);
  EXPECT_LE(free[0], before - 0.05 - 20 * scene.substep);
}

} // namespace
} // namespace loam
