/* collider.h: every field of the definition, meshes of every kind, poses, handles. */
#include "small_world.h"
#include "support/solids.h"

namespace loam {
namespace {

using test::infinity;
using test::nan;
using test::SmallWorld;

const float origin[3] = {0, 0, 0}, identity[4] = {0, 0, 0, 1};

class Colliders : public SmallWorld {
protected:
  static loam_collider_def plane() {
    loam_collider_def def;
    EXPECT_EQ(loam_collider_def_default(&def, sizeof def), LOAM_OK);
    return def;
  }
  static loam_collider_def of_mesh(const meshes::Mesh &mesh) {
    loam_collider_def def = plane();
    def.kind = LOAM_COLLIDER_MESH;
    def.mesh = mesh.view();
    return def;
  }
  void refuses(loam_status status, const loam_collider_def &def, const std::vector<std::string> &parts) {
    loam_collider_id id = 12345;
    refused(status, parts, [&] { return loam_collider_create(world(), &def, &id); });
    EXPECT_EQ(id, 12345u);
  }
  loam_collider_report report(loam_collider_id id) {
    loam_collider_report report = {};
    report.struct_size = sizeof report;
    EXPECT_EQ(scenes::outcome(loam_collider_get_report(world(), id, &report)), "LOAM_OK");
    return report;
  }
  loam_collider_report report_of(const meshes::Mesh &mesh) {
    const loam_collider_def def = of_mesh(mesh);
    loam_collider_id id = 0;
    EXPECT_EQ(scenes::outcome(loam_collider_create(world(), &def, &id)), "LOAM_OK");
    const loam_collider_report found = report(id);
    EXPECT_EQ(loam_collider_destroy(world(), id), LOAM_OK);
    return found;
  }
};

TEST_F(Colliders, NullArguments) {
  const loam_collider_def def = plane();
  loam_collider_id id = 0;
  loam_collider_report report = {};
  invalid({"world is null"}, [&] { return loam_collider_create(nullptr, &def, &id); });
  invalid({"def is null"}, [&] { return loam_collider_create(world(), nullptr, &id); });
  invalid({"collider is null"}, [&] { return loam_collider_create(world(), &def, nullptr); });
  invalid({"world is null"}, [&] { return loam_collider_destroy(nullptr, collider_); });
  for (auto *pose : {&loam_collider_move, &loam_collider_place}) {
    invalid({"world is null"}, [&] { return pose(nullptr, collider_, origin, identity); });
    invalid({"position is null"}, [&] { return pose(world(), collider_, nullptr, identity); });
    invalid({"rotation is null"}, [&] { return pose(world(), collider_, origin, nullptr); });
  }
  invalid({"world is null"}, [&] { return loam_collider_get_report(nullptr, collider_, &report); });
  invalid({"report is null"}, [&] { return loam_collider_get_report(world(), collider_, nullptr); });
}

TEST_F(Colliders, UnknownSizes) {
  for (const std::uint32_t size : wrong_sizes(sizeof(loam_collider_def))) {
    loam_collider_def def = plane();
    def.struct_size = size;
    refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"struct_size", std::to_string(size)});
  }
  for (const std::uint32_t size : wrong_sizes(sizeof(loam_collider_report))) {
    loam_collider_report report = {};
    report.struct_size = size;
    invalid({"report", std::to_string(size)}, [&] { return loam_collider_get_report(world(), collider_, &report); });
  }
}

TEST_F(Colliders, EveryFieldHasItsRange) {
  for (const std::uint32_t kind : {LOAM_COLLIDER_GRID + 1u, ~0u}) {
    loam_collider_def def = plane();
    def.kind = kind;
    refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"kind", std::to_string(kind)});
  }
  for (const float friction : {-0.01f, 100.1f, nan, infinity, -infinity}) {
    loam_collider_def def = plane();
    def.friction = friction;
    refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"friction"});
  }
  for (int k = 0; k < 3; ++k)
    for (const float bad : {nan, infinity, -infinity, 1e20f}) {
      loam_collider_def def = plane();
      def.position[k] = bad;
      refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"position[" + std::to_string(k) + "]"});
    }
  for (int k = 0; k < 4; ++k)
    for (const float bad : {nan, infinity, -infinity, 1e20f}) {
      loam_collider_def def = plane();
      def.rotation[k] = bad;
      refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"rotation[" + std::to_string(k) + "]"});
    }
  loam_collider_def def = plane();
  std::memset(def.rotation, 0, sizeof def.rotation);
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"rotation"});
  def = plane();
  def.reserved = 7;
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"reserved", "7"});
  def = plane();
  def.reaction = 2;
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"reaction", "2"});
}

