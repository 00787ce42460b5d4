// Contact of particles with planes and meshes: what is found, friction against closed forms, and that nothing ever gets through.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "scene/winding_number.h"
#include "unit/contact_scene.h"

namespace loam {
namespace {

using test::ContactScene;
using test::MeshData;
using test::turn;

// A disc of `valence` triangles around one vertex, facing up.
MeshData fan_mesh(float radius, std::uint32_t valence) {
  MeshData mesh;
  mesh.vertices.push_back({0, 0, 0});
  for (std::uint32_t i = 0; i < valence; ++i) {
    const float angle = 6.2831853f * float(i) / float(valence);
    mesh.vertices.push_back({radius * std::cos(angle), 0, radius * std::sin(angle)});
  }
  for (std::uint32_t i = 0; i < valence; ++i) mesh.triangle(0, 1 + (i + 1) % valence, 1 + i);
  return mesh;
}

TEST(FindContacts, AFlatFloorGivesOnePlane) {
  // Over the tessellation's insides, edges and vertices alike, and over a vertex of valence 64.
  for (const MeshData &mesh : {test::floor_mesh(0.1f, 40), fan_mesh(0.1f, 64)}) {
    ContactScene scene;
    scene.add_mesh(mesh, 0.5f);
    test::Random random{1};
    for (int i = 0; i < 2000; ++i)
      scene.add({random.between(-0.07f, 0.07f), random.between(0.001f, 0.012f), random.between(-0.07f, 0.07f)});
    for (const Vec3<float> &v : mesh.vertices) {
      if (length(v) < 0.07f) scene.add(v + Vec3<float>{0, 0.005f, 0});
    }
    scene.find();
    ASSERT_EQ(scene.contact_count, int(scene.positions.size()));
    for (int c = 0; c < scene.contact_count; ++c) {
      const Contact &contact = scene.contacts[std::size_t(c)];
      EXPECT_EQ(contact.plane_count, 1);
      EXPECT_NEAR(contact.planes[0].normal.y, 1, 1e-5);
    }
  }
}

TEST(FindContacts, TheSideIsTheParticles) {
  ContactScene scene;
  scene.add_mesh(test::floor_mesh(0.1f, 10), 0.5f);
  scene.add({0.013f, 0.006f, 0.007f});
  scene.add({0.013f, -0.006f, 0.007f});
  scene.add({0.013f, 1e-5f, 0.007f}); // too near for a direction
  scene.add({0.013f, -1e-5f, 0.007f});
  scene.find();
  const float side[4] = {1, -1, 1, -1};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(scene.contacts[i].planes[0].normal.y, side[i], 1e-5);
    EXPECT_EQ(scene.contacts[i].plane_count, 1);
  }
  EXPECT_NEAR(scene.contacts[0].planes[0].gap, 0.001, 1e-6);
  EXPECT_NEAR(scene.contacts[2].planes[0].gap, -0.01 * 0.00499, 1e-7); // one hundredth of what is missing in 0.5 ms
}

TEST(FindContacts, AConcaveCornerKeepsItsWallsAndAConvexOneHasOne) {
  ContactScene scene;
  scene.add_mesh(test::box_mesh({0.1f, 0.1f, 0.1f}), 0.5f);
  scene.add({-0.094f, -0.095f, -0.096f}); // inside, in the corner
  scene.add({-0.094f, -0.095f, 0.0f});    // inside, along an edge
  scene.add({-0.104f, -0.103f, -0.105f}); // outside, at the vertex
  scene.add({-0.104f, -0.103f, 0.013f});  // outside, at an edge
  scene.add({-0.104f, -0.093f, 0.013f});  // outside, at a face near an edge
  scene.find();
  const int planes[5] = {3, 2, 1, 1, 1};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(scene.contacts[i].plane_count, planes[i]) << i;
  EXPECT_NEAR(scene.contacts[0].planes[0].normal.z, 1, 1e-5); // the closest first
  EXPECT_NEAR(scene.contacts[0].planes[2].normal.x, 1, 1e-5);
  const Vec3<float> diagonal = (1 / std::sqrt(50.0f)) * Vec3<float>{-4, -3, -5};
  EXPECT_GT(dot(scene.contacts[2].planes[0].normal, diagonal), 0.9999f);
}

TEST(FindContacts, CountsOnPastTheCapacityAndSkipsPinnedAndBroken) {
  ContactScene scene;
  scene.add_plane(0.5f);
  for (int i = 0; i < 10; ++i) scene.add({float(i), 0.004f, 0});
  scene.velocities[3].w = 0;
  scene.positions[4].y = std::numeric_limits<float>::quiet_NaN();
  scene.positions[5].y = 1; // out of reach
  std::vector<Contact> contacts(8);
  contacts[5].particle = -7;
  int count = 0;
  const FindContacts kernel{scene.positions.data(),
                            scene.velocities.data(),
                            scene.colliders.data(),
                            1,
                            5e-4f,
                            0.005f,
                            0.01f,
                            contacts.data(),
                            5,
                            &count};
  for (int i = 0; i < 10; ++i) kernel(i);
  EXPECT_EQ(count, 7);
  EXPECT_EQ(contacts[5].particle, -7);
}

TEST(FindContacts, AMovingColliderPushesByItsMotion) {
  ContactScene scene;
  const int plate = scene.add_mesh(test::floor_mesh(0.1f, 5), 0.5f);
  scene.add({0.03f, 0.005f, 0.01f});
  scene.move(plate, {{0, 0.002f, 0.001f}, {0, 0, 0, 1}});
  scene.find();
  const ContactPlane &plane = scene.contacts[0].planes[0];
  EXPECT_NEAR(plane.gap, -0.002, 1e-6);
  EXPECT_NEAR(plane.surface_velocity.y, 0.002 / 5e-4, 1e-3);
  EXPECT_NEAR(plane.surface_velocity.z, 0.001 / 5e-4, 1e-3);

  // Turning about z by 0.1: the surface at x = 0.03 goes up by 0.003, and the normal turns with it.
  scene.move(plate, {{0, 0, 0}, turn({0, 0, 1}, 0.1f)});
  scene.find();
  const ContactPlane &turned = scene.contacts[0].planes[0];
  EXPECT_NEAR(turned.normal.x, -std::sin(0.1), 1e-5);
  EXPECT_NEAR(turned.surface_velocity.y, 0.03 * std::sin(0.1) / 5e-4, 1e-2);
}

// A particle that slides on a floor turned anyhow in space; returns how far it went along the floor until it stopped or `steps` were over.
struct Slide {
  double distance, speed, off_line, off_surface;
};
Slide slide(const MeshData *mesh, float incline, float friction, float speed, int steps,
            Vec3<float> start = {-0.25f, 0.005f, 0.003f}) {
  ContactScene scene;
  const Vec4<float> about = turn({0.3f, 1, -0.2f}, 1.1f);              // of the whole scene
  const Vec4<float> tilt = multiply(about, turn({0, 0, 1}, -incline)); // downhill is +x of the floor
  const Pose pose{{0.1f, -0.3f, 0.2f}, tilt};
  scene.gravity = rotate(about, {0, -9.81f, 0});
  if (mesh != nullptr)
    scene.add_mesh(*mesh, friction, pose);
  else
    scene.add_plane(friction, pose);
  scene.add(to_world(pose, start), rotate(tilt, {speed, 0, 0}));
  Slide result{};
  for (int s = 0; s < steps; ++s) {
    scene.step();
    const Vec3<float> local = to_local(pose, scene.x(0));
    result.off_line = std::max(result.off_line, std::fabs(double(local.z) - start.z));
    result.off_surface = std::max(result.off_surface, std::fabs(double(local.y) - 0.005));
    result.distance = local.x - start.x;
  }
  result.speed = length(scene.v(0));
  return result;
}

TEST(SolveContacts, SlidingStopsWhereCoulombSaysOnAnyTessellation) {
  const MeshData fine = test::floor_mesh(0.4f, 100), coarse = test::floor_mesh(0.4f, 3);
  const MeshData fan = fan_mesh(0.4f, 64);
  for (const MeshData *mesh : {static_cast<const MeshData *>(nullptr), &fine, &coarse, &fan}) {
    const Slide stopped = slide(mesh, 0, 0.3f, 1.0f, 1000, {-0.1f, 0.005f, mesh == &fan ? 0.0f : 0.003f});
    EXPECT_NEAR(stopped.distance, 1.0 / (2 * 0.3 * 9.81), 0.01 * 0.17);
    EXPECT_LT(stopped.speed, 1e-4);
    EXPECT_LT(stopped.off_line, 2e-5);
    EXPECT_LT(stopped.off_surface, 2e-5);
  }
}

TEST(SolveContacts, ABlockOnAnInclineSlidesOrSticks) {
  const MeshData fine = test::floor_mesh(0.4f, 100);
  for (const MeshData *mesh : {static_cast<const MeshData *>(nullptr), &fine}) {
    const float angle = 0.5f; // tan = 0.546
    for (const float friction : {0.0f, 0.3f, 0.5f}) {
      const double acceleration = 9.81 * (std::sin(0.5) - friction * std::cos(0.5));
      const Slide moving = slide(mesh, angle, friction, 0, 400); // 0.2 s
      EXPECT_NEAR(moving.distance / (0.5 * acceleration * 0.04), 1, 0.01) << friction;
    }
    for (const float friction : {0.56f, 1.0f}) {
      const Slide stuck = slide(mesh, angle, friction, 0, 2000);
      EXPECT_LT(std::fabs(stuck.distance), 1e-5);
      EXPECT_LT(stuck.speed, 1e-4);
    }
  }
}

TEST(SolveContacts, AMovingFloorCarriesByFriction) {
  ContactScene scene;
  const int belt = scene.add_mesh(test::floor_mesh(0.5f, 30), 0.5f);
  scene.add({0.01f, 0.005f, 0.02f});
  for (int s = 1; s <= 400; ++s) { // 0.2 s at 0.5 m/s; friction needs 0.1 s of it
    scene.move(belt, {{0.5f * 5e-4f * float(s), 0, 0}, {0, 0, 0, 1}});
    scene.step();
  }
  EXPECT_NEAR(scene.v(0).x, 0.5, 5e-3);
  EXPECT_NEAR(scene.x(0).x - 0.01f, 0.5 * 0.2 - 0.5 * 0.25 / (0.5 * 9.81), 2e-3);
}

TEST(SolveContacts, IteratingOpposedPlanesStaysBounded) {
  ContactScene scene;
  scene.add_mesh(test::box_mesh({0.1f, 0.1f, 0.004f}), 0.5f); // inside, 4 mm from either side: less than the stand-off
  scene.add({0.01f, 0.01f, 0.0005f}, {0, 0, 3});
  scene.iterations = 1000;
  for (int s = 0; s < 500; ++s) scene.step();
  EXPECT_LT(std::fabs(scene.x(0).z), 0.004f);
  EXPECT_LT(length(scene.v(0)), 0.3f);
}

TEST(SolveContacts, ATooNearParticleComesOutWithoutAHop) {
  const MeshData floor = test::floor_mesh(0.1f, 10);
  for (int kind = 0; kind < 2; ++kind) {
    for (const float substep : {1e-5f, 5e-4f, 1.0f / 240}) {
      ContactScene scene;
      scene.substep = substep;
      if (kind == 0)
        scene.add_plane(0.5f);
      else
        scene.add_mesh(floor, 0.5f);
      scene.add({0.013f, 0.001f, 0.007f});
      float highest = 0, fastest = 0;
      for (float t = 0; t < 0.5f; t += substep) {
        scene.step();
        highest = std::max(highest, scene.x(0).y);
        fastest = std::max(fastest, scene.v(0).y);
      }
      EXPECT_LT(highest, 0.005f * 1.001f);
      EXPECT_GT(scene.x(0).y, 0.005f * 0.999f);
      EXPECT_LT(fastest, 0.1f);
    }
  }
  // A particle deep in a half space rises at a bounded speed.
  ContactScene buried;
  buried.add_plane(0.5f);
  buried.add({0, -0.02f, 0});
  for (int s = 0; s < 1000; ++s) {
    buried.step();
    EXPECT_LE(length(buried.v(0)), 0.1001f);
  }
  EXPECT_GT(buried.x(0).y, 0.004f);
}

// Counts particles that are not inside a closed mesh.
int outside(const ContactScene &scene, const WindingNumber &winding, const Pose &pose) {
  int count = 0;
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    const Vec3<float> local = to_local(pose, scene.x(i));
    count += winding.at({local.x, local.y, local.z}) > 0.5 ? 0 : 1;
  }
  return count;
}

