// Scene files: what is read, and errors that name file, line and key.
#include <cmath>
#include <numbers>

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
  expect_mentions(scene_error(minimal + "color = 3\n"), {"scene.toml:12:", "emitters[0].color", "unknown key"});
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

const std::string press = minimal +
                          "[[colliders]]\n"                                                                     // line 12
                          "kind = \"box\"\n"                                                                    // line 13
                          "half_extents = [0.1, 0.2, 0.3]\n"                                                    // line 14
                          "position = [0, 1, 0]\n"                                                              // line 15
                          "motions = [{ start = 1, stop = 3, velocity = [0, -2, 0] },\n"                        // line 16
                          "           { stop = 0.5, spin_axis = [0, 0, 2], spin_degrees_per_second = 180 }]\n"; // line 17

TEST(RunnerSceneReader, ReadsABoxAndItsMotions) {
  const TemporaryFolder folder;
  const runner::Scene scene = runner::read_scene(folder.write("scene.toml", press));
  ASSERT_EQ(scene.colliders.size(), 1u);
  const runner::SceneCollider &box = scene.colliders[0];
  EXPECT_EQ(box.kind, static_cast<uint32_t>(LOAM_COLLIDER_BOX));
  EXPECT_EQ(box.half_extents.z, 0.3f);
  EXPECT_EQ(scene.meshes.at(box.file).triangle_count(), 12u);
  ASSERT_EQ(box.motions.size(), 2u);
  const runner::Pose pose = runner::pose_at(box.pose, box.motions, 2);
  EXPECT_FLOAT_EQ(pose.position.y, -1) << "two metres a second from 1 s to 2 s";
  EXPECT_NEAR(pose.rotation[2], std::sin(std::numbers::pi / 4), 1e-6)
      << "half a second of half a turn a second: a quarter turn";
  EXPECT_NEAR(pose.rotation[3], std::cos(std::numbers::pi / 4), 1e-6);
}

TEST(RunnerSceneReader, RefusesMotionsAndBoxesThatCannotBe) {
  expect_mentions(scene_error(replaced(press, "stop = 3", "stop = 1")),
                  {"scene.toml:16:", "colliders[0].motions[0].stop", "later than start"});
  expect_mentions(scene_error(replaced(press, "start = 1", "start = -1")),
                  {"scene.toml:16:", "motions[0].start", "0 or more"});
  expect_mentions(scene_error(replaced(press, "[0, 0, 2]", "[0, 0, 0]")), {"scene.toml:17:", "motions[1].spin_axis"});
  expect_mentions(scene_error(replaced(press, "velocity", "velocty")),
                  {"scene.toml:16:", "colliders[0].motions[0].velocty", "unknown key"});
  expect_mentions(scene_error(replaced(press, "[0.1, 0.2, 0.3]", "[0.1, 0, 0.3]")), {"scene.toml:14:", "half_extents"});
  expect_mentions(scene_error(replaced(press, "half_extents = [0.1, 0.2, 0.3]\n", "")), {"scene.toml:12:", "half_extents"});
  expect_mentions(scene_error(press + "appearance = \"glass\"\n"), {"scene.toml:18:", "appearance", "glass"});
  expect_mentions(scene_error(minimal + "[[colliders]]\nkind = \"plane\"\nmotions = [{ velocity = [0, 1, 0] }]\n"),
                  {"scene.toml:14:", "motions", "plane"});
  expect_mentions(scene_error(minimal + "[[colliders]]\nkind = \"plane\"\nappearance = \"glass\"\n"),
                  {"scene.toml:14:", "\"glass\"", "\"tiles\""});
}