TEST_F(Colliders, EverySizeOfASolidHasItsRange) {
  const auto of = [](std::uint32_t kind) {
    loam_collider_def def = plane();
    def.kind = kind;
    def.radius = def.half_height = def.half_extents[0] = def.half_extents[1] = def.half_extents[2] = 1;
    return def;
  };
  for (const float bad : {0.0f, -1.0f, 1e9f, nan, infinity, -infinity}) {
    for (const std::uint32_t kind : {LOAM_COLLIDER_SPHERE, LOAM_COLLIDER_CAPSULE}) {
      loam_collider_def def = of(kind);
      def.radius = bad;
      refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"radius"});
    }
    for (int axis = 0; axis < 3; ++axis) {
      loam_collider_def def = of(LOAM_COLLIDER_BOX);
      def.half_extents[axis] = bad;
      refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"half_extents[" + std::to_string(axis) + "]"});
    }
    if (bad == 0) continue;
    loam_collider_def def = of(LOAM_COLLIDER_CAPSULE);
    def.half_height = bad;
    refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"half_height"});
  }
  // A field that a kind does not name is not looked at.
  loam_collider_def def = of(LOAM_COLLIDER_SPHERE);
  def.half_height = def.half_extents[1] = nan;
  loam_collider_id id = 0;
  EXPECT_EQ(loam_collider_create(world(), &def, &id), LOAM_OK);
  EXPECT_EQ(report(id).triangles, 0u);
}

TEST_F(Colliders, AHullMustBeClosedConvexAndOutward) {
  const meshes::Mesh good = meshes::icosphere(1, 2);
  const auto of_hull = [](const meshes::Mesh &mesh) {
    loam_collider_def def = of_mesh(mesh);
    def.kind = LOAM_COLLIDER_HULL;
    return def;
  };
  loam_collider_id id = 0;
  loam_collider_def def = of_hull(good);
  ASSERT_EQ(scenes::outcome(loam_collider_create(world(), &def, &id)), "LOAM_OK");
  EXPECT_EQ(report(id).triangles, 320u);
  meshes::Mesh mesh = good;
  mesh.indices.resize(mesh.indices.size() - 3);
  refuses(LOAM_ERROR_INVALID_MESH, of_hull(mesh), {"mesh", "3 open edges"});
  mesh = good;
  for (int k = 0; k < 3; ++k) mesh.positions[30 + k] *= 0.9f; // a dent
  refuses(LOAM_ERROR_INVALID_MESH, of_hull(mesh), {"mesh is not convex", "vertex"});
  mesh = good;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
  refuses(LOAM_ERROR_INVALID_MESH, of_hull(mesh), {"mesh is not convex", "inward"});
  mesh = good;
  for (std::size_t i = 1; i < mesh.positions.size(); i += 3) mesh.positions[i] = 0;
  refuses(LOAM_ERROR_INVALID_MESH, of_hull(mesh), {"mesh"});
  mesh = meshes::Mesh(); // two sides of a square, each with a diagonal of its own
  mesh.positions = {0, 0, 0, 0, 0, 1, 1, 0, 1, 1, 0, 0};
  mesh.quad(0, 1, 2, 3);
  mesh.quad(3, 2, 1, 0);
  refuses(LOAM_ERROR_INVALID_MESH, of_hull(mesh), {"mesh is flat"});
  refuses(LOAM_ERROR_INVALID_ARGUMENT, of_hull(meshes::icosphere(1, 3)), {"mesh.triangle_count is 1280", "1024"});
  def = of_hull(good);
  def.mesh.positions = nullptr;
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"mesh.positions is null"});
}

