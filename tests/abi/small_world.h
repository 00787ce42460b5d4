/* A small scene that every refusal is tried on, and the check that a refused call changed nothing. */
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <vector>

#include "support/meshes.h"
#include "support/scenes.h"

namespace loam::test {

inline constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();

/* Expects that the calling thread's last error names all of `parts`. */
inline void expect_error_names(const std::vector<std::string> &parts) {
  for (const std::string &part : parts)
    EXPECT_NE(std::string(loam_last_error()).find(part), std::string::npos)
        << "\"" << loam_last_error() << "\" names no " << part;
}

/* The hash of a block that collapses, after three steps that `step` makes. */
template <class Step> std::uint64_t hash_after_steps(const loam_job_system &jobs, std::uint32_t threads, Step &&step) {
  const scenes::Scene scene = scenes::jittered_block(scenes::sand(), 1500);
  loam_world_def def = scenes::world_def(scene);
  def.thread_count = threads;
  def.job_system = jobs;
  def.substeps = 4;
  scenes::World world(def, scene);
  for (int k = 0; k < 3; ++k) step(world, 0.004f);
  return world.state_hash();
}
inline std::uint64_t hash_after_steps(const loam_job_system &jobs, std::uint32_t threads) {
  return hash_after_steps(jobs, threads, [](scenes::World &world, float seconds) { world.step(seconds); });
}

class SmallWorld : public testing::Test {
protected:
  SmallWorld() : scene_(scenes::jittered_block(scenes::sand(), 64)), world_(definition(scene_), scene_) {
    EXPECT_EQ(loam_material_create(world(), &scene_.material, &material_), LOAM_OK);
    loam_collider_def def;
    EXPECT_EQ(loam_collider_def_default(&def, sizeof def), LOAM_OK);
    const meshes::Mesh box = meshes::box(0.5f, 0.5f, 0.5f);
    def.kind = LOAM_COLLIDER_MESH;
    def.mesh = box.view();
    EXPECT_EQ(loam_collider_create(world(), &def, &collider_), LOAM_OK);
    world_.step(1e-3f);
  }
  static loam_world_def definition(const scenes::Scene &scene) {
    loam_world_def def = scenes::world_def(scene);
    def.substeps = 2;
    def.particle_capacity = 100;
    return def;
  }

  loam_world *world() const { return world_.get(); }

  /* What a host can see of a world. */
  struct Sight {
    std::uint64_t hash, particles, memory;
    bool operator==(const Sight &) const = default;
  };
  Sight sight() const { return {world_.state_hash(), world_.statistics().particles, world_.memory_bytes()}; }

  /* Expects that `call` is refused with `status`, that the text names `parts`, and that nothing changed. */
  template <class Call> void refused(loam_status status, const std::vector<std::string> &parts, Call &&call) {
    const Sight before = sight();
    const loam_status answer = call();
    const std::string text = loam_last_error();
    EXPECT_STREQ(loam_status_name(answer), loam_status_name(status)) << text;
    expect_error_names(parts);
    EXPECT_TRUE(sight() == before) << text;
  }
  template <class Call> void invalid(const std::vector<std::string> &parts, Call &&call) {
    refused(LOAM_ERROR_INVALID_ARGUMENT, parts, call);
  }

  /* struct_size as no version ever had it: nothing, too little, too much, garbage. */
  static std::vector<std::uint32_t> wrong_sizes(std::size_t size) {
    return {0, 1, std::uint32_t(size) - 2, std::uint32_t(size) + 4, 0xffffffffu};
  }

  scenes::Scene scene_;
  scenes::World world_;
  loam_material_id material_ = 0; // of no particle
  loam_collider_id collider_ = 0;
};

} // namespace loam::test
