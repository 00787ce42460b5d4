/* The allocator hook: every block comes back, and a refusal anywhere leaves a world that goes on as if nothing had happened. */
#include <memory>

#include "small_world.h"
#include "support/cloths.h"
#include "support/hooks.h"

namespace loam {
namespace {

using hooks::Allocator;

/* Everything that takes memory, call by call. A call that is refused is made once more; in the end the world must be where it would have been. */
class Session {
public:
  Session(Allocator &allocator, std::uint32_t solver) : scene_(scenes::jittered_block(scenes::sand(), 120)) {
    def_ = scenes::world_def(scene_);
    def_.solver = solver;
    def_.warm_start = 1;
    def_.substeps = 2;
    def_.iterations = 2;
    def_.particle_capacity = 600;
    def_.allocator = allocator.hooks();
  }
  ~Session() { loam_world_destroy(world_); }

  void run() {
    const meshes::Mesh box = meshes::box(0.06f, 0.2f, 0.06f);
    attempt("create", [&] { return loam_world_create(&def_, &world_); });
    loam_collider_def collider;
    loam_collider_def_default(&collider, sizeof collider);
    collider.kind = LOAM_COLLIDER_MESH;
    collider.mesh = box.view();
    loam_collider_id collider_id = 0;
    attempt("collider", [&] { return loam_collider_create(world_, &collider, &collider_id); });
    const loam_material_def rubber = scenes::rubber(), sand = scenes::sand();
    loam_material_id soft = 0, loose = 0;
    attempt("material", [&] { return loam_material_create(world_, &rubber, &soft); });
    attempt("material with a history", [&] { return loam_material_create(world_, &sand, &loose); });
    loam_particles_def add;
    loam_particles_def_default(&add, sizeof add);
    add.material = loose;
    add.count = scene_.count();
    add.positions = scene_.positions.data();
    attempt("add", [&] { return loam_particles_add(world_, &add, nullptr); });
    loam_fill_def fill;
    loam_fill_def_default(&fill, sizeof fill);
    fill.material = soft;
    fill.region.kind = LOAM_REGION_BOX;
    fill.region.center[1] = 0.1f;
    for (float &half : fill.region.half_extents) half = 0.02f;
    attempt("fill", [&] { return loam_particles_fill(world_, &fill, nullptr); });
    const cloths::Grid grid(4, 4, 0.005f);
    loam_cloth_def sheet = cloths::definition(grid);
    sheet.position[1] = 0.075f; // among the particles
    sheet.self_distance = 0.006f;
    loam_cloth_id cloth = 0;
    attempt("cloth", [&] { return loam_cloth_create(world_, &sheet, &cloth); });
    for (int k = 0; k < 3; ++k) attempt("step", [&] { return loam_world_step(world_, 1e-3f); });
    // A wall that moves into the matter, and memory for a contact of its own in the same step; of one substep, for a step that is repeated after
    // some of its substeps goes farther.
    attempt("accuracy", [&] { return loam_world_set_accuracy(world_, 1, 2); });
    loam_collider_contact contact = {sizeof contact, 0.1f, 0, 0};
    attempt("contact", [&] { return loam_collider_set_contact(world_, collider_id, soft, &contact); });
    const float position[3] = {0.04f, 0, 0}, rotation[4] = {0, 0, 0, 1};
    attempt("move", [&] { return loam_collider_move(world_, collider_id, position, rotation); });
    attempt("step", [&] { return loam_world_step(world_, 1e-3f); });
    loam_particle_view view = {};
    view.struct_size = sizeof view;
    attempt("map", [&] { return loam_particles_map(world_, &view); });
    attempt("unmap", [&] { return loam_particles_unmap(world_); });
    attempt("step", [&] { return loam_world_step(world_, 1e-3f); });
    loam_accuracy_def accuracy;
    attempt("default", [&] { return loam_accuracy_def_default(&accuracy, sizeof accuracy); });
    accuracy.mode = LOAM_ACCURACY_TOLERANCE;
    accuracy.tolerance = 0.1f;
    accuracy.substeps = 1;
    attempt("tolerance", [&] { return loam_world_use_accuracy(world_, &accuracy); });
    attempt("step", [&] { return loam_world_step(world_, 1e-3f); });
  }
  std::uint64_t hash() const {
    std::uint64_t hash = 0;
    EXPECT_EQ(loam_world_state_hash(world_, &hash), LOAM_OK);
    return hash;
  }
  int refused_calls = 0;
  std::string refused_text;

private:
  template <class Call> void attempt(const char *what, Call &&call) {
    loam_status status = call();
    if (status != LOAM_OK) {
      ++refused_calls;
      refused_text = loam_last_error();
      EXPECT_STREQ(loam_status_name(status), "LOAM_ERROR_OUT_OF_MEMORY") << what << ": " << refused_text;
      status = call();
    }
    ASSERT_EQ(scenes::outcome(status), "LOAM_OK") << what;
  }
  scenes::Scene scene_;
  loam_world_def def_;
  loam_world *world_ = nullptr;
};

class AllocatorHook : public testing::TestWithParam<std::uint32_t> {};

TEST_P(AllocatorHook, EveryBlockIsGivenBackAsItWasTaken) {
  Allocator allocator;
  {
    Session session(allocator, GetParam());
    session.run();
    EXPECT_GT(allocator.requests, 30u);
    EXPECT_GT(allocator.bytes_in_use, 100000u);
  }
  EXPECT_EQ(allocator.blocks_in_use(), 0u);
  EXPECT_EQ(allocator.bytes_in_use, 0u);
  EXPECT_EQ(allocator.mistakes, std::vector<std::string>());
}

TEST_P(AllocatorHook, ARefusalAnywhereIsAnErrorAndChangesNothing) {
  Allocator untroubled;
  Session reference(untroubled, GetParam());
  reference.run();
  const std::uint64_t requests = untroubled.requests;
  for (std::uint64_t nth = 1; nth <= requests; ++nth) {
    Allocator allocator;
    allocator.refuse(nth);
    {
      Session session(allocator, GetParam());
      session.run();
      ASSERT_FALSE(HasFatalFailure()) << "request " << nth << " of " << requests;
      EXPECT_EQ(allocator.refusals, 1u);
      EXPECT_EQ(session.refused_calls, 1) << nth;
      EXPECT_NE(session.refused_text.find(std::to_string(allocator.bytes_refused)), std::string::npos)
          << session.refused_text;
      EXPECT_EQ(session.hash(), reference.hash()) << "request " << nth << " of " << requests;
    }
    EXPECT_EQ(allocator.blocks_in_use(), 0u);
    EXPECT_EQ(allocator.mistakes, std::vector<std::string>());
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, AllocatorHook, testing::Values(LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI));

TEST(AllocatorHook, AWorldThatCannotBeMadeLeavesNothingBehind) {
  loam_world_def def;
  ASSERT_EQ(loam_world_def_default(&def, sizeof def), LOAM_OK);
  def.backend = LOAM_BACKEND_CPU;
  def.particle_capacity = std::uint64_t(1) << 28; // would be tens of gigabytes
  for (std::uint64_t nth = 1; nth <= 3; ++nth) {
    Allocator allocator;
    allocator.refuse(1, true);
    def.allocator = allocator.hooks();
    loam_world *world = nullptr;
    EXPECT_EQ(loam_world_create(&def, &world), LOAM_ERROR_OUT_OF_MEMORY);
    EXPECT_EQ(world, nullptr);
    EXPECT_EQ(allocator.blocks_in_use(), 0u);
  }
}

/* Sleepers are pinned within a substep. One that needs more lists than it may have leaves them their masses. */
TEST(AllocatorHook, ASleeperKeepsItsMassWhenTheListsDoNotFit) {
  const scenes::Scene scene = scenes::resting_pile(scenes::sand(), 5);
  loam_world_def def = scenes::world_def(scene);
  def.particle_capacity += 500;
  def.sleep_speed = 1;
  def.sleep_delay = 0.01f;
  const auto fill = [](scenes::World &world, float x) {
    loam_material_def sand = scenes::sand();
    loam_material_id material = 0;
    scenes::require(loam_material_create(world.get(), &sand, &material), "loam_material_create");
    loam_fill_def block;
    scenes::require(loam_fill_def_default(&block, sizeof block), "loam_fill_def_default");
    block.material = material;
    block.region.kind = LOAM_REGION_BOX;
    block.region.center[0] = x;
    block.region.center[1] = 0.05f;
    for (float &half : block.region.half_extents) half = 0.025f;
    return loam_particles_fill(world.get(), &block, nullptr);
  };
  std::uint64_t pairs = 0;
  {
    scenes::World world(def, scene);
    world.step(0.05f);
    pairs = world.statistics().pairs_peak;
  }
  def.pair_capacity = pairs + 200; // not enough for the block too
  scenes::World world(def, scene);
  world.step(0.05f);
  ASSERT_EQ(world.statistics().sleeping, scene.count());
  ASSERT_EQ(fill(world, 2), LOAM_OK);
  EXPECT_EQ(loam_world_step(world.get(), 0.01f), LOAM_ERROR_CAPACITY);
  const scenes::Snapshot now = world.snapshot();
  for (std::size_t i = 0; i < now.count(); ++i) ASSERT_GT(now.inverse_masses[i], 0) << i;
}

/* A settled scene takes no memory: what it needs, it has. */
TEST(AllocatorHook, TheSteadyStateTakesNoMemory) {
  Allocator allocator;
  const scenes::Scene scene = scenes::resting_pile(scenes::sand(), 5);
  loam_world_def def = scenes::world_def(scene);
  def.allocator = allocator.hooks();
  scenes::World world(def, scene);
  for (int k = 0; k < 5; ++k) world.step(1.0f / 60);
  const std::uint64_t before = allocator.requests;
  for (int k = 0; k < 5; ++k) world.step(1.0f / 60);
  EXPECT_EQ(allocator.requests, before);
}

} // namespace
} // namespace loam