TEST(RunnerSceneReader, ReadsSolidsOfEveryKind) {
  const TemporaryFolder folder;
  folder.write("solid.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 2\n");
  const auto with = [](const std::string &lines) { return minimal + "[[colliders]]\n" + lines; }; // from line 13 on
  const auto read = [&](const std::string &lines) { return runner::read_scene(folder.write("scene.toml", with(lines))); };
  runner::Scene scene = read("kind = \"capsule\"\nradius = 0.1\nhalf_height = 0.2\n");
  EXPECT_EQ(scene.colliders[0].kind, static_cast<uint32_t>(LOAM_COLLIDER_CAPSULE));
  EXPECT_EQ(scene.colliders[0].half_height, 0.2f);
  scene = read("kind = \"sphere\"\nradius = 0.1\n");
  EXPECT_GT(scene.meshes.at(scene.colliders[0].file).triangle_count(), 1000u) << "to be looked at";
  scene = read("kind = \"hull\"\nfile = \"solid.obj\"\n");
  EXPECT_EQ(scene.colliders[0].kind, static_cast<uint32_t>(LOAM_COLLIDER_HULL));
  scene = read("kind = \"grid\"\nfile = \"solid.obj\"\nspacing = 0.05\n");
  EXPECT_GT(scene.colliders[0].field.size[0], 20u);
  EXPECT_NEAR(scene.colliders[0].field.at({0.2, 0.2, 0.1}), -0.1, 0.01);
  const auto error = [&](const std::string &lines) { return error_text([&] { read(lines); }); };
  expect_mentions(error("kind = \"sphere\"\n"), {"scene.toml:12:", "radius"});
  expect_mentions(error("kind = \"sphere\"\nradius = 0\n"), {"scene.toml:14:", "radius", "over 0"});
  expect_mentions(error("kind = \"capsule\"\nradius = 1\nhalf_height = -1\n"), {"scene.toml:15:", "half_height"});
  expect_mentions(error("kind = \"grid\"\nfile = \"solid.obj\"\nspacing = -1\n"), {"scene.toml:15:", "spacing"});
  expect_mentions(error("kind = \"grid\"\nfile = \"solid.obj\"\nspacing = 1e-5\n"), {"scene.toml:14:", "file", "2^26"});
  expect_mentions(error("kind = \"grid\"\nfile = \"open.obj\"\nspacing = 0.1\n"), {"scene.toml:14:", "file", "not closed"});
}

TEST(RunnerSceneReader, ReadsDeformationsOfMeshes) {
  const TemporaryFolder folder;
  folder.write("solid.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const std::string soft =
      minimal +
      "[[colliders]]\nkind = \"mesh\"\nfile = \"solid.obj\"\n" // from line 12 on
      "deformations = [{ kind = \"squash\", amplitude = 0.3, period = 2, start = 1, axis = [0, 0, 3] },\n"
      "                { kind = \"wave\", amplitude = 0.1, period = 1, wavelength = 0.5, direction = [0, 2, 0] }]\n";
  const auto read = [&](const std::string &text) { return runner::read_scene(folder.write("scene.toml", text)); };
  const runner::Scene scene = read(soft);
  const std::vector<runner::Deformation> &found = scene.colliders[0].deformations;
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].kind, runner::Deformation::Kind::squash);
  EXPECT_EQ(found[0].axis.z, 1.0f);
  EXPECT_EQ(found[0].start, 1.0);
  EXPECT_EQ(found[1].kind, runner::Deformation::Kind::wave);
  EXPECT_EQ(found[1].direction.y, 1.0f);
  EXPECT_EQ(found[1].wavelength, 0.5f);
  const auto error = [&](const std::string &from, const std::string &to) {
    return error_text([&] { read(replaced(soft, from, to)); });
  };
  expect_mentions(error("amplitude = 0.3", "amplitude = 1"), {"scene.toml:15:", "deformations[0].amplitude", "0.9"});
  expect_mentions(error("period = 2", "period = 0"), {"scene.toml:15:", "deformations[0].period", "over 0"});
  expect_mentions(error("[0, 0, 3]", "[0, 0, 0]"), {"scene.toml:15:", "deformations[0].axis"});
  expect_mentions(error(", wavelength = 0.5", ""), {"scene.toml:16:", "wavelength"});
  expect_mentions(error("\"squash\"", "\"squish\""), {"scene.toml:15:", "\"twist\""});
  expect_mentions(error("kind = \"mesh\"", "kind = \"hull\""), {"deformations", "only a mesh"});
  expect_mentions(error_text([&] { read(soft + "appearance = \"glass\"\n"); }), {"appearance", "glass"});
}

TEST(RunnerSceneReader, AnEmitterHasTheColourOfItsMaterialUnlessItHasItsOwn) {
  const TemporaryFolder folder;
  const std::string coloured =
      replaced(minimal, "name = \"sand\"", "name = \"sand\"\nlook = \"glossy\"\ncolour = [0.1, 0.2, 0.3]");
  const runner::Scene scene = runner::read_scene(folder.write(
      "scene.toml", coloured + "[[emitters]]\nmaterial = \"sand\"\nregion = { kind = \"sphere\", radius = 0.1 }\n"
                               "colour = [0.5, 0.6, 0.7]\n"));
  EXPECT_EQ(scene.materials[0].look, runner::Look::glossy);
  EXPECT_FLOAT_EQ(scene.emitters[0].colour.y, 0.2f);
  EXPECT_FLOAT_EQ(scene.emitters[1].colour.y, 0.6f);
  expect_mentions(scene_error(coloured + "band_colour = [1, 1, 1]\nband_height = 0.05\n"), {"scene.toml:15:", "\"grains\""});
  expect_mentions(scene_error(minimal + "band_height = 0.1\n"), {"scene.toml:12:", "band_height", "band_colour"});
  expect_mentions(scene_error(minimal + "band_colour = [1, 1, 1]\nband_height = -1\n"), {"scene.toml:13:", "band_height"});
}

