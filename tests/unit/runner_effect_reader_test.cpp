// Streams, fields, killers and hinges in scene files.
#include <gtest/gtest.h>

#include "runner_temporary_folder.h"
#include "scene_reader.h"
#include "simulation.h"

namespace {

const std::string sand = "[world]\nkernel_radius = 0.02\nsubsteps = 2\n"                                 // lines 1 to 3
                         "[[materials]]\nname = \"sand\"\nlaw = \"drucker_prager\"\n"                    // lines 4 to 6
                         "friction_angle_degrees = 30\n"                                                 // line 7
                         "[[emitters]]\nmaterial = \"sand\"\n"                                           // lines 8 and 9
                         "nozzle = { kind = \"disc\", center = [0, 1, 0], radius = 0.05 }\nspeed = 2\n"; // lines 10 and 11

std::string error_of(const std::string &text) {
  const TemporaryFolder folder;
  const auto path = folder.write("scene.toml", text);
  return error_text([&] {
    runner::Scene scene = runner::read_scene(path);
    scene.world.backend = LOAM_BACKEND_CPU;
    runner::Simulation simulation(scene);
    for (int frame = 0; frame < 12; ++frame) simulation.step();
  });
}

void expect_mentions(const std::string &message, const std::vector<std::string> &parts) {
  for (const std::string &part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
}

std::string changed(std::string text, const std::string &from, const std::string &to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos);
  return text.replace(at, from.size(), to);
}

TEST(RunnerEffectReader, AStreamGetsTheCapacityThatItNeeds) {
  const TemporaryFolder folder;
  runner::Scene scene = runner::read_scene(folder.write("scene.toml", sand + "[time]\nframes = 20\n"));
  scene.world.backend = LOAM_BACKEND_CPU;
  runner::Simulation simulation(scene);
  EXPECT_EQ(simulation.particle_count(), 0u);
  for (int frame = 0; frame < 20; ++frame) simulation.step();
  const runner::Particles particles = simulation.read_particles();
  EXPECT_GT(particles.count(), 500u); // 33 layers of 21
  EXPECT_EQ(particles.emitters.back(), 0u);
  expect_mentions(error_of(changed(sand, "kernel_radius", "particle_capacity = 100\nkernel_radius")),
                  {"scene.toml", "found no room", "is 100 and would have to be"});
  EXPECT_EQ(error_of(changed(sand, "kernel_radius", "particle_capacity = 100\nkernel_radius") + "when_full = \"drop\"\n"),
            "");
  EXPECT_EQ(error_of(changed(sand, "kernel_radius", "particle_capacity = 250\nkernel_radius") +
                     "[[killers]]\nkind = \"age\"\nage = 0.05\n"),
            "");
}

TEST(RunnerEffectReader, AHingeTurnsByWhatFallsOnIt) {
  const TemporaryFolder folder;
  runner::Scene scene = runner::read_scene(folder.write(
      "scene.toml", sand + "[[colliders]]\nkind = \"box\"\nhalf_extents = [0.2, 0.01, 0.1]\nposition = [0.15, 0.8, 0]\n"
                           "hinge = { axis = [0, 0, 2], inertia = 0.05, damping = 0.01 }\n"));
  scene.world.backend = LOAM_BACKEND_CPU;
  runner::Simulation simulation(scene);
  for (int frame = 0; frame < 20; ++frame) simulation.step();
  const runner::SceneCollider &box = scene.colliders[0];
  EXPECT_GT(box.motions.back().spin, 0.05); // down on its left side
  EXPECT_GT(runner::pose_at(box.pose, box.motions, 1).rotation[2], 0.005f);
  EXPECT_FLOAT_EQ(runner::pose_at(box.pose, box.motions, 1).position.y, 0.8f);
}

TEST(RunnerEffectReader, MistakesAreNamed) {
  expect_mentions(error_of(changed(sand, "radius = 0.05", "radius = -1")), {"scene.toml:8", "radius is -1"});
  expect_mentions(error_of(changed(sand, ", radius = 0.05", "")), {"scene.toml:10", "emitters[0].nozzle", "radius"});
  expect_mentions(error_of(changed(sand, "\"disc\"", "\"disk\"")), {"scene.toml:10", "disk", "disc"});
  expect_mentions(error_of(sand + "velocity = [0, 1, 0]\n"), {"scene.toml:12", "velocity", "unknown key"});
  expect_mentions(error_of(sand + "region = { kind = \"sphere\", radius = 1 }\n"), {"scene.toml:12", "nozzle", "not both"});
  expect_mentions(error_of(sand + "band_height = 1\nband_colour = [1, 1, 1]\n"), {"scene.toml:12", "band_height"});
  expect_mentions(error_of(sand + "flow = 1e9\n"), {"scene.toml:8", "flow is 1e+09", "carries at most"});

  expect_mentions(error_of(sand + "[[fields]]\nvelocity = [1, 0, 0]\n"), {"scene.toml:12", "fields[0]", "kind"});
  expect_mentions(error_of(sand + "[[fields]]\nkind = \"wind\"\nrate = -1\n"), {"scene.toml:12", "rate is -1"});
  expect_mentions(error_of(sand + "[[fields]]\nkind = \"wind\"\nspeed = 1\n"), {"scene.toml:14", "speed", "unknown key"});
  expect_mentions(error_of(sand + "[[fields]]\nkind = \"blast\"\nspeed = 1\n"), {"scene.toml:12", "radius"});
  expect_mentions(error_of(sand + "[[fields]]\nkind = \"attractor\"\nstrength = 1\n"), {"scene.toml:12", "softening"});

  expect_mentions(error_of(sand + "[[killers]]\nkind = \"age\"\n"), {"scene.toml:12", "killers[0]", "age"});
  expect_mentions(error_of(sand + "[[killers]]\nkind = \"age\"\nage = 0\n"), {"scene.toml:12", "age is 0"});
  expect_mentions(error_of(sand + "[[killers]]\nkind = \"sphere\"\nradius = 1\nmaterial = \"snow\"\n"),
                  {"scene.toml:15", "no material is named \"snow\""});
  expect_mentions(error_of(sand + "[[killers]]\nkind = \"sphere\"\nradius = 1\noutside = 1\n"),
                  {"scene.toml:15", "true or false"});

  const std::string box = sand + "[[colliders]]\nkind = \"box\"\nhalf_extents = [1, 1, 1]\nposition = [0, -5, 0]\n";
  EXPECT_EQ(error_of(box + "restitution = 0.5\nstick = 10\n"), "");
  expect_mentions(error_of(box + "restitution = 2\n"), {"scene.toml:12", "restitution is 2"});
  expect_mentions(error_of(box + "stick = -1\n"), {"scene.toml:12", "stick is -1"});
  expect_mentions(error_of(box + "hinge = { }\n"), {"scene.toml:16", "inertia"});
  expect_mentions(error_of(box + "hinge = { inertia = 0 }\n"), {"scene.toml:16", "inertia", "over 0"});
  expect_mentions(error_of(box + "hinge = { inertia = 1, axis = [0, 0, 0] }\n"), {"scene.toml:16", "axis"});
  expect_mentions(error_of(box + "hinge = { inertia = 1, damping = -1 }\n"), {"scene.toml:16", "damping"});
  expect_mentions(error_of(box + "hinge = { inertia = 1 }\nmotions = [{ velocity = [1, 0, 0] }]\n"),
                  {"scene.toml:16", "hinge"});
  expect_mentions(error_of(sand + "[[colliders]]\nkind = \"plane\"\nhinge = { inertia = 1 }\n"), {"scene.toml:14", "plane"});
}

} // namespace
