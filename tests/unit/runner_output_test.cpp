// What a run writes: PLY, PNG, CSV and JSON, and folders that cannot be written to.
#include <cstring>

#include <gtest/gtest.h>

#include "output_folder.h"
#include "picture/image.h"
#include "ply_writer.h"
#include "progress_bar.h"
#include "run_statistics.h"
#include "runner_temporary_folder.h"

namespace {

TEST(RunnerPly, HoldsEveryParticleInThirtyTwoBytes) {
  runner::Particles particles;
  for (std::uint32_t i = 0; i < 5; ++i) {
    particles.ids.push_back(10 + i);
    particles.positions.push_back({static_cast<float>(i), 2, 3});
    particles.velocities.push_back({4, 5, 6});
    particles.materials.push_back(i % 2);
  }
  const std::string file = runner::make_ply(particles, "a comment");
  const std::string end = "end_header\n";
  const std::size_t body = file.find(end) + end.size();
  EXPECT_EQ(file.substr(0, 4), "ply\n");
  EXPECT_NE(file.find("element vertex 5\n"), std::string::npos);
  ASSERT_EQ(file.size(), body + 5 * 32);
  float x = 0;
  std::uint32_t id = 0;
  std::memcpy(&x, file.data() + body + 3 * 32, 4);
  std::memcpy(&id, file.data() + body + 3 * 32 + 24, 4);
  EXPECT_EQ(x, 3.0f);
  EXPECT_EQ(id, 13u);
}

TEST(RunnerPng, StartsAndEndsAsAPngDoes) {
  const std::string file = runner::make_png({4, 2, std::vector<std::uint8_t>(24, 128)});
  EXPECT_EQ(file.substr(1, 3), "PNG");
  EXPECT_EQ(file.substr(file.size() - 8, 4), "IEND");
}

TEST(RunnerOutputFolder, MakesParentsAndLeavesOnlyWholeFiles) {
  const TemporaryFolder folder;
  const runner::OutputFolder output(folder.path() / "a" / "b");
  output.write("x.txt", "hello");
  EXPECT_EQ(std::filesystem::file_size(folder.path() / "a" / "b" / "x.txt"), 5u);
  const auto files = std::filesystem::directory_iterator(folder.path() / "a" / "b");
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST(RunnerOutputFolder, NamesPathAndReason) {
  const TemporaryFolder folder;
  const auto file = folder.write("taken", "a file");
  const std::string message = error_text([&] { runner::OutputFolder output(file); });
  EXPECT_NE(message.find("taken"), std::string::npos) << message;
  const std::string below = error_text([&] { runner::OutputFolder output(file / "below"); });
  EXPECT_NE(below.find("Not a directory"), std::string::npos) << below;
  EXPECT_NE(error_text([] { runner::OutputFolder output("/proc/loam-run"); }).find("/proc/loam-run"), std::string::npos);
}

TEST(RunnerOutputFolder, ReportsAFileThatCannotBeReplaced) {
  const TemporaryFolder folder;
  const runner::OutputFolder output(folder.path());
  std::filesystem::create_directories(folder.path() / "x.txt" / "full");
  const std::string message = error_text([&] { output.write("x.txt", "hello"); });
  EXPECT_NE(message.find("x.txt"), std::string::npos) << message;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "x.txt.partial"));
}

TEST(RunnerStatistics, SumsStagesByName) {
  runner::RunStatistics run;
  loam_stage stage{};
  std::strcpy(stage.name, "solve sand");
  stage.seconds = 0.5;
  stage.items = 10;
  run.add_stages({stage});
  run.add_stages({stage});
  ASSERT_EQ(run.stages.size(), 1u);
  EXPECT_EQ(run.stages[0].items, 20u);
  EXPECT_DOUBLE_EQ(run.stages[0].seconds, 1.0);
}

TEST(RunnerStatistics, WritesARowForEachFrameAndTheHashInHexadecimal) {
  runner::RunStatistics run;
  run.state_hash = 0xabc;
  run.has_sides = true;
  for (std::uint64_t frame = 1; frame <= 3; ++frame) {
    runner::FrameRecord record;
    record.frame = frame;
    record.outside = frame;
    record.statistics.pair_visits = 100;
    record.statistics.strain_limited = 2;
    record.statistics.stiffness_share = frame == 2 ? 0.5 : 1;
    run.frames.push_back(record);
  }
  run.step_seconds = 2;
  const std::string csv = runner::make_series_csv(run);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
  const std::string json = runner::make_statistics_json(runner::Scene(), run);
  EXPECT_NE(json.find("\"state_hash\": \"0000000000000abc\""), std::string::npos) << json;
  EXPECT_NE(json.find("\"pair_visits\": 300"), std::string::npos) << json;
  EXPECT_NE(json.find("\"pair_visits_per_second\": 150.0"), std::string::npos) << json;
  EXPECT_NE(json.find("\"strain_limited\": 6"), std::string::npos) << json;
  EXPECT_NE(json.find("\"least_stiffness_share\": 0.5"), std::string::npos) << "the softest frame" << json;
  EXPECT_NE(json.find("\"outside_colliders\": 3"), std::string::npos) << json;
}

TEST(RunnerProgressBar, FormatsDurations) {
  EXPECT_EQ(runner::format_duration(0), "0:00");
  EXPECT_EQ(runner::format_duration(245), "4:05");
  EXPECT_EQ(runner::format_duration(3723), "1:02:03");
}

} // namespace