TEST(Contact, AThousandParticlesComeToRestInABall) {
  const MeshData ball = test::icosphere_mesh(0.1f, 3);
  const WindingNumber winding(make_triangle_mesh(ball.view(), "mesh"));
  ContactScene scene;
  const Pose pose{{0.3f, -0.2f, 0.5f}, turn({1, 2, 3}, 0.7f)};
  scene.add_mesh(ball, 0.6f, pose);
  test::Random random{7};
  for (int i = 0; i < 1000; ++i) {
    scene.add(pose.position + random.between(0, 0.09f) * random.direction(), random.between(0, 10) * random.direction());
  }
  for (int s = 0; s < 3000; ++s) { // 1.5 s
    scene.step();
    if (s % 500 == 0) {
      ASSERT_EQ(outside(scene, winding, pose), 0) << s;
    }
  }
  EXPECT_EQ(outside(scene, winding, pose), 0);
  double fastest = 0, least_gap = 1;
  std::vector<Row> before = scene.positions;
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    fastest = std::max<double>(fastest, length(scene.v(i)));
    least_gap = std::min<double>(least_gap, winding.distance(to_local(pose, scene.x(i)), 1));
  }
  EXPECT_LT(fastest, 1e-3);
  EXPECT_GT(least_gap, 0.999 * 0.005);
  for (int s = 0; s < 500; ++s) scene.step();
  double drift = 0;
  for (std::size_t i = 0; i < before.size(); ++i) drift = std::max<double>(drift, length(scene.x(i) - xyz(before[i])));
  EXPECT_LT(drift, 1e-6); // a quarter of a second more, and nothing has moved
}