// Every scene that the project ships can be read, with all the meshes it names.
TEST(RunnerSceneReader, ReadsEveryScene) {
  int scenes = 0;
  for (const auto &entry : std::filesystem::directory_iterator(std::string(LOAM_SOURCE_DIR) + "/samples/scenes")) {
    if (!entry.is_directory()) continue;
    const std::filesystem::path file = entry.path() / "scene.toml";
    if (!std::filesystem::exists(file)) continue;
    ++scenes;
    EXPECT_EQ(error_text([&] { EXPECT_TRUE(runner::read_scene(file).camera.has_value()); }), "") << file;
  }
  EXPECT_GE(scenes, 1);
}

std::string of_material(const std::string &lines) {
  return replaced(minimal, "law = \"drucker_prager\"\nfriction_angle_degrees = 30\n", lines);
}

loam_material_def material_of(const std::string &lines) {
  const TemporaryFolder folder;
  return runner::read_scene(folder.write("scene.toml", of_material(lines))).materials[0].def;
}

TEST(RunnerSceneReader, TakesAPresetAndWhatItOverrides) {
  loam_material_def preset{};
  ASSERT_EQ(loam_material_def_preset("packed snow", &preset, sizeof preset), LOAM_OK);
  const loam_material_def def = material_of("preset = \"packed snow\"\nyoungs_modulus = 3e5\n");
  EXPECT_EQ(def.law, static_cast<uint32_t>(LOAM_LAW_NACC));
  EXPECT_EQ(def.cohesion_ratio, preset.cohesion_ratio);
  EXPECT_FLOAT_EQ(def.youngs_modulus, 3e5f);
  EXPECT_STREQ(def.name, "sand") << "the scene's name for it";
}

TEST(RunnerSceneReader, RefusesUnknownPresetsAndNumbersOfOtherLaws) {
  expect_mentions(scene_error(of_material("preset = \"packed sno\"\n")),
                  {"scene.toml:6:", "materials[0].preset", "packed sno", "toothpaste"});
  expect_mentions(scene_error(of_material("preset = \"candy\"\nlaw = \"nacc\"\n")), {"scene.toml:7:", "materials[0].law"});
  expect_mentions(scene_error(of_material("preset = \"candy\"\nyield_stress = 3\n")),
                  {"scene.toml:7:", "yield_stress", "unknown key", "cohesion_ratio"});
  EXPECT_EQ(material_of("law = \"fluid\"\ndensity = 900\n").density, 900.0f);
  EXPECT_EQ(material_of("preset = \"water\"\nviscosity = 3\n").viscosity, 3.0f);
  EXPECT_EQ(material_of("preset = \"water\"\nsurface_tension = 0.07\n").surface_tension, 0.07f);
  EXPECT_EQ(material_of("preset = \"water\"\nvorticity_confinement = 0.5\n").vorticity_confinement, 0.5f);
  EXPECT_EQ(material_of("preset = \"water\"\nadhesion = 20\n").adhesion, 20.0f);
  expect_mentions(scene_error(of_material("preset = \"candy\"\nviscosity = 3\n")),
                  {"scene.toml:7:", "viscosity", "unknown key"});
  expect_mentions(scene_error(of_material("preset = \"water\"\nyoungs_modulus = 1e6\n")),
                  {"scene.toml:7:", "youngs_modulus", "unknown key", "density"});
}

