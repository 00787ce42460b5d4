#include "scene/snapshot_format.h"

#include <algorithm>

namespace loam {

namespace {

constexpr std::size_t checksum_at = offsetof(SnapshotHeader, checksum);

std::uint64_t load(const std::byte *from) {
  std::uint64_t word;
  std::memcpy(&word, from, sizeof word);
  return word;
}

// Either argument decides the result alone if the other stays: no single word is lost.
std::uint64_t mix(std::uint64_t lane, std::uint64_t word) {
  lane = (lane ^ word) * 0x9E3779B97F4A7C15ull;
  return lane << 29 | lane >> 35;
}

} // namespace

void invalid_snapshot(const std::string &text) { throw Error(LOAM_ERROR_INVALID_SNAPSHOT, "the snapshot " + text); }

std::uint64_t snapshot_checksum(const std::byte *memory, std::uint64_t bytes) {
  std::byte header[sizeof(SnapshotHeader)] = {};
  const std::uint64_t head = std::min<std::uint64_t>(bytes, sizeof header);
  std::memcpy(header, memory, head);
  std::memset(header + checksum_at, 0, sizeof(std::uint64_t));
  std::uint64_t lanes[4] = {bytes, 0x243F6A8885A308D3ull, 0x13198A2E03707344ull, 0xA4093822299F31D0ull};
  for (std::size_t i = 0; i < sizeof header; i += 8) lanes[0] = mix(lanes[0], load(header + i));
  std::uint64_t i = head;
  for (; i + 32 <= bytes; i += 32)
    for (unsigned k = 0; k < 4; ++k) lanes[k] = mix(lanes[k], load(memory + i + 8 * k));
  for (; i < bytes; i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, memory + i, std::min<std::uint64_t>(8, bytes - i));
    lanes[1] = mix(lanes[1], word);
  }
  std::uint64_t sum = 0;
  for (const std::uint64_t lane : lanes) sum = mix(sum, lane);
  return sum ^ sum >> 32;
}

// ------------------------------------------------------------------------------------------------------- writing ---

void SnapshotWriter::section(const StateSection &section, const ReadSection &read) {
  constexpr std::size_t chunk_words = 8192, most_columns = 8;
  const std::uint32_t columns = section.saved, stride = section.stride;
  if (mode_ == Mode::bound) {
    bytes_ += 20 + columns * (4 + 4 * (WordTable::most + section.count));
    return;
  }
  const std::size_t chunk = chunk_words / stride;
  std::uint32_t words[chunk_words];
  const auto for_each_chunk = [&](auto &&body) {
    for (std::uint64_t first = 0; first < section.count; first += chunk) {
      const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(chunk, section.count - first));
      read(section, first, count, words);
      body(first, count);
    }
  };

  // Which columns have few values, and which.
  std::vector<WordTable> tables(section.few_values != 0 ? columns : 0);
  std::uint32_t tabled = section.count > 0 ? section.few_values : 0;
  if (tabled != 0)
    for_each_chunk([&](std::uint64_t, std::size_t count) {
      for (std::uint32_t c = 0; c < columns; ++c)
        for (std::size_t i = 0; i < count && (tabled >> c & 1u) != 0; ++i)
          if (tables[c].index_of(words[i * stride + c]) < 0) tabled &= ~(1u << c);
    });

  put(section.kind);
  put(section.object);
  put(section.count);
  put(columns);
  std::uint64_t starts[most_columns]; // of the elements' part of each column
  for (std::uint32_t c = 0; c < columns; ++c) {
    const bool has_table = (tabled >> c & 1u) != 0;
    const auto values = static_cast<std::uint32_t>(has_table ? tables[c].count() : 0);
    put(values);
    if (has_table) put(tables[c].words(), 4 * std::size_t(values));
    starts[c] = bytes_;
    bytes_ += section.count * (values == 0 ? 4 : values == 1 ? 0 : 1);
  }
  if (mode_ == Mode::count) return;
  for_each_chunk([&](std::uint64_t first, std::size_t count) {
    for (std::uint32_t c = 0; c < columns; ++c) {
      if ((tabled >> c & 1u) == 0) {
        std::byte *to = memory_ + starts[c] + 4 * first;
        for (std::size_t i = 0; i < count; ++i) std::memcpy(to + 4 * i, &words[i * stride + c], 4);
      } else if (tables[c].count() > 1) {
        std::byte *to = memory_ + starts[c] + first;
        for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<std::byte>(tables[c].index_of(words[i * stride + c]));
      }
    }
  });
}