TEST(Contact, WithoutTheSweepOrThePlanesTheOtherStillHolds) {
  const MeshData ball = test::icosphere_mesh(0.1f, 2);
  const WindingNumber winding(make_triangle_mesh(ball.view(), "mesh"));
  const Pose pose{{0, 0, 0}, {0, 0, 0, 1}};
  ContactScene scene;
  scene.solve = false; // planes ignored: gravity presses on the sweep alone
  scene.add_mesh(ball, 0.6f);
  test::Random random{9};
  for (int i = 0; i < 300; ++i)
    scene.add(random.between(0, 0.09f) * random.direction(), random.between(0, 20) * random.direction());
  for (int s = 0; s < 2000; ++s) scene.step();
  EXPECT_EQ(outside(scene, winding, pose), 0);
  for (std::size_t i = 0; i < scene.positions.size(); ++i) EXPECT_GT(winding.distance(scene.x(i), 1), 0.9f * scene.margin());
}

TEST(Contact, NothingLeavesABoxThatIsShaken) {
  const MeshData box = test::box_mesh({0.1f, 0.06f, 0.08f});
  const WindingNumber winding(make_triangle_mesh(box.view(), "mesh"));
  for (const bool solve : {true, false}) {
    ContactScene scene;
    scene.solve = solve;
    Pose pose{{0, 0, 0}, {0, 0, 0, 1}};
    const int collider = scene.add_mesh(box, 0.3f, pose);
    test::Random random{4};
    for (int i = 0; i < 300; ++i)
      scene.add({random.between(-0.09f, 0.09f), random.between(-0.05f, 0.05f), random.between(-0.07f, 0.07f)});
    Vec3<float> velocity{}, spin{1, 0, 0};
    for (int s = 0; s < 2000; ++s) {
      if (s % 50 == 0) {
        velocity = random.between(0, 0.01f) * random.direction(); // up to r a substep
        spin = random.between(0, 0.1f) * random.direction();      // the corners at up to 1.4 r a substep
      }
      pose.position = pose.position + velocity;
      if (length(pose.position) > 0.5f) velocity = -1.0f * velocity;
      pose.rotation = multiply(turn(spin, length(spin)), pose.rotation);
      const float norm = std::sqrt(pose.rotation.x * pose.rotation.x + pose.rotation.y * pose.rotation.y +
                                   pose.rotation.z * pose.rotation.z + pose.rotation.w * pose.rotation.w);
      pose.rotation = {pose.rotation.x / norm, pose.rotation.y / norm, pose.rotation.z / norm, pose.rotation.w / norm};
      scene.move(collider, pose);
      scene.step();
      if (s % 100 == 0) {
        ASSERT_EQ(outside(scene, winding, pose), 0) << s;
      }
    }
    EXPECT_EQ(outside(scene, winding, pose), 0);
  }
}

