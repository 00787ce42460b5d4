// The bytes of a snapshot. All numbers are little-endian and lie anywhere.
//
//   header     "LOAMSNAP", version, byte order, bytes of all, checksum, bytes of the fields, number of sections, particles
//   fields     what the scene has to say, see scene/world_snapshot.cpp
//   sections   kind, object, count, columns; then column by column
//                number of values   0: the column's words follow, one an element
//                values             of a column with 1 to 256 of them; followed, if there are several, by a byte for each element
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <vector>

#include <loam/snapshot.h>

#include "scene/error.h"
#include "solver/state_section.h"

namespace loam {

static_assert(std::endian::native == std::endian::little, "snapshots are little-endian");

// Throws Error INVALID_SNAPSHOT: "the snapshot" and this text.
[[noreturn]] void invalid_snapshot(const std::string &text);

// Of `bytes` bytes, as if the header's own field for it were 0. A change that stays within 8 bytes always changes it.
std::uint64_t snapshot_checksum(const std::byte *memory, std::uint64_t bytes);

struct SnapshotHeader {
  char magic[8];
  std::uint32_t version, byte_order;
  std::uint64_t bytes, checksum;
  std::uint64_t field_bytes, particles;
  std::uint32_t sections, reserved;
};
static_assert(sizeof(SnapshotHeader) == 56);

// Up to 256 different words, numbered as they come.
class WordTable {
public:
  static constexpr int most = 256;
  WordTable() { slots_.fill(-1); }
  // Its number; -1 if there is no room for one more.
  int index_of(std::uint32_t word) {
    if (last_ >= 0 && words_[static_cast<std::size_t>(last_)] == word) return last_;
    std::uint32_t at = (word * 0x9E3779B1u) >> (32 - bits);
    while (slots_[at] >= 0 && words_[static_cast<std::size_t>(slots_[at])] != word) at = (at + 1) & ((1u << bits) - 1);
    if (slots_[at] < 0) {
      if (count_ == most) return -1;
      words_[static_cast<std::size_t>(count_)] = word;
      slots_[at] = static_cast<std::int16_t>(count_++);
    }
    return last_ = slots_[at];
  }
  int count() const { return count_; }
  const std::uint32_t *words() const { return words_.data(); }

private:
  static constexpr int bits = 10;
  std::array<std::uint32_t, most> words_;
  std::array<std::int16_t, 1u << bits> slots_;
  int count_ = 0, last_ = -1;
};

// Reads `count` elements of a section, from `first` on, to where the host can read them.
using ReadSection =
    std::function<void(const StateSection &section, std::uint64_t first, std::size_t count, std::uint32_t *words)>;

// Writes to `memory`, or without it only counts the bytes: those that it would write, or the most that may be, without looking at the elements.
class SnapshotWriter {
public:
  enum class Mode { write, count, bound };
  explicit SnapshotWriter(Mode mode, std::byte *memory = nullptr) : mode_(mode), memory_(memory) {}
  template <class T> void put(const T &value) { put(&value, sizeof value); }
  void put(const void *from, std::size_t bytes) {
    if (mode_ == Mode::write) std::memcpy(memory_ + bytes_, from, bytes);
    bytes_ += bytes;
  }
  void section(const StateSection &section, const ReadSection &read);
  // Puts the header where it belongs, with what is known now.
  void finish(SnapshotHeader header);
  std::uint64_t bytes() const { return bytes_; }

private:
  Mode mode_;
  std::byte *memory_;
  std::uint64_t bytes_ = 0;
};

// A snapshot that is whole. Every access stays within its bytes, whatever they are.
class SnapshotReader {
public:
  // Throws Error INVALID_SNAPSHOT.
  SnapshotReader(const std::byte *memory, std::uint64_t bytes);

  struct Column {
    const std::byte *values, *indices; // `indices`: a byte each; null where there is only one value
    std::uint32_t value_count;         // 0: `values` has a word for each element
    std::uint32_t at(std::uint64_t i) const {
      const std::uint64_t place = value_count == 0 ? i : indices == nullptr ? 0 : static_cast<std::uint64_t>(indices[i]);
      std::uint32_t word;
      std::memcpy(&word, values + 4 * place, 4);
      return word;
    }
  };
  struct Section {
    StateKind kind;
    std::uint32_t object;
    std::uint64_t count;
    std::vector<Column> columns;
    bool is_zero() const;
  };
  std::uint64_t particles() const { return header_.particles; }
  const std::vector<Section> &sections() const { return sections_; }
  const Section *find(StateKind kind, std::uint32_t object) const;

  // The next of the fields.
  template <class T> T take() {
    T value;
    take(&value, sizeof value);
    return value;
  }
  void take(void *to, std::size_t bytes);
  // After the last.
  void end_fields() const;

private:
  void read_section();

  SnapshotHeader header_;
  const std::byte *at_, *end_; // of what is to be read: first sections, then fields
  std::vector<Section> sections_;
};

} // namespace loam