void SnapshotWriter::finish(SnapshotHeader header) {
  if (mode_ != Mode::write) return;
  header.bytes = bytes_;
  std::memcpy(memory_, &header, sizeof header);
  header.checksum = snapshot_checksum(memory_, bytes_);
  std::memcpy(memory_, &header, sizeof header);
}

// ------------------------------------------------------------------------------------------------------- reading ---

SnapshotReader::SnapshotReader(const std::byte *memory, std::uint64_t bytes) {
  if (bytes < sizeof header_)
    invalid_snapshot(format("has %llu bytes, fewer than its header", static_cast<unsigned long long>(bytes)));
  std::memcpy(&header_, memory, sizeof header_);
  if (std::memcmp(header_.magic, "LOAMSNAP", 8) != 0) invalid_snapshot("does not begin with LOAMSNAP");
  if (header_.byte_order != 0x01020304u) invalid_snapshot("is damaged: its byte order is none");
  if (header_.version != LOAM_SNAPSHOT_VERSION)
    invalid_snapshot(
        format("is of version %u; this library reads version %u", header_.version, unsigned(LOAM_SNAPSHOT_VERSION)));
  if (header_.bytes != bytes)
    invalid_snapshot(format("was saved with %llu bytes, and has %llu", static_cast<unsigned long long>(header_.bytes),
                            static_cast<unsigned long long>(bytes)));
  if (header_.checksum != snapshot_checksum(memory, bytes)) invalid_snapshot("is damaged: its checksum differs");
  // What follows can only be wrong in bytes that were made to fit the checksum.
  const std::byte *fields = memory + sizeof header_, *end = memory + bytes;
  if (header_.field_bytes > bytes - sizeof header_) invalid_snapshot("has fields beyond its end");
  at_ = fields + header_.field_bytes;
  end_ = end;
  for (std::uint32_t s = 0; s < header_.sections; ++s) read_section();
  if (at_ != end) invalid_snapshot("has bytes behind its last section");
  at_ = fields;
  end_ = fields + header_.field_bytes;
}

void SnapshotReader::read_section() {
  Section section;
  section.kind = take<StateKind>();
  section.object = take<std::uint32_t>();
  section.count = take<std::uint64_t>();
  const auto columns = take<std::uint32_t>();
  if (section.count > std::uint64_t(1) << 32 || columns > 8) invalid_snapshot("has a section of impossible size");
  const auto skip = [&](std::uint64_t bytes) {
    if (bytes > static_cast<std::uint64_t>(end_ - at_)) invalid_snapshot("has a section beyond its end");
    const std::byte *from = at_;
    at_ += bytes;
    return from;
  };
  for (std::uint32_t c = 0; c < columns; ++c) {
    Column column = {};
    column.value_count = take<std::uint32_t>();
    if (column.value_count > WordTable::most) invalid_snapshot("has a column of too many values");
    column.values = skip(4 * (column.value_count == 0 ? section.count : column.value_count));
    if (column.value_count > 1) {
      column.indices = skip(section.count);
      for (std::uint64_t i = 0; i < section.count; ++i)
        if (static_cast<std::uint32_t>(column.indices[i]) >= column.value_count)
          invalid_snapshot("has an index beyond its values");
    }
    section.columns.push_back(column);
  }
  if (find(section.kind, section.object) != nullptr) invalid_snapshot("has a section twice");
  sections_.push_back(std::move(section));
}

bool SnapshotReader::Section::is_zero() const {
  return std::all_of(columns.begin(), columns.end(), [&](const Column &column) {
    for (std::uint64_t i = 0; i < count; ++i)
      if (column.at(i) != 0) return false;
    return true;
  });
}

const SnapshotReader::Section *SnapshotReader::find(StateKind kind, std::uint32_t object) const {
  for (const Section &section : sections_)
    if (section.kind == kind && section.object == object) return &section;
  return nullptr;
}

void SnapshotReader::take(void *to, std::size_t bytes) {
  if (bytes > static_cast<std::size_t>(end_ - at_)) invalid_snapshot("ends too early");
  std::memcpy(to, at_, bytes);
  at_ += bytes;
}

void SnapshotReader::end_fields() const {
  if (at_ != end_) invalid_snapshot("has more fields than this version reads");
}

} // namespace loam
