/* Cloth through the interface: what is refused, and that a refusal changes nothing. */
#include "small_world.h"

#include "support/cloths.h"

namespace loam::test {
namespace {

using cloths::Grid;

class ClothAbi : public SmallWorld {
protected:
  ClothAbi() : grid_(4, 4, 0.02f), def_(cloths::definition(grid_)) {
    def_.position[1] = 1;
    EXPECT_EQ(loam_cloth_create(world(), &def_, &cloth_), LOAM_OK);
    EXPECT_EQ(loam_cloth_attachment_def_default(&attachment_, sizeof attachment_), LOAM_OK);
    attachment_.vertices = &vertex_;
    attachment_.count = 1;
  }
  loam_status create(const loam_cloth_def &def) {
    loam_cloth_id id = 0;
    return loam_cloth_create(world(), &def, &id);
  }
  loam_status attach() { return loam_cloth_attach(world(), cloth_, &attachment_); }
  void invalid_mesh(const std::vector<std::string> &parts) {
    refused(LOAM_ERROR_INVALID_MESH, parts, [&] {
      def_.mesh = grid_.view();
      return create(def_);
    });
  }

  Grid grid_;
  loam_cloth_def def_;
  loam_cloth_id cloth_ = 0;
  loam_cloth_attachment_def attachment_;
  std::uint32_t vertex_ = 3;
};

TEST_F(ClothAbi, DefinitionsNameTheFieldThatIsWrong) {
  invalid({"world", "null"}, [&] { return loam_cloth_create(nullptr, &def_, &cloth_); });
  invalid({"def", "null"}, [&] { return loam_cloth_create(world(), nullptr, &cloth_); });
  invalid({"cloth", "null"}, [&] { return loam_cloth_create(world(), &def_, nullptr); });
  for (const std::uint32_t size : wrong_sizes(sizeof def_)) {
    loam_cloth_def def = def_;
    def.struct_size = size;
    invalid({"struct_size", std::to_string(size)}, [&] { return create(def); });
  }
  struct Case {
    const char *name;
    float loam_cloth_def::*field;
    std::vector<float> bad;
  };
  const Case cases[] = {{"areal_density", &loam_cloth_def::areal_density, {0, -1, 2e4f, nan, infinity}},
                        {"stretch_stiffness", &loam_cloth_def::stretch_stiffness, {0, -1, 2e9f, nan, infinity}},
                        {"shear_stiffness", &loam_cloth_def::shear_stiffness, {-1, 2e9f, nan, infinity}},
                        {"bending_stiffness", &loam_cloth_def::bending_stiffness, {-1, 2e6f, nan, infinity}},
                        {"damping", &loam_cloth_def::damping, {-1, 11, nan, infinity}},
                        {"greatest_stretch", &loam_cloth_def::greatest_stretch, {-1, 11, nan, infinity}},
                        {"particle_friction", &loam_cloth_def::particle_friction, {-1, 101, nan, infinity}},
                        {"self_distance", &loam_cloth_def::self_distance, {-1, 1e-7f, 1e4f, nan, infinity}},
                        {"self_friction", &loam_cloth_def::self_friction, {-1, 101, nan, infinity}},
                        {"tear_strain", &loam_cloth_def::tear_strain, {-1, 1e-5f, 101, nan, infinity}},
                        {"thickness", &loam_cloth_def::thickness, {-1, 1e-7f, 1e4f, nan, infinity}}};
  for (const Case &c : cases)
    for (const float value : c.bad) {
      loam_cloth_def def = def_;
      def.*c.field = value;
      invalid({c.name}, [&] { return create(def); });
    }
  loam_cloth_def def = def_;
  def.warp[0] = 0;
  invalid({"warp", "(0, 0, 0)"}, [&] { return create(def); });
  def = def_;
  def.position[2] = nan;
  invalid({"position", "nan"}, [&] { return create(def); });
  def = def_;
  for (float &q : def.rotation) q = 0;
  invalid({"rotation"}, [&] { return create(def); });
  def = def_;
  def.velocity[1] = infinity;
  invalid({"velocity[1]", "inf"}, [&] { return create(def); });
  def = def_;
  def.reserved = 1;
  invalid({"reserved"}, [&] { return create(def); });
  def = def_;
  def.reserved_2 = 1;
  invalid({"reserved_2"}, [&] { return create(def); });
}

TEST_F(ClothAbi, MeshesNameThePlaceThatIsWrong) {
  loam_cloth_def def = def_;
  def.mesh.positions = nullptr;
  invalid({"mesh.positions", "null"}, [&] { return create(def); });
  def = def_;
  def.mesh.indices = nullptr;
  invalid({"mesh.indices", "null"}, [&] { return create(def); });
  def = def_;
  def.mesh.triangle_count = 0;
  invalid({"triangle_count", "0"}, [&] { return create(def); });
  const Grid good = grid_;
  grid_.positions[10] = nan;
  invalid({"vertex 3", "nan"}, [&] { return create(def_); });
  grid_ = good;
  grid_.indices[5] = 25;
  def_.mesh = grid_.view();
  invalid({"triangle 1", "25"}, [&] { return create(def_); });

  grid_ = good;
  grid_.positions.insert(grid_.positions.end(), {1.0f, 1.0f, 1.0f});
  invalid_mesh({"vertex 25", "no triangle"});
  grid_ = good;
  for (int k = 0; k < 3; ++k) grid_.positions[3 * 7 + k] = grid_.positions[3 * 6 + k];
  invalid_mesh({"vertices 6 and 7", "one place"});
  grid_ = good;
  grid_.indices[1] = grid_.indices[0];
  invalid_mesh({"triangle 0", "no area"});
  grid_ = good;
  grid_.positions.insert(grid_.positions.end(), {0.0f, 0.5f, 0.0f});
  grid_.indices.insert(grid_.indices.end(), {grid_.indices[0], grid_.indices[1], 25u});
  invalid_mesh({"edge", "3 triangles"});
  grid_ = good;
  std::swap(grid_.indices[0], grid_.indices[1]);
  invalid_mesh({"triangles", "orientation"});
}

TEST_F(ClothAbi, AttachmentsNameWhatDoesNotExist) {
  vertex_ = 25;
  invalid({"vertices[0]", "25"}, [&] { return attach(); });
  vertex_ = 3;
  attachment_.collider = cloth_;
  refused(LOAM_ERROR_INVALID_HANDLE, {"collider"}, [&] { return attach(); });
  attachment_.collider = 0;
  for (const float compliance : {-1.0f, 1e-12f, 1e12f, nan, infinity}) {
    attachment_.compliance = compliance;
    invalid({"compliance"}, [&] { return attach(); });
  }
  attachment_.compliance = 0;
  attachment_.vertices = nullptr;
  invalid({"vertices", "null"}, [&] { return attach(); });
  attachment_.vertices = &vertex_;
  for (const std::uint32_t count : {0u, 26u}) {
    attachment_.count = count;
    invalid({"count"}, [&] { return attach(); });
  }
  attachment_.count = 1;
  const float points[] = {0, nan, 0};
  attachment_.points = points;
  invalid({"points[0].y", "nan"}, [&] { return attach(); });
  attachment_.points = nullptr;
  invalid({"vertices[0]", "3", "not attached"}, [&] { return loam_cloth_release(world(), cloth_, &vertex_, 1); });
  ASSERT_EQ(attach(), LOAM_OK);
  refused(LOAM_ERROR_IN_USE, {"vertices[0]", "3", "attached"}, [&] { return attach(); });
  EXPECT_EQ(loam_cloth_release(world(), cloth_, &vertex_, 1), LOAM_OK);
}

TEST_F(ClothAbi, ACollidersAttachmentsHoldIt) {
  attachment_.collider = collider_;
  ASSERT_EQ(attach(), LOAM_OK);
  refused(LOAM_ERROR_IN_USE, {"vertex 3"}, [&] { return loam_collider_destroy(world(), collider_); });
  ASSERT_EQ(loam_cloth_release(world(), cloth_, &vertex_, 1), LOAM_OK);
  EXPECT_EQ(loam_collider_destroy(world(), collider_), LOAM_OK);
}

TEST_F(ClothAbi, AttachedVerticesGoWithTheirCollider) {
  attachment_.collider = collider_;
  ASSERT_EQ(attach(), LOAM_OK);
  const cloths::Cloth::Vertices before = [&] {
    loam_cloth_view view = {};
    view.struct_size = sizeof view;
    EXPECT_EQ(loam_cloth_map(world(), cloth_, &view), LOAM_OK);
    cloths::Cloth::Vertices vertices;
    vertices.positions.assign(view.positions + 12, view.positions + 15);
    EXPECT_EQ(view.vertex_count, 25u);
    EXPECT_EQ(view.triangle_count, 32u);
    EXPECT_EQ(std::vector<std::uint32_t>(view.indices, view.indices + 96), grid_.indices);
    EXPECT_EQ(loam_cloth_unmap(world(), cloth_), LOAM_OK);
    return vertices;
  }();
  const float position[] = {0.02f, 0, 0}, rotation[] = {0, 0, 0, 1};
  ASSERT_EQ(loam_collider_move(world(), collider_, position, rotation), LOAM_OK);
  world_.step(1.0f / 60);
  loam_cloth_view view = {};
  view.struct_size = sizeof view;
  ASSERT_EQ(loam_cloth_map(world(), cloth_, &view), LOAM_OK);
  EXPECT_NEAR(view.positions[12], before.positions[0] + 0.02f, 1e-6f);
  EXPECT_NEAR(view.positions[13], before.positions[1], 1e-6f);
  EXPECT_EQ(view.velocities[15], 0.0f);
  EXPECT_EQ(loam_cloth_unmap(world(), cloth_), LOAM_OK);
}

TEST_F(ClothAbi, WindIsChecked) {
  const float bad[] = {0, nan, 0}, good[] = {1, 0, 0};
  invalid({"velocity"}, [&] { return loam_cloth_set_wind(world(), cloth_, nullptr, 1, 1); });
  invalid({"velocity[1]", "nan"}, [&] { return loam_cloth_set_wind(world(), cloth_, bad, 1, 1); });
  invalid({"drag", "-1"}, [&] { return loam_cloth_set_wind(world(), cloth_, good, -1, 1); });
  invalid({"lift", "nan"}, [&] { return loam_cloth_set_wind(world(), cloth_, good, 1, nan); });
  EXPECT_EQ(loam_cloth_set_wind(world(), cloth_, good, 1, 1), LOAM_OK);
}

TEST_F(ClothAbi, MappedClothIsNotChanged) {
  loam_cloth_view view = {};
  invalid({"size"}, [&] { return loam_cloth_map(world(), cloth_, &view); });
  invalid({"view", "null"}, [&] { return loam_cloth_map(world(), cloth_, nullptr); });
  invalid({"not mapped"}, [&] { return loam_cloth_unmap(world(), cloth_); });
  view.struct_size = sizeof view;
  ASSERT_EQ(loam_cloth_map(world(), cloth_, &view), LOAM_OK);
  refused(LOAM_ERROR_IN_USE, {"mapped"}, [&] { return loam_cloth_map(world(), cloth_, &view); });
  refused(LOAM_ERROR_IN_USE, {"mapped"}, [&] { return loam_world_step(world(), 0.01f); });
  refused(LOAM_ERROR_IN_USE, {"mapped"}, [&] { return attach(); });
  refused(LOAM_ERROR_IN_USE, {"mapped"}, [&] { return loam_cloth_destroy(world(), cloth_); });
  EXPECT_EQ(loam_cloth_unmap(world(), cloth_), LOAM_OK);
}

TEST_F(ClothAbi, StaleIdsAreRecognised) {
  const std::uint64_t memory = world_.memory_bytes();
  loam_cloth_id other = 0;
  ASSERT_EQ(loam_cloth_create(world(), &def_, &other), LOAM_OK);
  EXPECT_GT(world_.memory_bytes(), memory);
  ASSERT_EQ(loam_cloth_destroy(world(), other), LOAM_OK);
  EXPECT_EQ(world_.memory_bytes(), memory);
  const float wind[] = {0, 0, 0};
  for (const loam_cloth_id id : {other, loam_cloth_id(0), loam_cloth_id(collider_)}) {
    refused(LOAM_ERROR_INVALID_HANDLE, {"cloth"}, [&] { return loam_cloth_destroy(world(), id); });
    refused(LOAM_ERROR_INVALID_HANDLE, {"cloth"}, [&] { return loam_cloth_attach(world(), id, &attachment_); });
    refused(LOAM_ERROR_INVALID_HANDLE, {"cloth"}, [&] { return loam_cloth_release(world(), id, &vertex_, 1); });
    refused(LOAM_ERROR_INVALID_HANDLE, {"cloth"}, [&] { return loam_cloth_set_wind(world(), id, wind, 0, 0); });
    refused(LOAM_ERROR_INVALID_HANDLE, {"cloth"}, [&] { return loam_cloth_unmap(world(), id); });
  }
}

/* Only what collides with itself pays for it. */
TEST_F(ClothAbi, SelfContactIsThereWhileACollidingClothIs) {
  const auto has_stage = [&] {
    for (const loam_stage &stage : world_.stages())
      if (std::string(stage.name) == "cloth self contact") return true;
    return false;
  };
  world_.step(1e-3f);
  EXPECT_FALSE(has_stage());
  const std::uint64_t memory = world_.memory_bytes();
  def_.self_distance = 0.01f;
  loam_cloth_id other = 0;
  ASSERT_EQ(loam_cloth_create(world(), &def_, &other), LOAM_OK);
  world_.step(1e-3f);
  EXPECT_TRUE(has_stage());
  EXPECT_GT(world_.memory_bytes(), memory);
  ASSERT_EQ(loam_cloth_destroy(world(), other), LOAM_OK);
  world_.step(1e-3f);
  EXPECT_FALSE(has_stage());
  EXPECT_EQ(world_.memory_bytes(), memory);
}

/* Stages and memory are there while a cloth is. */
TEST_F(ClothAbi, AWorldWithoutClothHasNoneOfItsStages) {
  const auto cloth_stages = [&] {
    std::size_t count = 0;
    for (const loam_stage &stage : world_.stages())
      count += std::string(stage.name).find("cloth") != std::string::npos ? 1 : 0;
    return count;
  };
  world_.step(1e-3f);
  EXPECT_EQ(cloth_stages(), 6u);
  ASSERT_EQ(loam_cloth_destroy(world(), cloth_), LOAM_OK);
  world_.step(1e-3f);
  EXPECT_EQ(cloth_stages(), 0u);
}

} // namespace
} // namespace loam::test
