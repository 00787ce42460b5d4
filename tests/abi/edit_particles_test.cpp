/* particles.h: particles removed and moved in bulk, by their ids. */
#include "small_world.h"

namespace loam {
namespace {

using test::infinity;
using test::nan;
using test::SmallWorld;

class EditParticles : public SmallWorld {
protected:
  struct Particle {
    float position[3], velocity[3], strain[6];
    bool operator==(const Particle &) const = default;
  };
  std::vector<std::pair<std::uint32_t, Particle>> particles() const {
    loam_particle_view view = {};
    view.struct_size = sizeof view;
    EXPECT_EQ(loam_particles_map(world(), &view), LOAM_OK);
    std::vector<std::pair<std::uint32_t, Particle>> list;
    for (std::uint64_t i = 0; i < view.count; ++i) {
      Particle p;
      std::copy_n(view.positions + 4 * i, 3, p.position);
      std::copy_n(view.velocities + 4 * i, 3, p.velocity);
      std::copy_n(view.strains + 6 * i, 6, p.strain);
      list.push_back({view.ids[i], p});
    }
    EXPECT_EQ(loam_particles_unmap(world()), LOAM_OK);
    std::sort(list.begin(), list.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
    return list;
  }
  loam_status remove(const std::vector<std::uint32_t> &ids) {
    return loam_particles_remove(world(), ids.data(), ids.size());
  }
};

TEST_F(EditParticles, RemovedOnesAreGoneAndTheOthersAreAsTheyWere) {
  auto expected = particles();
  ASSERT_EQ(expected.size(), 64u);
  const std::vector<std::uint32_t> ids = {63, 0, 7, 21, 20, 62, 33};
  std::erase_if(expected, [&](const auto &p) { return std::count(ids.begin(), ids.end(), p.first) > 0; });
  ASSERT_EQ(remove(ids), LOAM_OK) << loam_last_error();
  EXPECT_EQ(particles(), expected);
  std::uint64_t count = 0;
  EXPECT_EQ(loam_particles_count(world(), &count), LOAM_OK);
  EXPECT_EQ(count, 57u);
  world_.step(1e-3f);
  EXPECT_EQ(world_.statistics().particles, 57u);

  // New particles take the room, and ids that no particle has had.
  loam_particles_def def;
  ASSERT_EQ(loam_particles_def_default(&def, sizeof def), LOAM_OK);
  const float place[3] = {0, 0.2f, 0};
  def.material = material_;
  def.count = 1;
  def.positions = place;
  std::uint32_t first = 0;
  ASSERT_EQ(loam_particles_add(world(), &def, &first), LOAM_OK);
  EXPECT_EQ(first, 64u);
  refused(LOAM_ERROR_INVALID_HANDLE, {"ids[0] is 63"}, [&] { return remove({63}); });
}

TEST_F(EditParticles, AWorldMayLoseAllParticlesAndGetOthers) {
  std::vector<std::uint32_t> ids;
  for (std::uint32_t id = 0; id < 64; ++id) ids.push_back(id);
  ASSERT_EQ(remove(ids), LOAM_OK);
  world_.step(1e-3f);
  EXPECT_EQ(world_.statistics().particles, 0u);
  EXPECT_EQ(world_.statistics().mean_speed, 0);
  // Their material is in use no more, and its stages are gone.
  for (const loam_stage &stage : world_.stages()) EXPECT_EQ(std::string(stage.name).find("solve"), std::string::npos);
  loam_fill_def fill;
  ASSERT_EQ(loam_fill_def_default(&fill, sizeof fill), LOAM_OK);
  fill.material = material_;
  fill.region.kind = LOAM_REGION_SPHERE;
  fill.region.radius = 0.015f;
  fill.region.center[1] = 0.3f;
  std::uint64_t made = 0;
  ASSERT_EQ(loam_particles_fill(world(), &fill, &made), LOAM_OK);
  world_.step(1e-3f);
  const auto list = particles();
  ASSERT_EQ(list.size(), made);
  EXPECT_EQ(list[0].first, 64u);
}

TEST_F(EditParticles, MovesAndPushesOnlyThoseThatAreNamed) {
  auto expected = particles();
  const std::uint32_t ids[2] = {40, 3};
  const float places[6] = {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f}, speeds[6] = {1, 2, 3, 4, 5, 6};
  ASSERT_EQ(loam_particles_move(world(), ids, 2, places, nullptr), LOAM_OK) << loam_last_error();
  ASSERT_EQ(loam_particles_move(world(), ids, 1, nullptr, speeds), LOAM_OK) << loam_last_error();
  std::copy_n(places, 3, expected[40].second.position);
  std::copy_n(places + 3, 3, expected[3].second.position);
  std::copy_n(speeds, 3, expected[40].second.velocity);
  EXPECT_EQ(particles(), expected);
}

TEST_F(EditParticles, BadInputChangesNothing) {
  const std::uint32_t good[2] = {1, 2}, twice[3] = {5, 1, 5}, unknown[2] = {1, 64};
  const float places[6] = {0, 0.1f, 0, 0, 0.2f, 0};
  std::vector<std::uint32_t> many(65, 0);
  invalid({"world is null"}, [&] { return loam_particles_remove(nullptr, good, 2); });
  invalid({"ids is null"}, [&] { return loam_particles_remove(world(), nullptr, 2); });
  invalid({"ids[2] is 5", "ids[0]"}, [&] { return loam_particles_remove(world(), twice, 3); });
  refused(LOAM_ERROR_INVALID_HANDLE, {"ids[1] is 64"}, [&] { return loam_particles_remove(world(), unknown, 2); });
  invalid({"count is 65", "64"}, [&] { return loam_particles_remove(world(), many.data(), 65); });
  invalid({"count is 1844"}, [&] { return loam_particles_remove(world(), good, ~0ull); });
  EXPECT_EQ(loam_particles_remove(world(), nullptr, 0), LOAM_OK);

  invalid({"world is null"}, [&] { return loam_particles_move(nullptr, good, 2, places, nullptr); });
  invalid({"ids is null"}, [&] { return loam_particles_move(world(), nullptr, 2, places, nullptr); });
  invalid({"positions and velocities are null"}, [&] { return loam_particles_move(world(), good, 2, nullptr, nullptr); });
  invalid({"ids[2] is 5"}, [&] { return loam_particles_move(world(), twice, 3, nullptr, std::vector<float>(9).data()); });
  refused(LOAM_ERROR_INVALID_HANDLE, {"ids[1] is 64"},
          [&] { return loam_particles_move(world(), unknown, 2, places, nullptr); });
  for (const float bad : {nan, infinity, 1e30f}) {
    float wrong[6] = {0, 0, 0, 0, bad, 0};
    invalid({"positions[1].y"}, [&] { return loam_particles_move(world(), good, 2, wrong, places); });
    invalid({"velocities[1].y"}, [&] { return loam_particles_move(world(), good, 2, places, wrong); });
  }
  loam_particle_view view = {};
  view.struct_size = sizeof view;
  ASSERT_EQ(loam_particles_map(world(), &view), LOAM_OK);
  EXPECT_EQ(loam_particles_remove(world(), good, 2), LOAM_ERROR_IN_USE);
  EXPECT_EQ(loam_particles_move(world(), good, 2, places, nullptr), LOAM_ERROR_IN_USE);
  ASSERT_EQ(loam_particles_unmap(world()), LOAM_OK);
}

} // namespace
} // namespace loam