TEST(RunnerSceneReader, FindsNumbersFromWhatADesignerKnows) {
  const loam_material_def sand = material_of("law = \"drucker_prager\"\nangle_of_repose_degrees = 34.7\n"
                                             "density = 1600\nsinking = { height = 0.5, by = 0.002 }\n");
  EXPECT_NEAR(sand.friction_angle * 180 / std::numbers::pi, 30, 0.1);
  EXPECT_NEAR(sand.youngs_modulus, 1600 * 9.81 * 0.5 * 0.5 / (2 * 0.002), 1e3);
  const loam_material_def clay = material_of("law = \"von_mises\"\ndensity = 1000\nstands_to_height = 0.3\n");
  EXPECT_NEAR(clay.yield_stress, 1000 * 9.81 * 0.3, 1);
  const loam_material_def paint = material_of(
      "law = \"herschel_bulkley\"\ndensity = 1200\nflow_exponent = 1\npuddle = { volume = 0.001, radius = 0.15 }\n"
      "film = { thickness = 0.01, slope_degrees = 90, speed = 0.1 }\n");
  const double yield = 225 * 1200 * 9.81 * 1e-6 / (128 * std::pow(std::numbers::pi, 2) * std::pow(0.15, 5));
  EXPECT_NEAR(paint.shear_yield_stress, yield, 0.01 * yield);
  const double sheared = 0.01 - yield / (1200 * 9.81);
  EXPECT_NEAR(paint.consistency, 1200 * 9.81 * sheared * sheared / (2 * 0.1), 0.5);
  const loam_material_def candy = material_of("law = \"nacc\"\nstrengths = { compressive = 2e4, tensile = 1e4, "
                                              "friction_angle_degrees = 40, opening = 0.002 }\n");
  EXPECT_NEAR(candy.cohesion_ratio, 0.5, 1e-6);
  EXPECT_LT(candy.consolidation, 0);
}

TEST(RunnerSceneReader, RefusesTwoAnswersToOneQuestionAndImpossibleOnes) {
  expect_mentions(scene_error(of_material("law = \"von_mises\"\nyield_stress = 3\nstands_to_height = 1\n")),
                  {"scene.toml:8:", "stands_to_height", "yield_stress"});
  expect_mentions(scene_error(of_material("law = \"von_mises\"\nstands_to_height = -1\n")),
                  {"scene.toml:7:", "stands_to_height", "-1"});
  expect_mentions(scene_error(of_material("law = \"elastic\"\nsinking = { height = 1 }\n")),
                  {"scene.toml:7:", "materials[0].sinking.by", "missing"});
  expect_mentions(scene_error(of_material("law = \"herschel_bulkley\"\nshear_yield_stress = 1e5\n"
                                          "film = { thickness = 0.01, slope_degrees = 45, speed = 1 }\n")),
                  {"scene.toml:8:", "materials[0].film"});
}

TEST(RunnerSceneReader, TakesCharactersBeyondAsciiInStringsAndCommentsOnly) {
  const std::string strings = "title = \"D\u00fcne \\\" \u00fc\" # \u00fc\n";
  EXPECT_EQ(scene_error(strings + minimal), "");
  expect_mentions(scene_error(minimal + "\ufeffx = 1\n"), {"scene.toml:12:"});
  expect_mentions(scene_error(strings + "a = \"b\" \u00fc\n" + minimal), {"scene.toml:2:"});
}

TEST(RunnerSceneReader, RefusesNumbersThatSinglePrecisionDoesNotHold) {
  expect_mentions(scene_error("[world]\ngravity = [0, 1e300, 0]\n"), {"scene.toml:2", "world.gravity", "1e+300"});
}

TEST(RunnerSceneReader, ReadsContactsAndRefusesThoseOfNobody) {
  const std::string two = minimal + "[[materials]]\nname = \"rubber\"\nlaw = \"elastic\"\n" // line 12
                                    "[[contacts]]\n"                                        // line 15
                                    "materials = [\"sand\", \"rubber\"]\nfriction = 0.4\n"; // line 16
  const TemporaryFolder folder;
  const runner::Scene scene = runner::read_scene(folder.write("scene.toml", two));
  ASSERT_EQ(scene.contacts.size(), 1u);
  EXPECT_EQ(scene.contacts[0].materials[1], "rubber");
  EXPECT_FLOAT_EQ(scene.contacts[0].friction, 0.4f);
  expect_mentions(scene_error(replaced(two, "\"sand\", \"rubber\"]", "\"sand\", \"ruber\"]")),
                  {"scene.toml:16:", "contacts[0].materials", "ruber"});
  expect_mentions(scene_error(replaced(two, ", \"rubber\"]", "]")), {"scene.toml:16:", "two materials"});
  expect_mentions(scene_error(replaced(two, ", \"rubber\"]", ", \"sand\"]")), {"scene.toml:16:", "twice"});
  expect_mentions(scene_error(replaced(two, ", \"rubber\"]", ", 3]")), {"scene.toml:16:", "string"});
  expect_mentions(scene_error(replaced(two, "friction = 0.4", "frction = 0.4")), {"scene.toml:17:", "unknown key"});
}