TEST_F(Colliders, AGridMustBeOfDistances) {
  const solids::Solid torus =
      solids::grid("torus", 1, 9, [](const solids::Point &p) { return solids::torus_distance(p, 0.6, 0.3); });
  loam_collider_def def = torus.definition();
  loam_collider_id id = 0;
  ASSERT_EQ(scenes::outcome(loam_collider_create(world(), &def, &id)), "LOAM_OK");
  ASSERT_EQ(loam_collider_destroy(world(), id), LOAM_OK);
  const auto refuses_grid = [&](const std::vector<std::string> &parts, auto &&spoil) {
    loam_collider_def bad = torus.definition();
    std::vector<float> values = torus.values;
    bad.grid.values = values.data();
    spoil(bad.grid, values);
    refuses(LOAM_ERROR_INVALID_ARGUMENT, bad, parts);
  };
  using Grid = loam_distance_grid;
  using Values = std::vector<float>;
  refuses_grid({"grid.values is null"}, [](Grid &grid, Values &) { grid.values = nullptr; });
  for (const float bad : {nan, infinity, -infinity, 1e9f})
    refuses_grid({"grid.values[77]"}, [=](Grid &, Values &values) { values[77] = bad; });
  refuses_grid({"grid.values", "change by"}, [](Grid &, Values &values) { values[77] += 0.6f; });
  refuses_grid({"grid.values", "nothing is solid"},
               [](Grid &, Values &values) { std::fill(values.begin(), values.end(), 1.0f); });
  for (const float bad : {0.0f, -1.0f, 1e7f, nan, infinity})
    refuses_grid({"grid.spacing"}, [=](Grid &grid, Values &) { grid.spacing = bad; });
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const std::string at = "[" + std::to_string(axis) + "]";
    for (const float bad : {nan, infinity, 1e20f})
      refuses_grid({"grid.origin" + at}, [=](Grid &grid, Values &) { grid.origin[axis] = bad; });
    for (const std::uint32_t bad : {0u, 1u, 65537u, ~0u})
      refuses_grid({"grid.size" + at}, [=](Grid &grid, Values &) { grid.size[axis] = bad; });
  }
  refuses_grid({"grid.size", "2^28"}, [](Grid &grid, Values &) { std::fill(grid.size, grid.size + 3, 65536u); });
  refuses_grid({"grid.reserved"}, [](Grid &grid, Values &) { grid.reserved = 1; });
}

TEST_F(Colliders, AContactIsOfAPairOrOfAllMaterials) {
  const auto get = [&](loam_material_id material) {
    loam_collider_contact contact = {};
    contact.struct_size = sizeof contact;
    EXPECT_EQ(scenes::outcome(loam_collider_get_contact(world(), collider_, material, &contact)), "LOAM_OK");
    return contact;
  };
  EXPECT_EQ(get(0).friction, 0.6f);
  EXPECT_EQ(get(material_).friction, 0.6f);
  loam_collider_contact own = {sizeof own, 0.1f, 0.5f, 100}, all = {sizeof all, 0.9f, 0.25f, 7};
  ASSERT_EQ(loam_collider_set_contact(world(), collider_, material_, &own), LOAM_OK);
  ASSERT_EQ(loam_collider_set_contact(world(), collider_, 0, &all), LOAM_OK);
  EXPECT_EQ(get(material_).friction, 0.1f);
  EXPECT_EQ(get(material_).restitution, 0.5f);
  EXPECT_EQ(get(material_).stick, 100.0f);
  EXPECT_EQ(get(0).friction, 0.9f);
  world_.step(1e-3f);
  ASSERT_EQ(loam_collider_set_contact(world(), collider_, material_, nullptr), LOAM_OK);
  EXPECT_EQ(get(material_).friction, 0.9f);
  ASSERT_EQ(loam_collider_set_contact(world(), collider_, material_, &own), LOAM_OK);
  ASSERT_EQ(loam_material_destroy(world(), material_), LOAM_OK); // its contact goes with it: the next in its slot has none
  loam_material_id next = 0;
  ASSERT_EQ(loam_material_create(world(), &scene_.material, &next), LOAM_OK);
  EXPECT_EQ(get(next).friction, 0.9f);
  world_.step(1e-3f);
}