// To and fro by fifteen times its radius a substep: the wall that comes has no nearest point of its own, the one that is near recedes.
TEST(Contact, ARoundMeshThatJumpsTakesAlongWhatIsInIt) {
  const MeshData ball = test::icosphere_mesh(0.04f, 2);
  const WindingNumber winding(make_triangle_mesh(ball.view(), "mesh"));
  ContactScene scene;
  const int collider = scene.add_mesh(ball, 0.5f);
  test::Random random{3};
  for (int i = 0; i < 200; ++i) scene.add(random.between(0, 0.037f) * random.direction());
  Pose pose{{0, 0, 0}, {0, 0, 0, 1}};
  for (int s = 0; s < 100; ++s) {
    if (s % 10 < 3) pose = {{s % 2 == 0 ? 0.6f : 0.0f, 0.01f * float(s % 7), 0}, turn({0, 1, 0.5f}, 0.01f * float(s))};
    scene.move(collider, pose);
    scene.step();
    ASSERT_EQ(outside(scene, winding, pose), 0) << s;
  }
}

TEST(Contact, AThinMovingPlatePushesAndNothingPasses) {
  for (const float speed : {0.1f, 0.5f, 1.0f, 3.0f}) { // in r a substep
    ContactScene scene;
    scene.gravity = {0, 0, 0};
    const int plate = scene.add_mesh(test::floor_mesh(0.2f, 8), 0.3f);
    test::Random random{2};
    for (int i = 0; i < 500; ++i)
      scene.add({random.between(-0.1f, 0.1f), random.between(0.001f, 0.1f), random.between(-0.1f, 0.1f)});
    float height = 0;
    for (int s = 0; s < 200; ++s) {
      height += speed * scene.radius;
      scene.move(plate, {{0, height, 0}, {0, 0, 0, 1}});
      scene.step();
    }
    for (std::size_t i = 0; i < scene.positions.size(); ++i) {
      EXPECT_GT(scene.x(i).y, height) << speed;
      EXPECT_LT(std::fabs(scene.x(i).x), 0.11f);
    }
  }
}