const std::string hammock = "[[colliders]]\nname = \"bar\"\nkind = \"sphere\"\nradius = 0.1\n" // line 1
                            "[[cloths]]\n"                                                     // line 5
                            "grid = { columns = 4, rows = 2, spacing = 0.5 }\n"
                            "stretch_stiffness = 500\n"
                            "wind = { velocity = [1, 2, 3], drag = 0.5 }\n"
                            "attachments = [{ low = [-2, 0, -2], high = [-0.9, 0, 2], collider = \"bar\", release = 3 },\n"
                            "               { low = [0.9, 0, -2], high = [2, 0, 2], compliance = 0.1 }]\n"
                            "self_distance = 0.6\n"
                            "self_friction = 0.2\n";

TEST(RunnerSceneReader, ReadsClothsAndWhatHoldsThem) {
  const TemporaryFolder folder;
  const runner::Scene scene = runner::read_scene(folder.write("scene.toml", hammock));
  ASSERT_EQ(scene.cloths.size(), 1u);
  const runner::SceneCloth &cloth = scene.cloths[0];
  EXPECT_EQ(scene.meshes.at(cloth.file).triangle_count(), 16u);
  EXPECT_EQ(cloth.def.stretch_stiffness, 500.0f);
  EXPECT_EQ(cloth.def.self_distance, 0.6f);
  EXPECT_EQ(cloth.def.self_friction, 0.2f);
  EXPECT_EQ(cloth.wind_velocity.z, 3.0f);
  EXPECT_EQ(cloth.drag, 0.5f);
  ASSERT_EQ(cloth.attachments.size(), 2u);
  EXPECT_EQ(cloth.attachments[0].vertices, (std::vector<std::uint32_t>{0, 5, 10}));
  EXPECT_EQ(cloth.attachments[0].collider, std::optional<std::size_t>(0));
  EXPECT_EQ(cloth.attachments[0].release, 3);
  EXPECT_EQ(cloth.attachments[1].vertices, (std::vector<std::uint32_t>{4, 9, 14}));
  EXPECT_FALSE(cloth.attachments[1].collider.has_value());
  folder.write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string meshed_text =
      replaced(hammock, "grid = { columns = 4, rows = 2, spacing = 0.5 }", "file = \"sheet.obj\"");
  const runner::Scene meshed =
      runner::read_scene(folder.write("scene.toml", meshed_text.substr(0, meshed_text.find("attachments"))));
  EXPECT_EQ(meshed.meshes.at(meshed.cloths[0].file).vertices.size(), 3u);
}

TEST(RunnerSceneReader, RefusesClothsThatCannotBe) {
  const auto error = [](const std::string &from, const std::string &to) { return scene_error(replaced(hammock, from, to)); };
  expect_mentions(error("grid = { columns = 4, rows = 2, spacing = 0.5 }\n", ""),
                  {"scene.toml:5:", "mesh (file) or a grid"});
  expect_mentions(error("stretch_st", "file = \"a.obj\"\nstretch_st"), {"cloths[0].file", "mesh (file) or a grid"});
  expect_mentions(error("columns = 4", "columns = 0"), {"scene.toml:6:", "grid.columns", "1 and 2000"});
  expect_mentions(error(", rows = 2", ""), {"scene.toml:6:", "rows", "missing"});
  expect_mentions(error("0.5 }", "-1 }"), {"scene.toml:6:", "spacing", "over 0"});
  expect_mentions(error("stretch_stiffness", "strech_stiffness"),
                  {"scene.toml:7:", "cloths[0].strech_stiffness", "unknown"});
  expect_mentions(error("drag", "drg"), {"scene.toml:8:", "wind.drg", "unknown key"});
  expect_mentions(error("[-0.9, 0, 2]", "[-3, 0, 2]"), {"scene.toml:9:", "attachments[0].low", "no vertex"});
  expect_mentions(error("collider = \"bar\"", "collider = \"bra\""), {"scene.toml:9:", "no collider", "bra"});
  expect_mentions(error("release = 3", "release = -3"), {"scene.toml:9:", "release", "0 or more"});
  expect_mentions(error("low = [0.9, 0, -2], ", ""), {"scene.toml:10:", "attachments[1].low", "missing"});
  expect_mentions(scene_error(hammock + "[[colliders]]\nname = \"bar\"\nkind = \"plane\"\n"),
                  {"scene.toml:14:", "colliders[1].name", "already"});
}

} // namespace
