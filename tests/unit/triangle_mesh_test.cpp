// Meshes from the host: what is refused, what is dropped, what is counted.
#include "scene/triangle_mesh.h"

#include <limits>

#include <gtest/gtest.h>

#include "scene/error.h"
#include "unit/test_meshes.h"

namespace loam {
namespace {

using test::MeshData;

loam_status status_of(const loam_mesh &mesh, std::string *text = nullptr) {
  try {
    make_triangle_mesh(mesh, "mesh");
    return LOAM_OK;
  } catch (const Error &error) {
    if (text != nullptr) *text = error.what();
    return error.status();
  }
}

TEST(TriangleMesh, ClosedMeshesAreClosed) {
  for (const MeshData &data : {test::box_mesh({1, 2, 3}), test::icosphere_mesh(1, 2), test::torus_mesh(1, 0.3f, 24, 12)}) {
    const TriangleMesh mesh = make_triangle_mesh(data.view(), "mesh");
    EXPECT_EQ(mesh.report.closed, 1u);
    EXPECT_EQ(mesh.report.triangles, data.indices.size() / 3);
    EXPECT_EQ(mesh.report.open_edges, 0u);
    EXPECT_EQ(mesh.report.non_manifold_edges, 0u);
    EXPECT_EQ(mesh.report.struct_size, sizeof(loam_collider_report));
    EXPECT_TRUE(mesh.first_flaw.empty());
  }
}

TEST(TriangleMesh, RepeatedVerticesDoNotOpenAMesh) {
  const MeshData box = test::box_mesh({1, 1, 1});
  MeshData split; // three vertices of its own for each triangle, as files with flat normals have
  for (const std::uint32_t i : box.indices) {
    split.indices.push_back(std::uint32_t(split.vertices.size()));
    split.vertices.push_back(box.vertices[i]);
  }
  split.vertices[0].x *= 1.0f;
  EXPECT_EQ(make_triangle_mesh(split.view(), "mesh").report.closed, 1u);
}

TEST(TriangleMesh, OpenEdgesAreCountedAndNamed) {
  MeshData box = test::box_mesh({1, 1, 1});
  box.indices.erase(box.indices.begin(), box.indices.begin() + 3); // 0 4 6
  const TriangleMesh mesh = make_triangle_mesh(box.view(), "mesh");
  EXPECT_EQ(mesh.report.closed, 0u);
  EXPECT_EQ(mesh.report.open_edges, 3u);
  EXPECT_EQ(mesh.first_flaw, "3 open edges (between vertices 0-4, 0-6, 4-6)");
}

TEST(TriangleMesh, NonManifoldAndMisorientedEdgesAreCounted) {
  MeshData fin = test::box_mesh({1, 1, 1});
  fin.vertices.push_back({0, 5, 0});
  fin.triangle(0, 1, 8);
  const TriangleMesh finned = make_triangle_mesh(fin.view(), "mesh");
  EXPECT_EQ(finned.report.non_manifold_edges, 1u);
  EXPECT_EQ(finned.report.open_edges, 2u);
  EXPECT_EQ(finned.first_flaw, "2 open edges (between vertices 0-8, 1-8) and 1 non-manifold edges (between vertices 0-1)");

  MeshData flipped = test::box_mesh({1, 1, 1});
  std::swap(flipped.indices[0], flipped.indices[1]);
  const TriangleMesh mesh = make_triangle_mesh(flipped.view(), "mesh");
  EXPECT_EQ(mesh.report.open_edges, 0u);
  EXPECT_EQ(mesh.report.non_manifold_edges, 3u);
  EXPECT_EQ(mesh.report.closed, 0u);
}

TEST(TriangleMesh, DegenerateTrianglesAreDroppedAndCounted) {
  MeshData data = test::box_mesh({1, 1, 1});
  data.triangle(3, 3, 5);                                                           // a repeated index
  data.vertices.insert(data.vertices.end(), {{0, 0, 0}, {1, 0, 0}, {0.25f, 0, 0}}); // on one line
  data.triangle(8, 9, 10);
  const TriangleMesh mesh = make_triangle_mesh(data.view(), "mesh");
  EXPECT_EQ(mesh.report.triangles, 12u);
  EXPECT_EQ(mesh.report.degenerate_triangles, 2u);
  EXPECT_EQ(mesh.indices.size(), 36u);

  // A sliver a metre long and a hundredth of a millimetre wide has a direction still.
  MeshData sliver;
  sliver.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5f, 0, 1e-5f}};
  sliver.triangle(0, 1, 2);
  EXPECT_EQ(make_triangle_mesh(sliver.view(), "mesh").report.triangles, 1u);
}

TEST(TriangleMesh, ATriangleWithoutAreaStillClosesATJunction) {
  // The edge 0-1 of the first triangle meets 0-3 and 3-1 of others below; the triangle 0 1 3 without area lies between them.
  MeshData data;
  data.vertices = {{0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {1, 0, 0}, {1, 0.5f, -1}};
  data.triangle(0, 1, 2);
  data.triangle(1, 0, 3);
  data.triangle(0, 2, 4);
  data.triangle(2, 1, 4);
  data.triangle(3, 0, 4);
  data.triangle(1, 3, 4);
  const TriangleMesh mesh = make_triangle_mesh(data.view(), "mesh");
  EXPECT_EQ(mesh.report.degenerate_triangles, 1u);
  EXPECT_EQ(mesh.report.closed, 1u);
}

TEST(TriangleMesh, BadInputIsNamed) {
  MeshData data = test::box_mesh({1, 1, 1});
  std::string text;
  data.vertices[5].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(status_of(data.view(), &text), LOAM_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(text.find("mesh.positions[16] (vertex 5)"), std::string::npos) << text;
  data.vertices[5].y = std::numeric_limits<float>::infinity();
  EXPECT_EQ(status_of(data.view()), LOAM_ERROR_INVALID_ARGUMENT);
  data.vertices[5].y = 1e30f;
  EXPECT_EQ(status_of(data.view()), LOAM_ERROR_INVALID_ARGUMENT);
  data.vertices[5].y = 1;
  data.indices[7] = 8;
  EXPECT_EQ(status_of(data.view(), &text), LOAM_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(text.find("mesh.indices[7] (triangle 2) is 8"), std::string::npos) << text;

  loam_mesh null = data.view();
  null.positions = nullptr;
  EXPECT_EQ(status_of(null), LOAM_ERROR_INVALID_ARGUMENT);
  null = data.view();
  null.indices = nullptr;
  EXPECT_EQ(status_of(null), LOAM_ERROR_INVALID_ARGUMENT);
  null = data.view();
  null.triangle_count = 0;
  EXPECT_EQ(status_of(null), LOAM_ERROR_INVALID_MESH);
  MeshData flat;
  flat.vertices = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  flat.triangle(0, 1, 2);
  EXPECT_EQ(status_of(flat.view(), &text), LOAM_ERROR_INVALID_MESH);
  EXPECT_NE(text.find("1 are degenerate"), std::string::npos) << text;
}

} // namespace
} // namespace loam