TEST(Contact, NoShotPassesFacesEdgesOrVertices) {
  MeshData needles = test::icosphere_mesh(0.1f, 1); // stretched to slivers
  for (Vec3<float> &v : needles.vertices) v = {v.x, 0.02f * v.y, 3 * v.z};
  std::size_t hits = 0;
  for (const MeshData &mesh : {test::box_mesh({0.05f, 0.05f, 0.05f}), test::icosphere_mesh(0.06f, 3), needles}) {
    const TriangleMesh clean = make_triangle_mesh(mesh.view(), "mesh");
    const WindingNumber winding(clean);
    for (const bool solve : {true, false}) {
      ContactScene scene;
      scene.solve = solve;
      scene.gravity = {0, 0, 0};
      scene.add_mesh(mesh, 0.3f);
      test::Random random{13};
      std::vector<int> inside;
      const std::size_t shots = 17000; // six times: over 1e5
      while (scene.positions.size() < shots) {
        // At a vertex, a point of an edge, or a point of a face; straight, slanting, or grazing.
        const std::size_t t = std::size_t(random.uniform() * double(clean.indices.size() / 3));
        const Vec3<float> a = clean.vertices[clean.indices[3 * t]], b = clean.vertices[clean.indices[3 * t + 1]],
                          c = clean.vertices[clean.indices[3 * t + 2]];
        const float kind = float(random.uniform()), u = float(random.uniform()), w = float(random.uniform());
        const Vec3<float> target = kind < 0.2f ? a : kind < 0.6f ? a + u * (b - a) : a + u * (b - a) + (1 - u) * w * (c - a);
        const Vec3<float> direction = random.direction();
        const Vec3<float> from = target - random.between(0.0006f, 0.025f) * direction;
        if (winding.distance(from, 1) < 1.01f * scene.margin()) continue;
        scene.add(from, (scene.radius / scene.substep) * direction);
        inside.push_back(winding.exactly_at({from.x, from.y, from.z}) > 0.5 ? 1 : 0);
      }
      for (int s = 0; s < 4; ++s) {
        scene.step();
        for (Row &row : scene.velocities) { // pressed on at full speed
          const float speed = std::max(1e-6f, length(xyz(row)));
          const float scale = scene.radius / scene.substep / speed;
          row = {scale * row.x, scale * row.y, scale * row.z, row.w};
        }
      }
      for (std::size_t i = 0; i < shots; ++i) {
        const Vec3<float> p = scene.x(i);
        EXPECT_EQ(winding.exactly_at({p.x, p.y, p.z}) > 0.5 ? 1 : 0, inside[i]) << i;
        EXPECT_GT(winding.distance(p, 1), 0.98f * scene.margin()) << i;
      }
      hits += std::size_t(scene.contact_count);
    }
  }
  EXPECT_GT(hits, 10000u);
}

