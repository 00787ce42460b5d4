/* Snapshots that were damaged: every bit, every length, thousands at random, and thousands whose checksum was forged to fit. None may crash, none that is
 * refused may change the world, and what is accepted can be stepped. */
#include <gtest/gtest.h>

#include "support/cloths.h"
#include "support/forged_snapshot.h"
#include "support/hooks.h"

namespace loam {
namespace {

using snapshots::Bytes;

/* Sand and snow on a plane, a sheet that hangs from it, a stream, a blast that is still to come, and a killer of old particles. */
class DamagedSnapshot : public testing::Test {
protected:
  DamagedSnapshot() : world_(definition()) {
    const loam_material_id material = world_.add(scenes::jittered_block(scenes::sand(), 8));
    scenes::Scene other = scenes::jittered_block(scenes::plasticine(), 8);
    other.planes.clear();
    world_.add(other);
    const cloths::Grid grid(3, 3, 0.02f);
    const cloths::Cloth cloth(world_.get(), cloths::definition(grid));
    cloth.attach({0});
    loam_emitter_def emitter;
    scenes::require(loam_emitter_def_default(&emitter, sizeof emitter), "default");
    emitter.material = material;
    emitter.position[1] = 0.2f;
    emitter.radius = 0.008f;
    emitter.speed = 20;
    emitter.when_full = LOAM_FULL_DROP;
    loam_emitter_id nozzle = 0;
    scenes::require(loam_emitter_create(world_.get(), &emitter, &nozzle), "emitter");
    loam_field_def blast;
    scenes::require(loam_field_def_default(&blast, sizeof blast), "default");
    blast.kind = LOAM_FIELD_BLAST;
    blast.speed = blast.radius = 1;
    blast.time = 0.002f;
    loam_field_id field = 0;
    scenes::require(loam_field_create(world_.get(), &blast, &field), "field");
    loam_killer_def age;
    scenes::require(loam_killer_def_default(&age, sizeof age), "default");
    age.kind = LOAM_KILLER_AGE;
    age.age = 0.01f;
    loam_killer_id killer = 0;
    scenes::require(loam_killer_create(world_.get(), &age, &killer), "killer");
    world_.step(1e-3f);
    saved_ = snapshots::save(world_.get());
    hash_ = world_.state_hash();
  }
  static loam_world_def definition() {
    loam_world_def def = cloths::world_def(2, 2);
    def.particle_capacity = 32;
    return def;
  }
  loam_status restore(const Bytes &bytes) { return loam_snapshot_restore(world_.get(), bytes.data(), bytes.size()); }
  void expect_unchanged() {
    EXPECT_EQ(world_.state_hash(), hash_);
    EXPECT_EQ(snapshots::save(world_.get()), saved_);
  }
  std::uint64_t next() { return (random_ = random_ * 6364136223846793005u + 1442695040888963407u) >> 33; }
  /* One to eight changes of bytes. */
  Bytes damaged(std::size_t from) {
    Bytes bytes = saved_;
    for (std::uint64_t k = 1 + next() % 8; k > 0; --k) {
      const std::size_t at = from + next() % (bytes.size() - from);
      switch (next() % 3) {
      case 0:
        bytes[at] = static_cast<std::byte>(next());
        break;
      case 1:
        bytes[at] ^= static_cast<std::byte>(1u << (next() % 8));
        break;
      default:
        for (std::size_t i = at; i < std::min(at + 4, bytes.size()); ++i) bytes[i] = std::byte{0xFF};
      }
    }
    return bytes;
  }

  scenes::World world_;
  Bytes saved_;
  std::uint64_t hash_ = 0, random_ = 1;
};

TEST_F(DamagedSnapshot, EveryBitIsGuarded) {
  Bytes bytes = saved_;
  for (std::size_t at = 0; at < bytes.size(); ++at)
    for (unsigned bit = 0; bit < 8; ++bit) {
      bytes[at] ^= static_cast<std::byte>(1u << bit);
      ASSERT_EQ(restore(bytes), LOAM_ERROR_INVALID_SNAPSHOT) << "bit " << bit << " of byte " << at;
      bytes[at] ^= static_cast<std::byte>(1u << bit);
    }
  expect_unchanged();
  RecordProperty("bits", std::to_string(8 * bytes.size()));
}

TEST_F(DamagedSnapshot, EveryOtherLengthIsRefused) {
  for (std::size_t size = 0; size < saved_.size(); ++size)
    ASSERT_EQ(loam_snapshot_restore(world_.get(), saved_.data(), size), LOAM_ERROR_INVALID_SNAPSHOT) << size;
  Bytes longer = saved_;
  for (int k = 0; k < 64; ++k) {
    longer.push_back(static_cast<std::byte>(next()));
    ASSERT_EQ(restore(longer), LOAM_ERROR_INVALID_SNAPSHOT) << k;
  }
  expect_unchanged();
}

TEST_F(DamagedSnapshot, RandomDamageIsRefused) {
  for (int k = 0; k < 5000; ++k) {
    const Bytes bytes = damaged(0);
    if (bytes == saved_) continue;
    ASSERT_EQ(restore(bytes), LOAM_ERROR_INVALID_SNAPSHOT) << k;
  }
  expect_unchanged();
}

TEST_F(DamagedSnapshot, AForgedChecksumDoesNotHelp) {
  const int tries = hooks::short_run() ? 1000 : 5000;
  int refused = 0, accepted = 0;
  for (int k = 0; k < tries; ++k) {
    Bytes bytes = damaged(k % 4 == 0 ? 0 : sizeof(SnapshotHeader));
    if (k % 5 == 0) bytes.resize(next() % (bytes.size() + 1));
    snapshots::forge(bytes);
    const loam_status status = restore(bytes);
    if (status == LOAM_OK) {
      ++accepted;
      ASSERT_EQ(loam_world_step(world_.get(), 1e-3f), LOAM_OK) << loam_last_error();
      snapshots::restore(world_.get(), saved_);
    } else {
      ++refused;
      ASSERT_TRUE(status == LOAM_ERROR_INVALID_SNAPSHOT || status == LOAM_ERROR_SNAPSHOT_MISMATCH)
          << scenes::outcome(status);
    }
    if (k % 16 == 0) expect_unchanged();
  }
  expect_unchanged();
  EXPECT_GT(refused, tries / 20); /* both happen */
  EXPECT_GT(accepted, tries / 20);
}

} // namespace
} // namespace loam
