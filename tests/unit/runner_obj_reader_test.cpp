// OBJ files, good and bad: every error names the file, and the line where there is one.
#include <gtest/gtest.h>

#include "obj_reader.h"
#include "runner_temporary_folder.h"

namespace {

std::string obj_error(const std::string &text) {
  const TemporaryFolder folder;
  const auto path = folder.write("mesh.obj", text);
  return error_text([&] { runner::read_obj(path); });
}

#define EXPECT_MENTIONS(message, part) EXPECT_NE((message).find(part), std::string::npos) << (message)

const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(RunnerObjReader, SplitsPolygonsAndResolvesRelativeIndices) {
  const TemporaryFolder folder;
  const runner::Mesh mesh = runner::read_obj(folder.write("mesh.obj", corners + "f 1 2 3 4\nf -4 -3 -2\n"));
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 0, 1, 2}));
}

TEST(RunnerObjReader, NamesAMissingFile) {
  const std::string message = error_text([] { runner::read_obj("/nowhere/mesh.obj"); });
  EXPECT_MENTIONS(message, "/nowhere/mesh.obj");
  EXPECT_MENTIONS(message, "No such file");
}

TEST(RunnerObjReader, NamesAFolder) {
  EXPECT_MENTIONS(error_text([] { runner::read_obj("/tmp"); }), "folder");
}

TEST(RunnerObjReader, RefusesAnEmptyFile) {
  EXPECT_MENTIONS(obj_error(""), "mesh.obj: the file is empty");
  EXPECT_MENTIONS(obj_error(" \n\n"), "mesh.obj: the file is empty");
}

TEST(RunnerObjReader, RefusesAFileWithoutVerticesOrFaces) {
  EXPECT_MENTIONS(obj_error("# nothing\n"), "no vertices");
  EXPECT_MENTIONS(obj_error(corners), "no faces");
}

TEST(RunnerObjReader, NamesTheFaceWhoseIndexIsOutOfRange) {
  const std::string message = obj_error(corners + "f 1 2 3\nf 1 2 9\n");
  EXPECT_MENTIONS(message, "mesh.obj:6");
  EXPECT_MENTIONS(message, "9");
  EXPECT_MENTIONS(message, "4 vertices");
  EXPECT_NE(obj_error(corners + "f 0 1 2\n"), "");
  EXPECT_NE(obj_error(corners + "f -9 1 2\n"), "");
}

TEST(RunnerObjReader, NamesTheVertexThatIsNotFinite) {
  for (const char *bad : {"nan", "inf", "-inf", "1e300"}) {
    const std::string message = obj_error("v 0 0 0\nv 1 0 0\nv 1 " + std::string(bad) + " 0\nf 1 2 3\n");
    EXPECT_MENTIONS(message, "mesh.obj:3");
    EXPECT_MENTIONS(message, "vertex 3");
  }
}

TEST(RunnerObjReader, NamesTheLineOfWhatIsNoNumberAndOfASmallFace) {
  EXPECT_MENTIONS(obj_error("v 0 0 0\nv 1 zero 0\n"), "mesh.obj:2: vertex 2: y is not a number: \"zero\"");
  EXPECT_MENTIONS(obj_error("v 0 0 0\nv 1 0\n"), "mesh.obj:2: vertex 2: z");
  EXPECT_MENTIONS(obj_error(corners + "f 1 2\n"), "mesh.obj:5: face 1 has 2 corners");
  EXPECT_EQ(obj_error("v +0.5 1e-60 -3e0\nv 1 0 0\nv 1 1 0 # comment\nf 1/1/1 2//2 3\n"), "");
}

TEST(RunnerObjReader, NamesTheCornerThatIsNoVertexNumber) {
  EXPECT_MENTIONS(obj_error(corners + "f 1 2 x/1\n"), "mesh.obj:5: face 1: \"x/1\"");
  EXPECT_MENTIONS(obj_error(corners + "f 1 2 3.5\n"), "\"3.5\"");
  EXPECT_MENTIONS(obj_error(corners + "f 1 2 \\\n 3\n"), "\"\\\"");
  EXPECT_MENTIONS(obj_error(corners + "f 1 2 0\n"), "vertex 0");
  // would be the last vertex if it wrapped around
  EXPECT_MENTIONS(obj_error(corners + "f 1 2 99999999999999999999\n"), "99999999999999999999");
}

TEST(RunnerObjReader, TakesFacesBeforeTheirVertices) { EXPECT_EQ(obj_error("f 1 2 3\n" + corners), ""); }

TEST(RunnerObjReader, RefusesWhatIsNotARegularFile) {
  EXPECT_MENTIONS(error_text([] { runner::read_obj("/dev/zero"); }), "/dev/zero: is not a regular file");
}

TEST(RunnerObjReader, SurvivesNonsense) {
  EXPECT_NE(obj_error("f f f\nv\nv a b c\nf 1/2/3/4 //\n"), "");
  EXPECT_NE(obj_error(std::string(1000, '\xff')), "");
}

} // namespace
