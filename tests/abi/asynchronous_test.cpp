/* Asynchronous steps: the same result as synchronous ones, a kept frame that stays as it was, and for every function of the interface what it says
 * meanwhile. */
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <regex>
#include <set>

#include "small_world.h"
#include "support/hooks.h"
#include "support/snapshots.h"

namespace loam {
namespace {

using test::SmallWorld;

std::uint64_t hash_in_the_background(std::uint32_t threads, const loam_job_system &jobs) {
  return test::hash_after_steps(jobs, threads, [](scenes::World &world, float seconds) {
    EXPECT_EQ(loam_world_step_async(world.get(), seconds), LOAM_OK);
    EXPECT_EQ(loam_world_wait(world.get()), LOAM_OK);
  });
}

TEST(AsynchronousStep, HasTheResultOfAStep) {
  const std::uint64_t expected = test::hash_after_steps({}, 1);
  EXPECT_EQ(hash_in_the_background(1, {}), expected);
  EXPECT_EQ(hash_in_the_background(3, {}), expected);
  hooks::ThreadJobs threads;
  EXPECT_EQ(hash_in_the_background(3, threads.hooks()), expected);
  EXPECT_GT(threads.enqueued, 0u);
  EXPECT_EQ(threads.enqueued, threads.finished);
}

loam_particle_view empty_view() {
  loam_particle_view view = {};
  view.struct_size = sizeof view;
  return view;
}

/* All that a view shows. */
std::vector<float> all_of(const loam_particle_view &view) {
  std::vector<float> values(view.positions, view.positions + 4 * view.count);
  values.insert(values.end(), view.velocities, view.velocities + 4 * view.count);
  values.insert(values.end(), view.strains, view.strains + 6 * view.count);
  values.insert(values.end(), view.densities, view.densities + view.count);
  for (std::uint64_t i = 0; i < view.count; ++i) {
    values.push_back(float(view.ids[i]));
    values.push_back(float(view.materials[i]));
  }
  return values;
}

std::uint64_t kept_bytes(const loam_world *world) {
  loam_memory rows[32];
  std::uint32_t count = 0;
  scenes::require(loam_world_get_memory(world, rows, 32, &count), "loam_world_get_memory");
  for (std::uint32_t i = 0; i < std::min(count, 32u); ++i)
    if (std::string(rows[i].effect) == "kept frame") return rows[i].bytes;
  return 0;
}

TEST_F(SmallWorld, AKeptFrameStaysReadableDuringTheStep) {
  loam_particle_view mapped = empty_view(), kept = empty_view();
  ASSERT_EQ(loam_particles_map(world(), &mapped), LOAM_OK);
  ASSERT_EQ(loam_particles_keep(world(), &kept), LOAM_OK);
  const std::vector<float> expected = all_of(mapped);
  ASSERT_EQ(loam_particles_unmap(world()), LOAM_OK);
  EXPECT_EQ(all_of(kept), expected);
  EXPECT_NE(kept.positions, mapped.positions);
  EXPECT_EQ(kept_bytes(world()), 100u * (2 * 16 + 24 + 4 * 4));
  for (int k = 0; k < 5; ++k) {
    ASSERT_EQ(loam_world_step_async(world(), 0.01f), LOAM_OK);
    EXPECT_EQ(all_of(kept), expected); /* read while the step writes */
    ASSERT_EQ(loam_world_wait(world()), LOAM_OK);
  }
  EXPECT_EQ(all_of(kept), expected);
  ASSERT_EQ(loam_particles_map(world(), &mapped), LOAM_OK);
  EXPECT_NE(all_of(mapped), expected); /* it has moved on */
  ASSERT_EQ(loam_particles_unmap(world()), LOAM_OK);
  ASSERT_EQ(loam_particles_drop(world()), LOAM_OK);
  EXPECT_EQ(kept_bytes(world()), 0u);
}

TEST_F(SmallWorld, OnlyAskingForAFrameTakesMemoryForIt) {
  hooks::Allocator allocator;
  loam_world_def def = definition(scene_);
  def.allocator = allocator.hooks();
  scenes::World other(def, scene_);
  other.step(1e-3f);
  const std::uint64_t requests = allocator.requests, bytes = allocator.bytes_in_use;
  loam_particle_view view = empty_view();
  ASSERT_EQ(loam_particles_keep(other.get(), &view), LOAM_OK);
  const std::uint64_t with_frame = allocator.requests;
  EXPECT_GT(with_frame, requests);
  for (int k = 0; k < 3; ++k) {
    ASSERT_EQ(loam_particles_keep(other.get(), &view), LOAM_OK);
    other.step(1e-3f);
  }
  EXPECT_EQ(allocator.requests, with_frame);
  ASSERT_EQ(loam_particles_drop(other.get()), LOAM_OK);
  EXPECT_EQ(allocator.bytes_in_use, bytes);
}

TEST_F(SmallWorld, AnAsynchronousStepIsRefusedAsAStepIs) {
  for (const float seconds : {0.0f, -1.0f, 2.0f, test::nan, test::infinity})
    invalid({"seconds"}, [&] { return loam_world_step_async(world(), seconds); });
  invalid({"world", "null"}, [&] { return loam_world_step_async(nullptr, 0.01f); });
  invalid({"world", "null"}, [&] { return loam_world_wait(nullptr); });
  invalid({"no step"}, [&] { return loam_world_wait(world()); });
  std::uint32_t running = 0;
  invalid({"world", "null"}, [&] { return loam_world_is_stepping(nullptr, &running); });
  invalid({"running", "null"}, [&] { return loam_world_is_stepping(world(), nullptr); });
  loam_particle_view view = empty_view(), wrong = empty_view();
  invalid({"view", "null"}, [&] { return loam_particles_keep(world(), nullptr); });
  invalid({"world", "null"}, [&] { return loam_particles_keep(nullptr, &view); });
  for (const std::uint32_t size : wrong_sizes(sizeof view)) {
    wrong.struct_size = size;
    invalid({"view", "is " + std::to_string(size)}, [&] { return loam_particles_keep(world(), &wrong); });
  }
  invalid({"world", "null"}, [&] { return loam_particles_drop(nullptr); });
  invalid({"no frame"}, [&] { return loam_particles_drop(world()); });
  ASSERT_EQ(loam_particles_map(world(), &view), LOAM_OK);
  refused(LOAM_ERROR_IN_USE, {"map"}, [&] { return loam_world_step_async(world(), 0.01f); });
  ASSERT_EQ(loam_particles_unmap(world()), LOAM_OK);
}

TEST_F(SmallWorld, AShiftOfTheOriginIsRefusedForWhatIsNoPlace) {
  const float zero[3] = {0, 0, 0};
  invalid({"world", "null"}, [&] { return loam_world_shift_origin(nullptr, zero); });
  invalid({"offset", "null"}, [&] { return loam_world_shift_origin(world(), nullptr); });
  for (const float bad : {test::nan, test::infinity, -test::infinity, 1e30f})
    for (int axis = 0; axis < 3; ++axis) {
      float offset[3] = {0, 0, 0};
      offset[axis] = bad;
      invalid({"offset[" + std::to_string(axis) + "]"}, [&] { return loam_world_shift_origin(world(), offset); });
    }
  loam_particle_view view = empty_view();
  ASSERT_EQ(loam_particles_map(world(), &view), LOAM_OK);
  refused(LOAM_ERROR_IN_USE, {"map"}, [&] { return loam_world_shift_origin(world(), zero); });
  ASSERT_EQ(loam_particles_unmap(world()), LOAM_OK);
  const std::uint64_t before = world_.state_hash();
  EXPECT_EQ(loam_world_shift_origin(world(), zero), LOAM_OK);
  EXPECT_EQ(world_.state_hash(), before);
}

TEST(AsynchronousStep, FailsWhenItIsWaitedFor) {
  const scenes::Scene scene = scenes::jittered_block(scenes::sand(), 200);
  loam_world_def def = scenes::world_def(scene);
  hooks::Log log;
  def.pair_capacity = 10;
  def.log = log.hooks();
  scenes::World world(def, scene);
  scenes::World twin(def, scene);
  EXPECT_EQ(loam_world_step(twin.get(), 0.01f), LOAM_ERROR_CAPACITY);
  log.lines.clear();
  ASSERT_EQ(loam_world_step_async(world.get(), 0.01f), LOAM_OK);
  EXPECT_EQ(loam_world_wait(world.get()), LOAM_ERROR_CAPACITY);
  test::expect_error_names({"pair_capacity"});
  ASSERT_EQ(log.lines.size(), 1u);
  EXPECT_EQ(world.state_hash(), twin.state_hash());
  EXPECT_EQ(loam_world_wait(world.get()), LOAM_ERROR_INVALID_ARGUMENT); /* it has been */
}

TEST_F(SmallWorld, AWorldMayBeDestroyedDuringAStep) {
  scenes::World other(definition(scene_), scene_);
  ASSERT_EQ(loam_world_step_async(other.get(), 0.1f), LOAM_OK);
}

/* What every function with a world says during an asynchronous step. The headers are read, so that none is forgotten. */
TEST_F(SmallWorld, EveryFunctionSaysWhetherItMayBeCalledDuringAStep) {
  const std::set<std::string> allowed = {"loam_world_wait", "loam_world_is_stepping", "loam_world_get_backend",
                                         "loam_world_destroy"};
  loam_world *w = world();
  const snapshots::Bytes saved = snapshots::save(w);
  snapshots::Bytes room(saved.size());
  std::uint64_t number = 0;
  std::uint32_t count = 0;
  loam_statistics statistics = {};
  loam_accuracy_def accuracy = {};
  statistics.struct_size = sizeof statistics;
  loam_particle_view view = empty_view();
  loam_cloth_view cloth_view = {};
  cloth_view.struct_size = sizeof cloth_view;
  loam_collider_report report = {};
  report.struct_size = sizeof report;
  const float vector[4] = {0, 0, 0, 1};
  loam_fill_def fill;
  loam_particles_def add;
  loam_collider_def collider;
  loam_cloth_def cloth;
  loam_cloth_attachment_def attachment;
  ASSERT_EQ(loam_fill_def_default(&fill, sizeof fill), LOAM_OK);
  ASSERT_EQ(loam_particles_def_default(&add, sizeof add), LOAM_OK);
  ASSERT_EQ(loam_collider_def_default(&collider, sizeof collider), LOAM_OK);
  ASSERT_EQ(loam_cloth_def_default(&cloth, sizeof cloth), LOAM_OK);
  ASSERT_EQ(loam_cloth_attachment_def_default(&attachment, sizeof attachment), LOAM_OK);
  loam_emitter_def emitter;
  ASSERT_EQ(loam_emitter_def_default(&emitter, sizeof emitter), LOAM_OK);
  loam_field_def field;
  loam_killer_def killer;
  ASSERT_EQ(loam_field_def_default(&field, sizeof field), LOAM_OK);
  ASSERT_EQ(loam_killer_def_default(&killer, sizeof killer), LOAM_OK);
  loam_emitter_report emitter_report = {};
  emitter_report.struct_size = sizeof emitter_report;
  loam_material_def material = scene_.material;
  std::uint64_t id = 0;
  const std::map<std::string, std::function<loam_status()>> calls = {
      {"loam_world_step", [&] { return loam_world_step(w, 0.01f); }},
      {"loam_world_step_async", [&] { return loam_world_step_async(w, 0.01f); }},
      {"loam_world_set_gravity", [&] { return loam_world_set_gravity(w, vector); }},
      {"loam_world_set_accuracy", [&] { return loam_world_set_accuracy(w, 1, 1); }},
      {"loam_world_use_accuracy", [&] { return loam_world_use_accuracy(w, &accuracy); }},
      {"loam_world_get_accuracy", [&] { return loam_world_get_accuracy(w, &accuracy, sizeof accuracy); }},
      {"loam_world_wake", [&] { return loam_world_wake(w); }},
      {"loam_world_state_hash", [&] { return loam_world_state_hash(w, &number); }},
      {"loam_world_get_statistics", [&] { return loam_world_get_statistics(w, &statistics); }},
      {"loam_world_get_stages", [&] { return loam_world_get_stages(w, nullptr, 0, &count); }},
      {"loam_world_get_memory", [&] { return loam_world_get_memory(w, nullptr, 0, &count); }},
      {"loam_material_create", [&] { return loam_material_create(w, &material, &id); }},
      {"loam_material_destroy", [&] { return loam_material_destroy(w, material_); }},
      {"loam_material_set", [&] { return loam_material_set(w, material_, &material); }},
      {"loam_material_get", [&] { return loam_material_get(w, material_, &material); }},
      {"loam_material_set_meeting", [&] { return loam_material_set_meeting(w, material_, material_, 0, 0); }},
      {"loam_collider_create", [&] { return loam_collider_create(w, &collider, &id); }},
      {"loam_collider_destroy", [&] { return loam_collider_destroy(w, collider_); }},
      {"loam_collider_move", [&] { return loam_collider_move(w, collider_, vector, vector); }},
      {"loam_collider_place", [&] { return loam_collider_place(w, collider_, vector, vector); }},
      {"loam_collider_move_vertices", [&] { return loam_collider_move_vertices(w, collider_, vector, 1); }},
      {"loam_collider_place_vertices", [&] { return loam_collider_place_vertices(w, collider_, vector, 1); }},
      {"loam_collider_get_report", [&] { return loam_collider_get_report(w, collider_, &report); }},
      {"loam_collider_get_reaction", [&] { return loam_collider_get_reaction(w, collider_, nullptr); }},
      {"loam_collider_set_contact", [&] { return loam_collider_set_contact(w, collider_, 0, nullptr); }},
      {"loam_collider_get_contact", [&] { return loam_collider_get_contact(w, collider_, 0, nullptr); }},
      {"loam_cloth_create", [&] { return loam_cloth_create(w, &cloth, &id); }},
      {"loam_cloth_destroy", [&] { return loam_cloth_destroy(w, 1); }},
      {"loam_cloth_attach", [&] { return loam_cloth_attach(w, 1, &attachment); }},
      {"loam_cloth_release", [&] { return loam_cloth_release(w, 1, &count, 1); }},
      {"loam_cloth_set_wind", [&] { return loam_cloth_set_wind(w, 1, vector, 0, 0); }},
      {"loam_cloth_map", [&] { return loam_cloth_map(w, 1, &cloth_view); }},
      {"loam_cloth_unmap", [&] { return loam_cloth_unmap(w, 1); }},
      {"loam_emitter_create", [&] { return loam_emitter_create(w, &emitter, &id); }},
      {"loam_emitter_destroy", [&] { return loam_emitter_destroy(w, 1); }},
      {"loam_emitter_get_report", [&] { return loam_emitter_get_report(w, 1, &emitter_report); }},
      {"loam_field_create", [&] { return loam_field_create(w, &field, &id); }},
      {"loam_field_set", [&] { return loam_field_set(w, 1, &field); }},
      {"loam_field_destroy", [&] { return loam_field_destroy(w, 1); }},
      {"loam_killer_create", [&] { return loam_killer_create(w, &killer, &id); }},
      {"loam_killer_set", [&] { return loam_killer_set(w, 1, &killer); }},
      {"loam_killer_destroy", [&] { return loam_killer_destroy(w, 1); }},
      {"loam_killer_get_killed", [&] { return loam_killer_get_killed(w, 1, nullptr, nullptr, 0, &number); }},
      {"loam_particles_fill", [&] { return loam_particles_fill(w, &fill, nullptr); }},
      {"loam_particles_add", [&] { return loam_particles_add(w, &add, nullptr); }},
      {"loam_particles_remove", [&] { return loam_particles_remove(w, &count, 1); }},
      {"loam_particles_move", [&] { return loam_particles_move(w, &count, 1, vector, nullptr); }},
      {"loam_world_shift_origin", [&] { return loam_world_shift_origin(w, vector); }},
      {"loam_particles_count", [&] { return loam_particles_count(w, &number); }},
      {"loam_particles_map", [&] { return loam_particles_map(w, &view); }},
      {"loam_particles_unmap", [&] { return loam_particles_unmap(w); }},
      {"loam_particles_keep", [&] { return loam_particles_keep(w, &view); }},
      {"loam_particles_drop", [&] { return loam_particles_drop(w); }},
      {"loam_snapshot_size", [&] { return loam_snapshot_size(w, &number); }},
      {"loam_snapshot_save", [&] { return loam_snapshot_save(w, room.data(), room.size(), nullptr); }},
      {"loam_snapshot_restore", [&] { return loam_snapshot_restore(w, saved.data(), saved.size()); }},
  };

  std::set<std::string> declared;
  for (const auto &file : std::filesystem::directory_iterator(LOAM_SOURCE_DIR "/include/loam")) {
    std::ifstream stream(file.path());
    const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    const std::regex function(R"((loam_\w+)\((const )?loam_world \*)");
    for (std::sregex_iterator at(text.begin(), text.end(), function), end; at != end; ++at) declared.insert((*at)[1]);
  }
  EXPECT_GE(declared.size(), 38u);
  for (const std::string &name : declared) EXPECT_TRUE(calls.count(name) + allowed.count(name) == 1) << name;

  const std::uint64_t before = world_.state_hash();
  scenes::World twin(definition(scene_), scene_);
  ASSERT_EQ(loam_world_step_async(w, 0.01f), LOAM_OK);
  for (const auto &[name, call] : calls) {
    EXPECT_STREQ(loam_status_name(call()), "LOAM_ERROR_BUSY") << name;
    EXPECT_NE(std::string(loam_last_error()).find("loam_world_wait"), std::string::npos) << name;
  }
  std::uint32_t backend = 0, running = 2;
  EXPECT_EQ(loam_world_get_backend(w, &backend, nullptr), LOAM_OK);
  EXPECT_EQ(loam_world_is_stepping(w, &running), LOAM_OK);
  EXPECT_LE(running, 1u);
  ASSERT_EQ(loam_world_wait(w), LOAM_OK);
  EXPECT_EQ(loam_world_is_stepping(w, &running), LOAM_OK);
  EXPECT_EQ(running, 0u);
  /* Only the step has changed anything. */
  const std::uint64_t after = world_.state_hash();
  EXPECT_NE(after, before);
  snapshots::restore(w, saved);
  world_.step(0.01f);
  EXPECT_EQ(world_.state_hash(), after);
}

} // namespace
} // namespace loam