TEST_F(Colliders, ContactsAreChecked) {
  const loam_collider_contact good = {sizeof good, 0.1f, 0.5f, 100};
  loam_collider_contact out = good;
  invalid({"world is null"}, [&] { return loam_collider_set_contact(nullptr, collider_, material_, &good); });
  invalid({"world is null"}, [&] { return loam_collider_get_contact(nullptr, collider_, material_, &out); });
  invalid({"contact is null"}, [&] { return loam_collider_get_contact(world(), collider_, material_, nullptr); });
  invalid({"contact is null", "material 0"}, [&] { return loam_collider_set_contact(world(), collider_, 0, nullptr); });
  for (const std::uint32_t size : wrong_sizes(sizeof good)) {
    out.struct_size = size;
    invalid({"contact", std::to_string(size)}, [&] { return loam_collider_set_contact(world(), collider_, 0, &out); });
    invalid({"contact", std::to_string(size)}, [&] { return loam_collider_get_contact(world(), collider_, 0, &out); });
  }
  out = good;
  for (const loam_collider_id bad : {loam_collider_id(0), loam_collider_id(material_), ~loam_collider_id(0)}) {
    refused(LOAM_ERROR_INVALID_HANDLE, {"collider"},
            [&] { return loam_collider_set_contact(world(), bad, material_, &good); });
    refused(LOAM_ERROR_INVALID_HANDLE, {"collider"},
            [&] { return loam_collider_get_contact(world(), bad, material_, &out); });
  }
  for (const loam_material_id bad : {loam_material_id(collider_), ~loam_material_id(0)}) {
    refused(LOAM_ERROR_INVALID_HANDLE, {"material"},
            [&] { return loam_collider_set_contact(world(), collider_, bad, &good); });
    refused(LOAM_ERROR_INVALID_HANDLE, {"material"},
            [&] { return loam_collider_get_contact(world(), collider_, bad, &out); });
  }
  const auto with = [&](const char *field, auto &&spoil) {
    loam_collider_contact bad = good;
    spoil(bad);
    for (const loam_material_id material : {loam_material_id(0), material_})
      invalid({field}, [&] { return loam_collider_set_contact(world(), collider_, material, &bad); });
    loam_collider_def def = plane();
    def.friction = bad.friction;
    def.restitution = bad.restitution;
    def.stick = bad.stick;
    refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {field});
  };
  for (const float bad : {-0.01f, nan, infinity, -infinity, 1e20f}) {
    with("friction", [=](loam_collider_contact &contact) { contact.friction = bad; });
    with("restitution", [=](loam_collider_contact &contact) { contact.restitution = bad; });
    with("stick", [=](loam_collider_contact &contact) { contact.stick = bad; });
  }
  with("restitution", [](loam_collider_contact &contact) { contact.restitution = 1.01f; });
}

TEST_F(Colliders, AReactionIsOfThoseThatWereMadeForIt) {
  loam_collider_def def = plane();
  def.reaction = 1;
  loam_collider_id id = 0;
  const std::uint64_t before = world_.memory_bytes();
  ASSERT_EQ(loam_collider_create(world(), &def, &id), LOAM_OK);
  loam_collider_reaction reaction = {};
  reaction.struct_size = sizeof reaction;
  ASSERT_EQ(scenes::outcome(loam_collider_get_reaction(world(), id, &reaction)), "LOAM_OK");
  EXPECT_EQ(reaction.impulse[1], 0.0);
  EXPECT_EQ(reaction.contacts, 0u);
  world_.step(1e-3f);
  ASSERT_EQ(loam_collider_get_reaction(world(), id, &reaction), LOAM_OK);
  EXPECT_GT(world_.memory_bytes(), before);
  invalid({"collider", "reaction 0"}, [&] { return loam_collider_get_reaction(world(), collider_, &reaction); });
  invalid({"world is null"}, [&] { return loam_collider_get_reaction(nullptr, id, &reaction); });
  invalid({"reaction is null"}, [&] { return loam_collider_get_reaction(world(), id, nullptr); });
  for (const std::uint32_t size : wrong_sizes(sizeof reaction)) {
    reaction.struct_size = size;
    invalid({"reaction", std::to_string(size)}, [&] { return loam_collider_get_reaction(world(), id, &reaction); });
  }
  reaction.struct_size = sizeof reaction;
  ASSERT_EQ(loam_collider_destroy(world(), id), LOAM_OK);
  refused(LOAM_ERROR_INVALID_HANDLE, {"collider"}, [&] { return loam_collider_get_reaction(world(), id, &reaction); });
}

