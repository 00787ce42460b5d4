/* emitter.h: streams, their flow and spacing, a full world, and every field of the definition. */
#include <map>

#include "small_world.h"
#include "support/streams.h"

namespace loam {
namespace {

using streams::disc;
using streams::EmptyWorld;
using test::infinity;
using test::nan;
using test::SmallWorld;

/* A third of what the nozzle carries, so that the choice of places matters; two seconds. */
TEST(Emitter, TheFlowIsExactInVolumeAndInMass) {
  for (const bool by_mass : {false, true}) {
    EmptyWorld empty(20000);
    const float gravity[3] = {};
    ASSERT_EQ(loam_world_set_gravity(empty.world.get(), gravity), LOAM_OK);
    loam_emitter_def def = disc(empty.material, 0.035f);
    const float flow = 0.33f * 3.14159265f * def.radius * def.radius * def.speed, density = scenes::sand().density;
    (by_mass ? def.mass_flow : def.flow) = by_mass ? flow * density : flow;
    const loam_emitter_id id = empty.add(def);
    for (int frame = 0; frame < 120; ++frame) empty.world.step(1.0f / 60);
    double mass = 0;
    empty.look([&](const loam_particle_view &view) {
      for (std::uint64_t i = 0; i < view.count; ++i)
        if (view.velocities[4 * i + 3] > 0) mass += 1 / double(view.velocities[4 * i + 3]);
    });
    const loam_emitter_report report = empty.report(id);
    EXPECT_NEAR(double(report.entered) * report.volume, 2.0 * double(flow), 0.001 * 2 * double(flow));
    EXPECT_NEAR(report.volume_flow, double(flow), 1e-6 * double(flow));
    // Without those that the nozzle still leads: at most a layer of 200.
    EXPECT_NEAR(mass, 2.0 * double(flow * density), 0.01 * 2 * double(flow * density));
    EXPECT_EQ(empty.world.statistics().particles, report.entered);
    EXPECT_EQ(report.dropped, 0u);
  }
}

TEST(Emitter, NoTwoParticlesEnterCloserThanTheSpacingLessItsJitter) {
  for (const float jitter : {0.0f, 0.12f}) {
    EmptyWorld empty(4000);
    const float gravity[3] = {};
    ASSERT_EQ(loam_world_set_gravity(empty.world.get(), gravity), LOAM_OK);
    loam_emitter_def def = disc(empty.material, 0.03f);
    def.jitter = jitter;
    def.speed = 1.3f;
    (void)empty.add(def);
    for (int frame = 0; frame < 15; ++frame) empty.world.step(1.0f / 60);
    EXPECT_GT(empty.world.statistics().particles, 800u);
    EXPECT_GT(empty.least_distance(), jitter > 0 ? 0.0076 : 0.0099); // 1 cm (1 - 2 jitter)
  }
}

/* Where the particles are along the flow, as angles of a turn a spacing: layers would have one angle each. Full, and with a third of the flow. */
TEST(Emitter, AStreamShowsNoLayers) {
  for (const float share : {1.0f, 0.33f}) {
    EmptyWorld empty(4000);
    const float gravity[3] = {};
    ASSERT_EQ(loam_world_set_gravity(empty.world.get(), gravity), LOAM_OK);
    loam_emitter_def def = disc(empty.material, 0.03f);
    def.flow = 0.999f * share * 3.14159265f * def.radius * def.radius * def.speed;
    (void)empty.add(def);
    for (int frame = 0; frame < 12; ++frame) empty.world.step(1.0f / 60);
    double cosines = 0, sines = 0, count = 0, first = 0, last = 0;
    empty.look([&](const loam_particle_view &view) {
      count = double(view.count);
      for (std::uint64_t i = 0; i < view.count; ++i) {
        const double along = 1 - double(view.positions[4 * i + 1]), angle = 2 * 3.141592653589793 * along / 0.01;
        cosines += std::cos(angle);
        sines += std::sin(angle);
        first = std::max(first, along);
        last = std::min(last, along);
      }
    });
    EXPECT_GT(count, share * 500);
    EXPECT_LT(std::hypot(cosines, sines), 0.15 * count);
    EXPECT_NEAR(first, 0.2, 0.0051); // the first layer's middle entered after 5 mm
    EXPECT_GT(last, -0.0051);
  }
}

/* Pressed against a floor 3 cm below, the stream keeps its flow, and what enters keeps its distance to what is there by position correction alone. */
TEST(Emitter, ABlockedNozzleKeepsItsFlowAndTheStepIsFinite) {
  EmptyWorld empty(4000);
  loam_collider_def floor;
  ASSERT_EQ(loam_collider_def_default(&floor, sizeof floor), LOAM_OK);
  floor.position[1] = 0.97f;
  loam_collider_id plane = 0;
  ASSERT_EQ(loam_collider_create(empty.world.get(), &floor, &plane), LOAM_OK);
  const loam_emitter_id id = empty.add(disc(empty.material, 0.03f));
  for (int frame = 0; frame < 30; ++frame) empty.world.step(1.0f / 60);
  const loam_emitter_report report = empty.report(id);
  EXPECT_NEAR(double(report.entered) * report.volume, 0.5 * report.volume_flow, 0.03 * 0.5 * report.volume_flow);
  EXPECT_EQ(empty.world.statistics().non_finite, 0u);
}

TEST(Emitter, StartsStopsAndLetsGo) {
  EmptyWorld empty(4000);
  loam_emitter_def def = disc(empty.material, 0.03f);
  def.start = 0.05f;
  def.stop = 0.15f;
  def.velocity_jitter = 0.2f;
  const loam_emitter_id id = empty.add(def);
  for (int frame = 0; frame < 10; ++frame) empty.world.step(0.005f);
  EXPECT_LE(empty.report(id).entered, 29u); // the first layer at most
  for (int frame = 0; frame < 40; ++frame) empty.world.step(0.005f);
  const loam_emitter_report report = empty.report(id);
  EXPECT_EQ(report.stopped, 1u);
  EXPECT_EQ(report.entered, 10u * 29u); // layers of 29, 1 cm apart at 1 m/s for 0.1 s
  std::uint64_t pinned = 0;
  double least = 1e9, most = -1e9;
  empty.look([&](const loam_particle_view &view) {
    for (std::uint64_t i = 0; i < view.count; ++i) {
      pinned += view.velocities[4 * i + 3] == 0;
      least = std::min(least, double(view.velocities[4 * i]));
      most = std::max(most, double(view.velocities[4 * i]));
    }
  });
  EXPECT_EQ(pinned, 0u);
  EXPECT_LT(least, -0.02);
  EXPECT_GT(most, 0.02);
}

TEST(Emitter, AFullWorldDropsCountsAndGoesOn) {
  EmptyWorld empty(300);
  loam_emitter_def quiet = disc(empty.material, 0.03f);
  quiet.when_full = LOAM_FULL_DROP;
  const loam_emitter_id id = empty.add(quiet);
  std::uint64_t dropped = 0;
  for (int frame = 0; frame < 12; ++frame) {
    empty.world.step(1.0f / 60);
    dropped += empty.world.statistics().particles_dropped;
  }
  const loam_emitter_report report = empty.report(id);
  EXPECT_EQ(report.entered, 300u);
  EXPECT_EQ(report.dropped, dropped);
  EXPECT_GT(dropped, 200u);
  const loam_statistics statistics = empty.world.statistics();
  EXPECT_EQ(statistics.particles, 300u);
  EXPECT_EQ(statistics.capacity_needed, 300 + dropped);
  EXPECT_EQ(statistics.non_finite, 0u);
  std::map<std::uint32_t, int> ids;
  empty.look([&](const loam_particle_view &view) {
    for (std::uint64_t i = 0; i < view.count; ++i) ++ids[view.ids[i]];
  });
  EXPECT_EQ(ids.size(), 300u); // nothing was overwritten
  // With the capacity that it asked for, nothing is dropped.
  EmptyWorld larger(statistics.capacity_needed);
  (void)larger.add(disc(larger.material, 0.03f));
  for (int frame = 0; frame < 12; ++frame) larger.world.step(1.0f / 60);
  EXPECT_EQ(larger.world.statistics().capacity_needed, 0u);
  EXPECT_EQ(larger.world.statistics().particles, statistics.capacity_needed);
}

TEST(Emitter, AFullWorldIsToldWithTheNumberAndTheCapacity) {
  EmptyWorld empty(300), twin(300);
  (void)empty.add(disc(empty.material, 0.03f));
  loam_emitter_def quiet = disc(twin.material, 0.03f);
  quiet.when_full = LOAM_FULL_DROP;
  (void)twin.add(quiet);
  int told = 0;
  for (int frame = 0; frame < 10; ++frame) {
    const loam_status status = loam_world_step(empty.world.get(), 1.0f / 60);
    const std::string text = loam_last_error();
    twin.world.step(1.0f / 60);
    const loam_statistics statistics = empty.world.statistics();
    EXPECT_EQ(statistics.substeps_done, 4u);
    EXPECT_STREQ(loam_status_name(status), statistics.particles_dropped > 0 ? "LOAM_ERROR_CAPACITY" : "LOAM_OK");
    if (status == LOAM_OK) continue;
    ++told;
    EXPECT_EQ(text.find(std::to_string(statistics.particles_dropped) + " particles"), 0u) << text;
    EXPECT_NE(text.find("is 300 and would have to be " + std::to_string(statistics.capacity_needed)), std::string::npos)
        << text;
  }
  EXPECT_GT(told, 2);
  EXPECT_EQ(empty.world.state_hash(), twin.world.state_hash()); // the steps were done
}

TEST(Emitter, AMeshIsFilledAsItIsSeenAlongTheFlow) {
  EmptyWorld empty(20000);
  const meshes::Mesh box = meshes::box(0.05f, 0.03f, 0.02f), ball = meshes::icosphere(0.05f, 3);
  loam_emitter_def def = disc(empty.material, 0);
  def.nozzle = LOAM_NOZZLE_MESH;
  def.mesh = box.view();
  def.flow = 1e-4f; // a part of it
  EXPECT_NEAR(empty.report(empty.add(def)).volume_flow, 1e-4, 1e-9);
  def.flow = 0;
  EXPECT_NEAR(empty.report(empty.add(def)).volume_flow, 0.10 * 0.04, 0.02 * 0.10 * 0.04);
  def.mesh = ball.view();
  EXPECT_NEAR(empty.report(empty.add(def)).volume_flow, 3.14159 * 0.0025, 0.02 * 3.14159 * 0.0025);
  for (int frame = 0; frame < 3; ++frame) empty.world.step(1.0f / 60);
  EXPECT_GT(empty.world.statistics().particles, 100u);
}

/* Threads, and a world that has had a stream and lost it, and hash and stages without emitters. */
TEST(Emitter, TheSameBitsForAnyNumberOfThreadsAndNoTraceWithout) {
  for (const std::uint32_t solver : {LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI}) {
    const auto run = [&](std::uint32_t threads) {
      EmptyWorld empty(2000, threads, solver);
      loam_emitter_def def = disc(empty.material, 0.03f);
      def.velocity_jitter = 0.1f;
      def.flow = 0.001f;
      (void)empty.add(def);
      for (int frame = 0; frame < 12; ++frame) {
        empty.world.step(1.0f / 60);
        if (frame == 6) { // and the host takes some away
          const std::uint32_t ids[3] = {5, 11, 2};
          EXPECT_EQ(loam_particles_remove(empty.world.get(), ids, 3), LOAM_OK);
        }
      }
      EXPECT_GT(empty.world.statistics().particles, 100u);
      return empty.world.state_hash();
    };
    const std::uint64_t alone = run(1);
    EXPECT_EQ(run(1), alone);
    EXPECT_EQ(run(3), alone);
  }
  EmptyWorld empty(100);
  const std::uint64_t hash = empty.world.state_hash(), memory = empty.world.memory_bytes();
  const loam_emitter_id id = empty.add(disc(empty.material, 0.03f));
  ASSERT_EQ(loam_emitter_destroy(empty.world.get(), id), LOAM_OK);
  EXPECT_EQ(empty.world.state_hash(), hash);
  EXPECT_EQ(empty.world.memory_bytes(), memory);
  empty.world.step(1.0f / 60);
  for (const loam_stage &stage : empty.world.stages()) EXPECT_STRNE(stage.name, "emitters");
  EXPECT_EQ(loam_material_destroy(empty.world.get(), empty.material), LOAM_OK);
}

class EmitterInput : public SmallWorld {
protected:
  void refuses(loam_status status, const loam_emitter_def &def, const std::vector<std::string> &parts) {
    loam_emitter_id id = 12345;
    refused(status, parts, [&] { return loam_emitter_create(world(), &def, &id); });
    EXPECT_EQ(id, 12345u);
  }
  void refuses(const loam_emitter_def &def, const std::vector<std::string> &parts) {
    refuses(LOAM_ERROR_INVALID_ARGUMENT, def, parts);
  }
};

TEST_F(EmitterInput, EveryFieldHasItsRange) {
  const loam_emitter_def good = disc(material_, 0.02f);
  const auto each = [&](const char *field, auto member, std::initializer_list<float> values) {
    for (const float value : values) {
      loam_emitter_def def = good;
      member(def) = value;
      refuses(def, {field});
    }
  };
  each("position[1]", [](auto &d) -> float & { return d.position[1]; }, {nan, infinity, 1e30f});
  each("direction[2]", [](auto &d) -> float & { return d.direction[2]; }, {nan, -infinity, 1e30f});
  each("direction", [](auto &d) -> float & { return d.direction[1]; }, {0, -1e-8f});
  each("radius", [](auto &d) -> float & { return d.radius; }, {nan, 0, -1, 1e-9f, 1e30f});
  each("speed", [](auto &d) -> float & { return d.speed; }, {nan, 0, -1, 1e5f});
  each("flow", [](auto &d) -> float & { return d.flow; }, {nan, -1, infinity, 1});
  each("mass_flow", [](auto &d) -> float & { return d.mass_flow; }, {nan, -1, infinity, 1e6f});
  each("spacing", [](auto &d) -> float & { return d.spacing; }, {nan, -1, 1e-9f, 1e9f});
  each("jitter", [](auto &d) -> float & { return d.jitter; }, {nan, -0.1f, 0.6f});
  each("velocity_jitter", [](auto &d) -> float & { return d.velocity_jitter; }, {nan, -0.1f, infinity});
  each("start", [](auto &d) -> float & { return d.start; }, {nan, -0.1f, infinity});
  each("stop", [](auto &d) -> float & { return d.stop; }, {nan, -0.1f, infinity});
  loam_emitter_def def = good;
  def.start = 2;
  def.stop = 1;
  refuses(def, {"stop is 1", "start"});
  def = good;
  def.flow = def.mass_flow = 1e-4f;
  refuses(def, {"flow", "mass_flow"});
  def = good;
  def.nozzle = 2;
  refuses(def, {"nozzle is 2"});
  def = good;
  def.when_full = 2;
  refuses(def, {"when_full is 2"});
  def = good;
  def.radius = 1;
  refuses(LOAM_ERROR_CAPACITY, def, {"particle_capacity is 100"});
  def = good;
  def.nozzle = LOAM_NOZZLE_MESH;
  refuses(def, {"mesh"});
  for (const std::uint32_t size : wrong_sizes(sizeof def)) {
    def = good;
    def.struct_size = size;
    refuses(def, {"struct_size", std::to_string(size)});
  }
}

TEST_F(EmitterInput, HandlesAndPointers) {
  loam_emitter_def def = disc(material_, 0.02f);
  loam_emitter_id id = 0;
  invalid({"world is null"}, [&] { return loam_emitter_create(nullptr, &def, &id); });
  invalid({"def is null"}, [&] { return loam_emitter_create(world(), nullptr, &id); });
  invalid({"emitter is null"}, [&] { return loam_emitter_create(world(), &def, nullptr); });
  invalid({"def is null"}, [&] { return loam_emitter_def_default(nullptr, sizeof def); });
  for (const loam_material_id bad : {loam_material_id(0), loam_material_id(collider_), material_ + 5}) {
    def.material = bad;
    refuses(LOAM_ERROR_INVALID_HANDLE, def, {"material"});
  }
  def.material = material_;
  ASSERT_EQ(loam_emitter_create(world(), &def, &id), LOAM_OK) << loam_last_error();
  EXPECT_EQ(loam_material_destroy(world(), material_), LOAM_ERROR_IN_USE);
  loam_emitter_report report = {};
  invalid({"report"}, [&] { return loam_emitter_get_report(world(), id, &report); });
  invalid({"report is null"}, [&] { return loam_emitter_get_report(world(), id, nullptr); });
  loam_particle_view view = {};
  view.struct_size = sizeof view;
  ASSERT_EQ(loam_particles_map(world(), &view), LOAM_OK);
  EXPECT_EQ(loam_emitter_destroy(world(), id), LOAM_ERROR_IN_USE);
  EXPECT_EQ(loam_emitter_create(world(), &def, &id), LOAM_ERROR_IN_USE);
  ASSERT_EQ(loam_particles_unmap(world()), LOAM_OK);
  ASSERT_EQ(loam_emitter_destroy(world(), id), LOAM_OK);
  refused(LOAM_ERROR_INVALID_HANDLE, {"stale"}, [&] { return loam_emitter_destroy(world(), id); });
  report.struct_size = sizeof report;
  refused(LOAM_ERROR_INVALID_HANDLE, {"stale"}, [&] { return loam_emitter_get_report(world(), id, &report); });
  invalid({"world is null"}, [&] { return loam_emitter_destroy(nullptr, id); });
}

} // namespace
} // namespace loam
