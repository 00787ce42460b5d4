/* field.h and killer.h: who is killed, what is free again, and every field of the definitions. */
#include <algorithm>

#include "small_world.h"
#include "support/snapshots.h"
#include "support/streams.h"

namespace loam {
namespace {

using test::infinity;
using test::nan;
using test::SmallWorld;

loam_killer_def killer(std::uint32_t kind) {
  loam_killer_def def;
  scenes::require(loam_killer_def_default(&def, sizeof def), "loam_killer_def_default");
  def.kind = kind;
  return def;
}

struct Killed {
  std::uint64_t total = 0;
  std::vector<std::uint32_t> ids; // of the last step
};

Killed killed(const loam_world *world, loam_killer_id id) {
  Killed result;
  std::uint64_t count = 0;
  scenes::require(loam_killer_get_killed(world, id, &result.total, nullptr, 0, &count), "loam_killer_get_killed");
  result.ids.resize(count);
  scenes::require(loam_killer_get_killed(world, id, nullptr, result.ids.data(), count, &count), "loam_killer_get_killed");
  return result;
}

/* Particles 5 cm apart along x, the i-th at 5 cm i, that fly along y. */
struct Flight {
  explicit Flight(int count, std::uint32_t threads = 1)
      : world([&] {
          loam_world_def def = scenes::world_def(make(1));
          def.gravity[1] = 0;
          def.substeps = 16;
          def.particle_capacity = std::uint64_t(count);
          def.thread_count = threads;
          return def;
        }()) {
    material = world.add(make(count));
  }
  static scenes::Scene make(int count) {
    scenes::Scene scene;
    scene.material = scenes::sand();
    scene.spacing = 0.01f;
    for (int i = 0; i < count; ++i) {
      scene.positions.insert(scene.positions.end(), {0.05f * float(i), 0, 0});
      scene.velocities.insert(scene.velocities.end(), {0, 1, 0});
    }
    return scene;
  }
  loam_killer_id add(const loam_killer_def &def) const {
    loam_killer_id id = 0;
    scenes::require(loam_killer_create(world.get(), &def, &id), "loam_killer_create");
    return id;
  }
  std::vector<std::uint32_t> ids() const {
    std::vector<std::uint32_t> list;
    loam_particle_view view = {};
    view.struct_size = sizeof view;
    scenes::require(loam_particles_map(world.get(), &view), "map");
    list.assign(view.ids, view.ids + view.count);
    scenes::require(loam_particles_unmap(world.get()), "unmap");
    std::sort(list.begin(), list.end());
    return list;
  }
  scenes::World world;
  loam_material_id material = 0;
};

TEST(Killer, TakesWhatIsInItsVolumeAndTheirIdsDoNotComeBack) {
  for (const std::uint32_t threads : {1u, 3u}) {
    Flight row(10, threads);
    loam_killer_def ball = killer(LOAM_KILLER_SPHERE), box = killer(LOAM_KILLER_BOX);
    ball.position[0] = 0.2f;
    ball.position[1] = 0.1f;
    ball.radius = 0.06f; // 3, 4 and 5 when they have flown 10 cm
    box.position[0] = 0.5f;
    box.position[1] = 0.1f;
    box.half_extents[0] = box.half_extents[2] = 0.12f;
    box.half_extents[1] = 0.02f;
    box.rotation[1] = 1; // half a turn about y
    box.rotation[3] = 0; // 8 and 9
    const loam_killer_id first = row.add(ball), second = row.add(box);
    for (int step = 0; step < 3; ++step) row.world.step(0.01f);
    EXPECT_EQ(row.world.statistics().particles, 10u);
    row.world.step(0.06f);
    EXPECT_EQ(row.world.statistics().particles_killed, 5u);
    EXPECT_EQ(row.ids(), (std::vector<std::uint32_t>{0, 1, 2, 6, 7}));
    EXPECT_EQ(killed(row.world.get(), first).ids, (std::vector<std::uint32_t>{3, 4, 5}));
    EXPECT_EQ(killed(row.world.get(), second).ids, (std::vector<std::uint32_t>{8, 9}));
    std::uint32_t one = 99;
    std::uint64_t count = 0;
    ASSERT_EQ(loam_killer_get_killed(row.world.get(), first, nullptr, &one, 1, &count), LOAM_OK);
    EXPECT_EQ(one, 3u);
    EXPECT_EQ(count, 3u);
    row.world.step(0.01f);
    EXPECT_EQ(killed(row.world.get(), first).total, 3u);
    EXPECT_TRUE(killed(row.world.get(), first).ids.empty());
    EXPECT_EQ(row.world.statistics().particles_killed, 0u);
    // Their room is free, their ids are not.
    loam_particles_def def;
    scenes::require(loam_particles_def_default(&def, sizeof def), "default");
    const float positions[15] = {1, 0, 0, 1.1f, 0, 0, 1.2f, 0, 0, 1.3f, 0, 0, 1.4f, 0, 0};
    def.material = row.material;
    def.positions = positions;
    def.count = 5;
    std::uint32_t id = 0;
    ASSERT_EQ(loam_particles_add(row.world.get(), &def, &id), LOAM_OK) << loam_last_error();
    EXPECT_EQ(id, 10u);
    const std::uint32_t gone = 4;
    EXPECT_EQ(loam_particles_remove(row.world.get(), &gone, 1), LOAM_ERROR_INVALID_HANDLE);
  }
}

TEST(Killer, OutsideByMaterialAndSetAnew) {
  Flight row(10);
  const loam_material_def other = scenes::sand();
  loam_material_id material = 0;
  ASSERT_EQ(loam_material_create(row.world.get(), &other, &material), LOAM_OK);
  loam_killer_def ball = killer(LOAM_KILLER_SPHERE);
  ball.radius = 0.22f;
  ball.outside = 1;
  ball.material = material; // of which there is none
  const loam_killer_id id = row.add(ball);
  row.world.step(0.01f);
  EXPECT_EQ(row.world.statistics().particles, 10u);
  EXPECT_EQ(loam_material_destroy(row.world.get(), material), LOAM_ERROR_IN_USE);
  ball.material = 0;
  ASSERT_EQ(loam_killer_set(row.world.get(), id, &ball), LOAM_OK);
  EXPECT_EQ(loam_material_destroy(row.world.get(), material), LOAM_OK);
  row.world.step(0.01f);
  EXPECT_EQ(row.ids(), (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  ball.outside = 0;
  ASSERT_EQ(loam_killer_set(row.world.get(), id, &ball), LOAM_OK);
  row.world.step(0.01f);
  EXPECT_EQ(row.world.statistics().particles, 0u);
  EXPECT_EQ(killed(row.world.get(), id).total, 10u);
  EXPECT_EQ(loam_material_destroy(row.world.get(), row.material), LOAM_OK); // nothing of it is left
}

/* Ages begin at the entry, or with the first killer that asks; a stream that dies of age has as many particles as its flow times the age. A layer a step
 * comes in; its age is a step at its end, and ten at the end of the step that takes it. */
TEST(Killer, OfAge) {
  streams::EmptyWorld empty(400);
  const std::uint64_t memory = empty.world.memory_bytes();
  loam_killer_def age = killer(LOAM_KILLER_AGE);
  age.age = 0.095f;
  loam_killer_id id = 0;
  ASSERT_EQ(loam_killer_create(empty.world.get(), &age, &id), LOAM_OK);
  EXPECT_EQ(empty.world.memory_bytes(), memory + 2 * 4 * 400);
  const float gravity[3] = {};
  ASSERT_EQ(loam_world_set_gravity(empty.world.get(), gravity), LOAM_OK);
  const loam_emitter_id nozzle = empty.add(streams::disc(empty.material, 0.03f)); // 29 a layer, 100 layers a second
  for (int frame = 0; frame < 100; ++frame) empty.world.step(0.01f);
  const loam_emitter_report report = empty.report(nozzle);
  EXPECT_EQ(report.entered, 2900u);
  EXPECT_EQ(report.dropped, 0u);
  EXPECT_EQ(empty.world.statistics().particles, 9u * 29u);
  EXPECT_EQ(killed(empty.world.get(), id).total + empty.world.statistics().particles, report.entered);
  ASSERT_EQ(loam_killer_destroy(empty.world.get(), id), LOAM_OK);
  empty.world.step(1.0f / 60);
  for (const loam_stage &stage : empty.world.stages()) EXPECT_STRNE(stage.name, "killers");
  EXPECT_EQ(empty.world.statistics().particles_killed, 0u);
}

/* All at once: bits for any number of threads, and from a snapshot. */
TEST(FieldsAndKillers, TheSameBitsForAnyNumberOfThreadsAndFromASnapshot) {
  struct Scene : streams::EmptyWorld {
    explicit Scene(std::uint32_t threads) : EmptyWorld(1500, threads) {
      (void)add(streams::disc(material, 0.03f));
      loam_field_def def;
      loam_field_id id = 0;
      for (const std::uint32_t kind : {LOAM_FIELD_WIND, LOAM_FIELD_ATTRACTOR, LOAM_FIELD_BLAST}) {
        scenes::require(loam_field_def_default(&def, sizeof def), "default");
        def.kind = kind;
        def.velocity[0] = 1;
        def.strength = 0.1f;
        def.softening = 0.1f;
        def.speed = 2;
        def.position[1] = 0.9f;
        def.radius = 0.2f;
        def.time = 0.15f;
        scenes::require(loam_field_create(world.get(), &def, &id), "field");
      }
      loam_killer_def age = killer(LOAM_KILLER_AGE), ball = killer(LOAM_KILLER_SPHERE);
      age.age = 0.13f;
      ball.radius = 0.8f;
      scenes::require(loam_killer_create(world.get(), &age, &of_age), "killer");
      scenes::require(loam_killer_create(world.get(), &ball, &id), "killer");
    }
    void run(int frames) {
      for (int frame = 0; frame < frames; ++frame) world.step(1.0f / 60);
    }
    loam_killer_id of_age = 0;
  };
  Scene one(1), three(3);
  one.run(8);
  const snapshots::Bytes saved = snapshots::save(one.world.get());
  const std::uint64_t then = one.world.state_hash();
  one.run(8);
  const std::uint64_t expected = one.world.state_hash();
  const Killed in_one = killed(one.world.get(), one.of_age);
  EXPECT_GT(in_one.total, 100u);
  EXPECT_EQ(one.world.statistics().non_finite, 0u);
  three.run(16);
  EXPECT_EQ(three.world.state_hash(), expected);
  EXPECT_EQ(killed(three.world.get(), three.of_age).ids, in_one.ids);
  snapshots::restore(three.world.get(), saved);
  EXPECT_EQ(three.world.state_hash(), then);
  EXPECT_EQ(snapshots::save(three.world.get()), saved);
  three.run(8);
  EXPECT_EQ(three.world.state_hash(), expected);
  EXPECT_EQ(killed(three.world.get(), three.of_age).total, in_one.total);
  Scene other(1);
  loam_field_id more = 0;
  loam_field_def def;
  scenes::require(loam_field_def_default(&def, sizeof def), "default");
  scenes::require(loam_field_create(other.world.get(), &def, &more), "field");
  EXPECT_EQ(loam_snapshot_restore(other.world.get(), saved.data(), saved.size()), LOAM_ERROR_SNAPSHOT_MISMATCH);
  test::expect_error_names({"number of fields"});
}

TEST(FieldsAndKillers, MoveWithTheOrigin) {
  const float far[3] = {1024, 0, -2048};
  const auto run = [&](const float at[3]) {
    Flight row(10);
    scenes::Scene scene = Flight::make(10);
    std::vector<std::uint32_t> ids;
    std::vector<float> positions;
    for (std::uint32_t i = 0; i < 10; ++i) {
      ids.push_back(i);
      for (std::size_t k = 0; k < 3; ++k) positions.push_back(scene.positions[3 * i + k] * 1.25f + at[k]); // exact there
    }
    for (float &x : positions) x = std::round(x * 1024) / 1024;
    scenes::require(loam_particles_move(row.world.get(), ids.data(), 10, positions.data(), nullptr), "move");
    loam_killer_def ball = killer(LOAM_KILLER_SPHERE);
    loam_field_def mass;
    scenes::require(loam_field_def_default(&mass, sizeof mass), "default");
    mass.kind = LOAM_FIELD_ATTRACTOR;
    mass.strength = 0.01f;
    mass.softening = 0.1f;
    for (int k = 0; k < 3; ++k) mass.position[k] = ball.position[k] = at[k];
    ball.radius = 0.1f;
    loam_field_id id = 0;
    (void)row.add(ball);
    scenes::require(loam_field_create(row.world.get(), &mass, &id), "field");
    scenes::require(loam_world_shift_origin(row.world.get(), at), "shift");
    for (int step = 0; step < 5; ++step) row.world.step(0.01f);
    EXPECT_EQ(row.world.statistics().particles, 8u);
    return row.world.state_hash();
  };
  const float here[3] = {};
  EXPECT_EQ(run(here), run(far));
}

class FieldAndKillerInput : public SmallWorld {
protected:
  void refuses(const loam_field_def &def, const std::vector<std::string> &parts) {
    loam_field_id id = 12345;
    invalid(parts, [&] { return loam_field_create(world(), &def, &id); });
    EXPECT_EQ(id, 12345u);
    loam_field_id field = 0;
    const loam_field_def good = default_field();
    ASSERT_EQ(loam_field_create(world(), &good, &field), LOAM_OK);
    invalid(parts, [&] { return loam_field_set(world(), field, &def); });
    ASSERT_EQ(loam_field_destroy(world(), field), LOAM_OK);
  }
  void refuses(const loam_killer_def &def, const std::vector<std::string> &parts) {
    loam_killer_id id = 12345;
    invalid(parts, [&] { return loam_killer_create(world(), &def, &id); });
    EXPECT_EQ(id, 12345u);
    loam_killer_def good = killer(LOAM_KILLER_SPHERE);
    good.radius = 1e-3f;
    loam_killer_id own = 0;
    ASSERT_EQ(loam_killer_create(world(), &good, &own), LOAM_OK);
    invalid(parts, [&] { return loam_killer_set(world(), own, &def); });
    ASSERT_EQ(loam_killer_destroy(world(), own), LOAM_OK);
  }
  static loam_field_def default_field() {
    loam_field_def def;
    EXPECT_EQ(loam_field_def_default(&def, sizeof def), LOAM_OK);
    return def;
  }
  template <class Def, class Member>
  void each(const Def &good, const char *field, Member member, std::initializer_list<float> values) {
    for (const float value : values) {
      Def def = good;
      member(def) = value;
      refuses(def, {field});
    }
  }
};

TEST_F(FieldAndKillerInput, EveryFieldHasItsRange) {
  loam_field_def wind = default_field(), mass = wind, blast = wind;
  mass.kind = LOAM_FIELD_ATTRACTOR;
  mass.softening = 0.1f;
  blast.kind = LOAM_FIELD_BLAST;
  blast.radius = 1;
  each(wind, "position[1]", [](auto &d) -> float & { return d.position[1]; }, {nan, infinity, 1e30f});
  each(wind, "velocity[2]", [](auto &d) -> float & { return d.velocity[2]; }, {nan, -infinity, 1e30f});
  each(wind, "rate", [](auto &d) -> float & { return d.rate; }, {nan, 0, -1, 1e7f});
  each(wind, "radius", [](auto &d) -> float & { return d.radius; }, {nan, -1, 1e30f});
  each(mass, "strength", [](auto &d) -> float & { return d.strength; }, {nan, infinity, -1e13f});
  each(mass, "softening", [](auto &d) -> float & { return d.softening; }, {nan, 0, -1, 1e-9f, 1e30f});
  each(blast, "speed", [](auto &d) -> float & { return d.speed; }, {nan, infinity, 1e7f});
  each(blast, "radius", [](auto &d) -> float & { return d.radius; }, {nan, 0, -1, infinity});
  each(blast, "time", [](auto &d) -> float & { return d.time; }, {nan, -1, infinity, 1e7f});
  wind.kind = 3;
  refuses(wind, {"kind is 3"});
  wind.kind = 0;
  for (const std::uint32_t size : wrong_sizes(sizeof wind)) {
    wind.struct_size = size;
    refuses(wind, {"struct_size", std::to_string(size)});
  }

  loam_killer_def box = killer(LOAM_KILLER_BOX), ball = killer(LOAM_KILLER_SPHERE), age = killer(LOAM_KILLER_AGE);
  std::fill(box.half_extents, box.half_extents + 3, 1.0f);
  ball.radius = age.age = 1;
  each(box, "position[0]", [](auto &d) -> float & { return d.position[0]; }, {nan, infinity, 1e30f});
  each(box, "rotation", [](auto &d) -> float & { return d.rotation[3]; }, {nan, infinity, 0});
  each(box, "half_extents[1]", [](auto &d) -> float & { return d.half_extents[1]; }, {nan, 0, -1, infinity});
  each(ball, "radius", [](auto &d) -> float & { return d.radius; }, {nan, 0, -1, infinity});
  each(age, "age", [](auto &d) -> float & { return d.age; }, {nan, 0, -1, 1e7f});
  loam_killer_def def = box;
  def.kind = 3;
  refuses(def, {"kind is 3"});
  def = box;
  def.outside = 2;
  refuses(def, {"outside is 2"});
  def = box;
  def.reserved = 1;
  refuses(def, {"reserved is 1"});
  for (const std::uint32_t size : wrong_sizes(sizeof def)) {
    def = box;
    def.struct_size = size;
    refuses(def, {"struct_size", std::to_string(size)});
  }
}

TEST_F(FieldAndKillerInput, HandlesAndPointers) {
  loam_field_def field = default_field();
  loam_killer_def ball = killer(LOAM_KILLER_SPHERE);
  ball.radius = 1e-3f;
  loam_field_id field_id = 0;
  loam_killer_id killer_id = 0;
  std::uint64_t count = 0;
  invalid({"world is null"}, [&] { return loam_field_create(nullptr, &field, &field_id); });
  invalid({"def is null"}, [&] { return loam_field_create(world(), nullptr, &field_id); });
  invalid({"field is null"}, [&] { return loam_field_create(world(), &field, nullptr); });
  invalid({"def is null"}, [&] { return loam_field_def_default(nullptr, sizeof field); });
  invalid({"world is null"}, [&] { return loam_killer_create(nullptr, &ball, &killer_id); });
  invalid({"def is null"}, [&] { return loam_killer_create(world(), nullptr, &killer_id); });
  invalid({"killer is null"}, [&] { return loam_killer_create(world(), &ball, nullptr); });
  invalid({"def is null"}, [&] { return loam_killer_def_default(nullptr, sizeof ball); });
  ASSERT_EQ(loam_field_create(world(), &field, &field_id), LOAM_OK);
  ASSERT_EQ(loam_killer_create(world(), &ball, &killer_id), LOAM_OK);
  invalid({"def is null"}, [&] { return loam_field_set(world(), field_id, nullptr); });
  invalid({"world is null"}, [&] { return loam_field_set(nullptr, field_id, &field); });
  invalid({"def is null"}, [&] { return loam_killer_set(world(), killer_id, nullptr); });
  invalid({"world is null"}, [&] { return loam_killer_set(nullptr, killer_id, &ball); });
  invalid({"count is null"}, [&] { return loam_killer_get_killed(world(), killer_id, nullptr, nullptr, 0, nullptr); });
  invalid({"ids is null"}, [&] { return loam_killer_get_killed(world(), killer_id, nullptr, nullptr, 1, &count); });
  for (const std::uint64_t bad : {std::uint64_t(0), std::uint64_t(collider_), field_id + 5, killer_id + 5}) {
    refused(LOAM_ERROR_INVALID_HANDLE, {"field"}, [&] { return loam_field_set(world(), bad, &field); });
    refused(LOAM_ERROR_INVALID_HANDLE, {"field"}, [&] { return loam_field_destroy(world(), bad); });
    refused(LOAM_ERROR_INVALID_HANDLE, {"killer"}, [&] { return loam_killer_set(world(), bad, &ball); });
    refused(LOAM_ERROR_INVALID_HANDLE, {"killer"}, [&] { return loam_killer_destroy(world(), bad); });
    refused(LOAM_ERROR_INVALID_HANDLE, {"killer"},
            [&] { return loam_killer_get_killed(world(), bad, nullptr, nullptr, 0, &count); });
  }
  ball.material = collider_;
  refused(LOAM_ERROR_INVALID_HANDLE, {"material"}, [&] { return loam_killer_set(world(), killer_id, &ball); });
  refused(LOAM_ERROR_INVALID_HANDLE, {"material"}, [&] { return loam_killer_create(world(), &ball, &killer_id); });
  ball.material = 0;
  loam_particle_view view = {};
  view.struct_size = sizeof view;
  ASSERT_EQ(loam_particles_map(world(), &view), LOAM_OK);
  EXPECT_EQ(loam_killer_create(world(), &ball, &killer_id), LOAM_ERROR_IN_USE);
  EXPECT_EQ(loam_killer_set(world(), killer_id, &ball), LOAM_ERROR_IN_USE);
  EXPECT_EQ(loam_killer_destroy(world(), killer_id), LOAM_ERROR_IN_USE);
  ASSERT_EQ(loam_particles_unmap(world()), LOAM_OK);
  ASSERT_EQ(loam_field_destroy(world(), field_id), LOAM_OK);
  ASSERT_EQ(loam_killer_destroy(world(), killer_id), LOAM_OK);
  refused(LOAM_ERROR_INVALID_HANDLE, {"stale"}, [&] { return loam_field_destroy(world(), field_id); });
  refused(LOAM_ERROR_INVALID_HANDLE, {"stale"}, [&] { return loam_killer_destroy(world(), killer_id); });
}

} // namespace
} // namespace loam
