/* Ids: index, generation and world. A stale one is recognised, never taken for another object. */
#include <gtest/gtest.h>
#include <set>
#include <string>

#include "scene/slot_table.h"

namespace loam {
namespace {

using Table = SlotTable<int>;

/* "" where the id is good, otherwise the message. */
std::string refusal(const Table &table, std::uint64_t id) {
  try {
    (void)table.at(id, "thing");
    return "";
  } catch (const Error &error) {
    EXPECT_EQ(error.status(), LOAM_ERROR_INVALID_HANDLE);
    return error.what();
  }
}

TEST(SlotTable, AddFindRemove) {
  Table table(IdKind::material, "thing", 7, 10);
  const std::uint64_t a = table.add(1), b = table.add(2);
  EXPECT_NE(a, 0u);
  EXPECT_NE(a, b);
  EXPECT_EQ(table.at(a, "a"), 1);
  EXPECT_EQ(table.at(b, "b"), 2);
  EXPECT_EQ(table.index_of(b, "b"), 1u);
  table.remove(a, "a");
  EXPECT_EQ(table.at_index(0), nullptr);
  EXPECT_EQ(*table.at_index(1), 2);
  EXPECT_NE(refusal(table, a).find("stale"), std::string::npos);
}

TEST(SlotTable, AFreedSlotIsUsedAgainUnderAnotherId) {
  Table table(IdKind::material, "thing", 7, 1);
  const std::uint64_t first = table.add(1);
  table.remove(first, "first");
  EXPECT_NE(table.next_id(), first);
  const std::uint64_t second = table.next_id();
  EXPECT_EQ(table.add(2), second);
  EXPECT_EQ(first & 0xffffffffu, second & 0xffffffffu);
  EXPECT_NE(refusal(table, first), "");
  EXPECT_EQ(table.at(second, "second"), 2);
}

TEST(SlotTable, NullForeignAndInventedIdsAreNamedForWhatTheyAre) {
  Table table(IdKind::material, "thing", 7, 10), other(IdKind::material, "thing", 8, 10);
  const std::uint64_t id = table.add(1), foreign = other.add(1);
  EXPECT_NE(refusal(table, 0).find("null"), std::string::npos);
  EXPECT_NE(refusal(table, foreign).find("not of this world"), std::string::npos);
  EXPECT_NE(refusal(table, id + 1).find("never given out"), std::string::npos);
  EXPECT_NE(refusal(table, id + (std::uint64_t(1) << 32)).find("never given out"), std::string::npos);
  EXPECT_NE(refusal(table, ~std::uint64_t(0)), "");
}

TEST(SlotTable, AnIdOfAnotherKindIsRefused) {
  Table materials(IdKind::material, "material", 7, 10), colliders(IdKind::collider, "collider", 7, 10);
  const std::uint64_t material = materials.add(1), collider = colliders.add(1);
  EXPECT_NE(material, collider);
  EXPECT_NE(refusal(colliders, material).find("another kind"), std::string::npos);
  EXPECT_NE(refusal(materials, collider).find("another kind"), std::string::npos);
  EXPECT_EQ(refusal(materials, material), "");
}

TEST(SlotTable, TheGreatestTagAndTheLowestAreToldApart) {
  Table lowest(IdKind::material, "thing", 1, 10), greatest(IdKind::material, "thing", Table::greatest_tag, 10);
  EXPECT_NE(refusal(greatest, lowest.add(1)).find("not of this world"), std::string::npos);
  EXPECT_NE(refusal(lowest, greatest.add(1)).find("not of this world"), std::string::npos);
}

TEST(SlotTable, IsFullAtItsCapacity) {
  Table table(IdKind::material, "thing", 7, 3);
  for (int k = 0; k < 3; ++k) table.add(k);
  try {
    table.add(3);
    FAIL() << "no room was left";
  } catch (const Error &error) {
    EXPECT_EQ(error.status(), LOAM_ERROR_CAPACITY);
    EXPECT_NE(std::string(error.what()).find("3"), std::string::npos);
  }
}

TEST(SlotTable, AnIdNeverComesBackHoweverOftenItsSlotIsUsed) {
  Table table(IdKind::material, "thing", 7, 2);
  std::set<std::uint64_t> seen;
  for (int k = 0; k < 70000; ++k) { // past the 16 bits of a generation
    const std::uint64_t id = table.add(k);
    ASSERT_TRUE(seen.insert(id).second) << k;
    table.remove(id, "id");
  }
  for (const std::uint64_t id : seen) ASSERT_NE(refusal(table, id).find("stale"), std::string::npos);
}

} // namespace
} // namespace loam