// Whether the segment from p to q meets the triangle, in double precision: the signs of the volumes that it spans with the edges.
bool crosses(Vec3<float> p, Vec3<float> q, const BvhTriangle &t) {
  const auto widen = [](Vec3<float> v) { return Vec3<double>{v.x, v.y, v.z}; };
  const auto volume = [](Vec3<double> a, Vec3<double> b, Vec3<double> c, Vec3<double> d) {
    return dot(cross(b - a, c - a), d - a);
  };
  const Vec3<double> a = widen(t.a), b = widen(t.b), c = widen(t.c), from = widen(p), to = widen(q);
  if ((volume(a, b, c, from) > 0) == (volume(a, b, c, to) > 0)) return false;
  const bool ab = volume(from, to, a, b) > 0, bc = volume(from, to, b, c) > 0, ca = volume(from, to, c, a) > 0;
  return ab == bc && bc == ca;
}

TEST(Contact, NothingCrossesASoupOfOpenAndSliverTriangles) {
  test::Random random{21};
  MeshData soup;
  for (int t = 0; t < 200; ++t) {
    const auto base = std::uint32_t(soup.vertices.size());
    const Vec3<float> from = random.in_box(0.1f), along = 0.1f * random.direction();
    soup.vertices.insert(soup.vertices.end(),
                         {from, from + along, from + 0.5f * along + random.between(1e-6f, 0.05f) * random.direction()});
    soup.triangle(base, base + 1, base + 2);
    if (t % 10 == 0) soup.triangle(base, base + 1, base > 2 ? base - 1 : base + 2); // shared, and non-manifold with it
  }
  const BoundingVolumeHierarchy hierarchy = build_bounding_volume_hierarchy(make_triangle_mesh(soup.view(), "mesh"));
  ContactScene scene;
  scene.add_mesh(soup, 0.3f);
  scene.gravity = {0, 0, 0};
  for (int i = 0; i < 200; ++i) scene.add(random.in_box(0.1f), (scene.radius / scene.substep) * random.direction());
  std::size_t turned = 0;
  for (int s = 0; s < 200; ++s) {
    const std::vector<Row> before = scene.positions, speeds = scene.velocities;
    scene.step();
    for (std::size_t i = 0; i < before.size(); ++i) {
      ASSERT_TRUE(is_finite(scene.x(i)));
      for (const BvhTriangle &t : hierarchy.triangles) ASSERT_FALSE(crosses(xyz(before[i]), scene.x(i), t)) << s << " " << i;
      turned += length(scene.v(i) - xyz(speeds[i])) > 1e-3f ? 1 : 0;
      const Vec3<float> fresh = (scene.radius / scene.substep) * random.direction(); // and on, in any direction
      if (s % 5 == 4) scene.velocities[i] = {fresh.x, fresh.y, fresh.z, 1000.0f};
    }
  }
  EXPECT_GT(turned, 1000u);
}

TEST(Contact, TheOrderOfTheRecordsChangesNothing) {
  const auto run = [](bool backwards) {
    ContactScene scene;
    scene.backwards = backwards;
    scene.add_mesh(test::icosphere_mesh(0.1f, 2), 0.4f);
    scene.add_plane(0.4f, {{0, -0.05f, 0}, {0, 0, 0, 1}});
    test::Random random{3};
    for (int i = 0; i < 200; ++i) scene.add(0.08f * random.direction(), 3.0f * random.direction());
    for (int s = 0; s < 300; ++s) scene.step();
    return scene.positions;
  };
  const std::vector<Row> first = run(false), second = run(true);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].x, second[i].x);
    EXPECT_EQ(first[i].y, second[i].y);
    EXPECT_EQ(first[i].z, second[i].z);
  }
}

} // namespace
} // namespace loam
