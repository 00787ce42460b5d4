// Scene files: what is read, and errors that name file, line and key.
#include <cmath>

#include <gtest/gtest.h>

#include "runner_temporary_folder.h"
#include "scene_reader.h"

namespace {

const std::string minimal = "[world]\n"                                                           // line 1
                            "kernel_radius = 0.02\n"                                              // line 2
                            "\n"                                                                  // line 3
                            "[[materials]]\n"                                                     // line 4
                            "name = \"sand\"\n"                                                   // line 5
                            "law = \"drucker_prager\"\n"                                          // line 6
                            "friction_angle_degrees = 30\n"                                       // line 7
                            "\n"                                                                  // line 8
                            "[[emitters]]\n"                                                      // line 9
                            "material = \"sand\"\n"                                               // line 10
                            "region = { kind = \"sphere\", radius = 0.1, center = [0, 1, 0] }\n"; // line 11

std::string replaced(std::string text, const std::string &from, const std::string &to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos);
  return text.replace(at, from.size(), to);
}

std::string scene_error(const std::string &text) {
  const TemporaryFolder folder;
  const auto path = folder.write("scene.toml", text);
  return error_text([&] { runner::read_scene(path); });
}

void expect_mentions(const std::string &message, const std::vector<std::string> &parts) {
  for (const std::string &part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
}

TEST(RunnerSceneReader, ReadsAMinimalScene) {
  const TemporaryFolder folder;
  const runner::Scene scene = runner::read_scene(folder.write("scene.toml", minimal));
  EXPECT_FLOAT_EQ(scene.world.kernel_radius, 0.02f);
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].def.law, static_cast<uint32_t>(LOAM_LAW_DRUCKER_PRAGER));
  EXPECT_NEAR(scene.materials[0].def.friction_angle, 0.5235988f, 1e-6f);
  EXPECT_STREQ(scene.materials[0].def.name, "sand");
  ASSERT_EQ(scene.emitters.size(), 1u);
  EXPECT_FLOAT_EQ(scene.emitters[0].region.radius, 0.1f);
  EXPECT_EQ(scene.emitters[0].place.line, 9u);
  EXPECT_FALSE(scene.camera.has_value());
}

TEST(RunnerSceneReader, ReadsTheHourglass) {
  const runner::Scene scene = runner::read_scene(std::string(LOAM_SOURCE_DIR) + "/samples/scenes/hourglass/scene.toml");
  EXPECT_EQ(scene.colliders.size(), 2u);
  EXPECT_EQ(scene.meshes.size(), 1u) << "emitter and collider name the same file";
  EXPECT_GT(scene.meshes.begin()->second.triangle_count(), 2000u);
  EXPECT_TRUE(scene.watch.has_value());
  EXPECT_TRUE(scene.camera.has_value());
}

TEST(RunnerSceneReader, NamesAnUnknownKeyAndItsLine) {
  expect_mentions(scene_error(replaced(minimal, "kernel_radius", "kernel_radios")),
                  {"scene.toml:2:", "world.kernel_radios", "unknown key"});
  expect_mentions(scene_error(minimal + "colour = 3\n"), {"scene.toml:12:", "emitters[0].colour", "unknown key"});
  expect_mentions(scene_error(replaced(minimal, "radius = 0.1", "radius = 0.1, rotatoin_degrees = 3")),
                  {"scene.toml:11:", "emitters[0].region.rotatoin_degrees"});
  expect_mentions(scene_error("colour = 1\n" + minimal), {"scene.toml:1:", "colour"});
}

TEST(RunnerSceneReader, NamesAWrongTypeAndItsLine) {
  expect_mentions(scene_error(replaced(minimal, "0.02", "\"small\"")),
                  {"scene.toml:2:", "world.kernel_radius", "number", "string"});
  expect_mentions(scene_error(replaced(minimal, "= 30", "= [30]")),
                  {"scene.toml:7:", "materials[0].friction_angle_degrees", "array"});
  expect_mentions(scene_error(replaced(minimal, "[0, 1, 0]", "[0, 1]")),
                  {"scene.toml:11:", "emitters[0].region.center", "three"});
  expect_mentions(scene_error(replaced(minimal, "kernel_radius = 0.02", "substeps = 2.5")),
                  {"scene.toml:2:", "world.substeps", "integer"});
  expect_mentions(scene_error(replaced(minimal, "0.02", "nan")), {"scene.toml:2:", "finite"});
  expect_mentions(scene_error(replaced(minimal, "[world]", "[[world]]")), {"scene.toml:1:", "world", "table"});
}

TEST(RunnerSceneReader, NamesWhatIsMissingOrUnknownByName) {
  expect_mentions(scene_error(replaced(minimal, "law = \"drucker_prager\"\n", "")),
                  {"scene.toml:4:", "materials[0].law", "missing"});
  expect_mentions(scene_error(replaced(minimal, "drucker_prager", "druker_prager")),
                  {"scene.toml:6:", "\"druker_prager\"", "\"drucker_prager\"", "\"elastic\""});
  expect_mentions(scene_error(replaced(minimal, "material = \"sand\"", "material = \"snow\"")), {"scene.toml:10:", "snow"});
  expect_mentions(scene_error("[world]\n"), {"material"});
}

TEST(RunnerSceneReader, NamesASyntaxErrorWithLine) {
  expect_mentions(scene_error("[world]\nsubsteps = = 3\n"), {"scene.toml:2:"});
}

TEST(RunnerSceneReader, NamesAMissingSceneAndAMissingMesh) {
  expect_mentions(error_text([] { runner::read_scene("/nowhere/scene.toml"); }), {"/nowhere/scene.toml", "no such"});
  expect_mentions(scene_error(minimal + "[[colliders]]\nkind = \"mesh\"\nfile = \"absent.obj\"\n"),
                  {"scene.toml:14:", "colliders[0].file", "absent.obj", "No such file"});
}

TEST(RunnerSceneReader, ScalesTheNumberOfParticles) {
  const TemporaryFolder folder;
  runner::Scene scene = runner::read_scene(
      folder.write("scene.toml", replaced(minimal, "[world]", "[world]\nsubsteps = 10") + "inset = 0.01\n"));
  runner::scale_particle_count(scene, 8);
  EXPECT_FLOAT_EQ(scene.world.kernel_radius, 0.01f);
  EXPECT_EQ(scene.world.substeps, 20u);
  EXPECT_FLOAT_EQ(scene.emitters[0].def.inset, 0.005f);
  EXPECT_FLOAT_EQ(scene.emitters[0].region.radius, 0.1f) << "the scene keeps its size";
}

} // namespace