/* A host of the first version: its definition ends before the fields of solids. */
TEST_F(Colliders, AnOlderDefinitionKeepsWorking) {
  constexpr std::size_t first = offsetof(loam_collider_def, radius);
  loam_collider_def def;
  std::memset(static_cast<void *>(&def), 0x5A, sizeof def);
  ASSERT_EQ(loam_collider_def_default(&def, first), LOAM_OK);
  EXPECT_EQ(def.struct_size, first);
  const auto *bytes = reinterpret_cast<const unsigned char *>(&def);
  EXPECT_TRUE(std::all_of(bytes + first, bytes + sizeof def, [](unsigned char byte) { return byte == 0x5A; }));
  loam_collider_id id = 0;
  EXPECT_EQ(scenes::outcome(loam_collider_create(world(), &def, &id)), "LOAM_OK");
  def.kind = LOAM_COLLIDER_SPHERE; // it cannot know how large
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"radius is 0"});
}

TEST_F(Colliders, MeshesAreChecked) {
  const meshes::Mesh good = meshes::box(1, 1, 1);
  loam_collider_def def = of_mesh(good);
  def.mesh.positions = nullptr;
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"mesh.positions is null"});
  def = of_mesh(good);
  def.mesh.indices = nullptr;
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"mesh.indices is null"});
  def = of_mesh(good);
  def.mesh.triangle_count = 0;
  refuses(LOAM_ERROR_INVALID_MESH, def, {"mesh"});
  def = of_mesh(good);
  def.mesh.vertex_count = 7;
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"mesh.indices", "7"});
  def = of_mesh(good);
  def.mesh.triangle_count = ~0u; // refused before anything is read
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"mesh.triangle_count"});
  for (const float bad : {nan, infinity, -infinity, 1e30f}) {
    meshes::Mesh mesh = good;
    mesh.positions[10] = bad;
    refuses(LOAM_ERROR_INVALID_ARGUMENT, of_mesh(mesh), {"mesh.positions[10]", "vertex 3"});
  }
  meshes::Mesh mesh = good;
  mesh.indices[4] = ~0u;
  refuses(LOAM_ERROR_INVALID_ARGUMENT, of_mesh(mesh), {"mesh.indices[4]", "triangle 1"});
  for (float &coordinate : mesh.positions) coordinate = 1;
  mesh.indices = good.indices;
  refuses(LOAM_ERROR_INVALID_MESH, of_mesh(mesh), {"mesh", "degenerate"});
}

TEST_F(Colliders, TheReportCountsWhatIsImperfect) {
  loam_collider_report found = report_of(meshes::box(1, 1, 1));
  EXPECT_EQ(found.triangles, 12u);
  EXPECT_EQ(found.degenerate_triangles + found.open_edges + found.non_manifold_edges, 0u);
  EXPECT_EQ(found.closed, 1u);

  found = report_of(meshes::sheet(1, 3));
  EXPECT_EQ(found.open_edges, 12u);
  EXPECT_EQ(found.closed, 0u);

  meshes::Mesh fin = meshes::box(1, 1, 1); // a third triangle on one edge
  fin.triangle(0, 4, fin.vertex(0, -3, 0));
  found = report_of(fin);
  EXPECT_EQ(found.non_manifold_edges, 1u);
  EXPECT_EQ(found.open_edges, 2u);
  EXPECT_EQ(found.closed, 0u);

  meshes::Mesh degenerate = meshes::box(1, 1, 1);
  degenerate.triangle(0, 0, 1);
  found = report_of(degenerate);
  EXPECT_EQ(found.degenerate_triangles, 1u);
  EXPECT_EQ(found.triangles, 12u);
  EXPECT_EQ(found.closed, 1u);

  const loam_collider_def def = plane();
  loam_collider_id id = 0;
  ASSERT_EQ(loam_collider_create(world(), &def, &id), LOAM_OK);
  found = report(id);
  EXPECT_EQ(found.triangles + found.open_edges + found.closed, 0u);
}

