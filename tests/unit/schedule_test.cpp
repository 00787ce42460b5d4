/* The schedule holds what the scene calls for and nothing else. */
#include <algorithm>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "schedule/schedule.h"

namespace loam {
namespace {

std::vector<std::string> names(const SceneContents &contents) {
  Schedule schedule;
  schedule.compile(contents);
  std::vector<std::string> result;
  for (const Stage &stage : schedule.stages()) result.push_back(stage.name);
  return result;
}
bool has(const std::vector<std::string> &list, const std::string &name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

TEST(Schedule, AnEmptySceneHasNoEffects) {
  const std::vector<std::string> list = names({});
  for (const char *effect : {"contacts", "find contacts", "final contacts", "position correction", "velocity smoothing"})
    EXPECT_FALSE(has(list, effect)) << effect;
  for (const std::string &name : list) EXPECT_EQ(name.rfind("solve", 0), std::string::npos);
}

TEST(Schedule, EachEffectBringsItsStagesInTheOrderOfExecution) {
  const std::vector<std::string> list = names({{{"sand", true}, {"clay", false}, {"rubber", true}}, true, true, {true}});
  const std::vector<std::string> expected = {"sort",
                                             "neighbour search",
                                             "visit order",
                                             "gradients",
                                             "forces",
                                             "find contacts",
                                             "solve sand",
                                             "solve rubber",
                                             "position correction",
                                             "contacts",
                                             "velocity smoothing",
                                             "speed limit",
                                             "final contacts",
                                             "strain sand",
                                             "strain rubber",
                                             "advance",
                                             "statistics"};
  EXPECT_EQ(list, expected);
}

TEST(Schedule, AWarmStartIsAStageBeforeTheSolve) {
  SceneContents contents = {{{"rubber", true}}, false, false, {}};
  EXPECT_FALSE(has(names(contents), "warm start"));
  contents.warm_start = true;
  const std::vector<std::string> list = names(contents);
  EXPECT_LT(std::find(list.begin(), list.end(), "warm start"), std::find(list.begin(), list.end(), "solve rubber"));
}

TEST(Schedule, AMaterialWithoutParticlesHasNoStage) {
  Schedule schedule;
  schedule.compile({{{"sand", true}, {"clay", false}}, false, false, {}});
  ASSERT_EQ(schedule.solve.size(), 2u);
  EXPECT_GE(schedule.solve[0], 0);
  EXPECT_EQ(schedule.solve[1], -1);
  EXPECT_EQ(schedule.strain[1], -1);
  EXPECT_EQ(schedule.contacts, -1);
}

TEST(Schedule, RecordsAddUpUntilTheNextStep) {
  Schedule schedule;
  schedule.compile({});
  schedule.record(schedule.sort, 0.5, 10);
  schedule.record(schedule.sort, 0.25, 5);
  EXPECT_EQ(schedule.stages()[std::size_t(schedule.sort)].seconds, 0.75);
  EXPECT_EQ(schedule.stages()[std::size_t(schedule.sort)].items, 15u);
  schedule.begin_step();
  EXPECT_EQ(schedule.stages()[std::size_t(schedule.sort)].items, 0u);
}

} // namespace
} // namespace loam