TEST_F(Colliders, PosesAreChecked) {
  for (auto *pose : {&loam_collider_move, &loam_collider_place}) {
    for (int k = 0; k < 4; ++k)
      for (const float bad : {nan, infinity, -infinity}) {
        float rotation[4] = {0, 0, 0, 1}, position[3] = {0, 0, 0};
        rotation[k] = bad;
        invalid({"rotation[" + std::to_string(k) + "]"}, [&] { return pose(world(), collider_, position, rotation); });
        if (k == 3) continue;
        position[k] = bad;
        invalid({"position[" + std::to_string(k) + "]"}, [&] { return pose(world(), collider_, position, identity); });
      }
    const float none[4] = {0, 0, 0, 0}, unnormalised[4] = {0, 0, 5, 5};
    invalid({"rotation"}, [&] { return pose(world(), collider_, origin, none); });
    EXPECT_EQ(pose(world(), collider_, origin, unnormalised), LOAM_OK);
  }
}

TEST_F(Colliders, WrongHandles) {
  loam_collider_id stale = 0, foreign = 0;
  const loam_collider_def def = plane();
  ASSERT_EQ(loam_collider_create(world(), &def, &stale), LOAM_OK);
  ASSERT_EQ(loam_collider_destroy(world(), stale), LOAM_OK);
  const scenes::World other(definition(scene_));
  ASSERT_EQ(loam_collider_create(other.get(), &def, &foreign), LOAM_OK);
  for (const loam_collider_id bad : {loam_collider_id(0), stale, foreign, collider_ + 1000, ~loam_collider_id(0)}) {
    loam_collider_report report = {};
    report.struct_size = sizeof report;
    const auto wrong = [&](auto &&call) { refused(LOAM_ERROR_INVALID_HANDLE, {"collider"}, call); };
    wrong([&] { return loam_collider_destroy(world(), bad); });
    wrong([&] { return loam_collider_move(world(), bad, origin, identity); });
    wrong([&] { return loam_collider_place(world(), bad, origin, identity); });
    wrong([&] { return loam_collider_get_report(world(), bad, &report); });
  }
}

TEST_F(Colliders, AWorldHoldsFourThousandAndNinetySix) {
  const loam_collider_def def = plane();
  std::vector<loam_collider_id> ids;
  loam_status status = LOAM_OK;
  while (ids.size() < 5000 && status == LOAM_OK) {
    loam_collider_id id = 0;
    status = loam_collider_create(world(), &def, &id);
    if (status == LOAM_OK) ids.push_back(id);
  }
  EXPECT_EQ(status, LOAM_ERROR_CAPACITY);
  test::expect_error_names({"4096"});
  EXPECT_EQ(ids.size(), 4096u - 2); // the fixture's plane and box
  for (const loam_collider_id id : ids) ASSERT_EQ(loam_collider_destroy(world(), id), LOAM_OK);
}

/* move() carries what it touches over the next step; place() does not. */
TEST_F(Colliders, MovingPushesAndPlacingDoesNot) {
  for (const bool at_once : {false, true}) {
    scenes::Scene lone;
    lone.material = scenes::rubber();
    lone.spacing = 0.01f;
    lone.positions = {0, 0.005f, 0};
    loam_world_def world_def = scenes::world_def(lone);
    world_def.gravity[1] = 0;
    scenes::World pushed(world_def, lone);
    loam_collider_def def = plane();
    loam_collider_id id = 0;
    ASSERT_EQ(loam_collider_create(pushed.get(), &def, &id), LOAM_OK);
    const float up[3] = {0, 0.004f, 0};
    ASSERT_EQ((at_once ? loam_collider_place : loam_collider_move)(pushed.get(), id, up, identity), LOAM_OK);
    pushed.step(0.01f);
    if (at_once) {
      EXPECT_LT(pushed.snapshot().velocities[1], 0.11f); // out slowly, no push
    } else {
      EXPECT_NEAR(pushed.snapshot().velocities[1], 0.4f, 0.01f);
      EXPECT_NEAR(pushed.snapshot().positions[1], 0.009f, 2e-4f);
    }
  }
}

TEST_F(Colliders, OnlyAMeshDeforms) {
  const meshes::Mesh ball = meshes::icosphere(0.1f, 1);
  loam_collider_def def = of_mesh(ball);
  EXPECT_EQ(def.deforms, 0u);
  def.deforms = 2;
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"deforms", "2"});
  def.deforms = 1;
  def.reserved_2 = 3;
  refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"reserved_2", "3"});
  def.reserved_2 = 0;
  for (const std::uint32_t kind : {LOAM_COLLIDER_PLANE, LOAM_COLLIDER_HULL, LOAM_COLLIDER_SPHERE}) {
    def.kind = kind;
    refuses(LOAM_ERROR_INVALID_ARGUMENT, def, {"deforms", "kind"});
  }
}

TEST_F(Colliders, VerticesAreChecked) {
  const meshes::Mesh ball = meshes::icosphere(0.1f, 1); // 42 vertices
  loam_collider_def def = of_mesh(ball);
  loam_collider_id rigid = 0, soft = 0;
  ASSERT_EQ(loam_collider_create(world(), &def, &rigid), LOAM_OK);
  const std::uint64_t before = world_.memory_bytes();
  def.deforms = 1;
  ASSERT_EQ(loam_collider_create(world(), &def, &soft), LOAM_OK);
  EXPECT_GT(world_.memory_bytes(), before);
  ASSERT_EQ(loam_collider_destroy(world(), soft), LOAM_OK);
  EXPECT_EQ(world_.memory_bytes(), before);
  ASSERT_EQ(loam_collider_create(world(), &def, &soft), LOAM_OK);
  const float *good = ball.positions.data();
  for (auto *move : {&loam_collider_move_vertices, &loam_collider_place_vertices}) {
    invalid({"world is null"}, [&] { return move(nullptr, soft, good, 42); });
    invalid({"positions is null"}, [&] { return move(world(), soft, nullptr, 42); });
    invalid({"deforms 0"}, [&] { return move(world(), rigid, good, 42); });
    for (const std::uint32_t wrong : {0u, 41u, 43u, ~0u})
      invalid({"vertex_count is " + std::to_string(wrong), "42"}, [&] { return move(world(), soft, good, wrong); });
    for (const float bad : {nan, infinity, -infinity, 1e9f}) {
      meshes::Mesh broken = ball;
      broken.positions[77] = bad;
      invalid({"positions[77]", "vertex 25"}, [&] { return move(world(), soft, broken.positions.data(), 42); });
    }
    EXPECT_EQ(scenes::outcome(move(world(), soft, good, 42)), "LOAM_OK");
  }
  // One point, and then something again.
  const std::vector<float> nothing(126, 0.05f);
  ASSERT_EQ(loam_collider_move_vertices(world(), soft, nothing.data(), 42), LOAM_OK);
  world_.step(1e-3f);
  ASSERT_EQ(loam_collider_move_vertices(world(), soft, good, 42), LOAM_OK);
  world_.step(1e-3f);
  EXPECT_EQ(world_.statistics().non_finite, 0u);
  ASSERT_EQ(loam_collider_destroy(world(), soft), LOAM_OK);
  for (const loam_collider_id bad : {soft, loam_collider_id(0), loam_collider_id(material_)})
    refused(LOAM_ERROR_INVALID_HANDLE, {"collider"}, [&] { return loam_collider_move_vertices(world(), bad, good, 42); });
}

} // namespace
} // namespace loam
