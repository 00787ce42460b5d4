#include "cpu/visit_order.h"

#include <algorithm>
#include <cstring>
#include <functional>

#include "kernels/inelastic/record.h"

namespace loam {

VisitOrder::VisitOrder(const HostAllocator &allocator, int width, unsigned threads)
    : width_(width), threads_(threads), entries_(allocator), group_first_batch_(allocator), group_first_entry_(allocator),
      group_pass_(allocator), group_of_part_(allocator), lane_loads_(allocator), lane_ranks_(allocator), ids_(allocator),
      active_(allocator), offsets_(allocator), step_counts_(allocator), close_steps_(allocator), list_starts_(allocator),
      indices_(allocator), gradients_(allocator), records_(allocator), group_particles_(allocator), found_lists_(allocator) {
}

void VisitOrder::reserve(std::size_t particle_capacity, int material_count, int record_size) {
  record_size_ = record_size;
  list_starts_.reserve(particle_capacity);
  const auto most_passes = static_cast<std::size_t>(27 * material_count);
  passes_.reserve(most_passes);
  pass_sizes_.resize(most_passes);
  parts_.reserve(most_passes * (threads_ + 1));
  groups_of_part_.resize(threads_ + 1);
  material_sizes_.resize(static_cast<std::size_t>(material_count));
}

std::size_t VisitOrder::order_bytes() const {
  return entries_.bytes() + group_first_batch_.bytes() + group_first_entry_.bytes() + group_pass_.bytes() +
         group_of_part_.bytes() + lane_loads_.bytes() + lane_ranks_.bytes() + ids_.bytes() + active_.bytes() +
         offsets_.bytes() + step_counts_.bytes() + close_steps_.bytes() + list_starts_.bytes() + group_particles_.bytes() +
         found_lists_.bytes();
}

namespace {

// A little more than asked for, so that small changes of the scene do not take memory each time.
template <class T> void grow(HostArray<T> &array, std::size_t count) {
  if (count > array.capacity()) array.reserve(count + count / 16 + 64);
}

// The least that a lane of a group has of the largest blocks. With more, lanes are of more equal length, but a group outgrows the cache. Measured.
constexpr std::size_t blocks_per_lane = 2;

// of an entry's key
constexpr int size_bits = 16, largest_size = (1 << size_bits) - 1;

} // namespace

void VisitOrder::list_entries(const CellTable &table) {
  const Colouring &colouring = table.colouring;
  const int w = colouring.block_width, n = colouring.colours_per_axis;
  const int by = table.grid.size[1] / w, bz = table.grid.size[2] / w, blocks = table.grid.size[0] / w * by * bz;
  grow(entries_, static_cast<std::size_t>(std::min<std::int64_t>(
                     table.particle_count, static_cast<std::int64_t>(blocks) * std::max(table.material_count, 1))));
  entry_count_ = 0;
  std::fill(pass_sizes_.begin(), pass_sizes_.end(), PassSize{});
  for (int block = 0; block < blocks; ++block) {
    int total = 0;
    for_each_run(table, block, [&](int first, int last) { total += last - first; });
    if (total == 0) continue;
    const int z = block % bz, y = block / bz % by, x = block / bz / by;
    const int colour = (x % n * n + y % n) * n + z % n;
    const auto add = [&](int material, int size) {
      // Colour first, so that materials of one colour follow each other.
      const auto pass = static_cast<std::uint64_t>(colour) * static_cast<std::uint64_t>(table.material_count) +
                        static_cast<std::uint64_t>(material);
      PassSize &of_pass = pass_sizes_[static_cast<std::size_t>(pass)];
      ++of_pass.blocks;
      of_pass.particles += size;
      entries_[entry_count_++] = {pass, block, material, size, 0};
    };
    if (table.only_material >= 0) {
      add(table.only_material, total);
      continue;
    }
    std::fill(material_sizes_.begin(), material_sizes_.end(), 0);
    for_each_run(table, block, [&](int first, int last) {
      for (int i = first; i < last; ++i) ++material_sizes_[table.materials[i]];
    });
    for (int m = 0; m < table.material_count; ++m)
      if (material_sizes_[static_cast<std::size_t>(m)] > 0) add(m, material_sizes_[static_cast<std::size_t>(m)]);
  }
  // Blocks come in order of place here. A pass is cut where the part's share of the particles is reached.
  for (std::size_t e = 0; e < entry_count_; ++e) {
    Entry &entry = entries_[e];
    PassSize &sizes = pass_sizes_[static_cast<std::size_t>(entry.key)];
    // Not more parts than there are blocks for their lanes.
    const std::int64_t parts = std::min<std::int64_t>(threads_, (sizes.blocks + width_ - 1) / width_);
    const std::int64_t share = (2 * sizes.so_far + entry.size) * parts / (2 * sizes.particles);
    const std::uint64_t part = entry.key * threads_ + static_cast<std::uint64_t>(share);
    sizes.so_far += entry.size;
    entry.key = (part << size_bits) | static_cast<std::uint64_t>(largest_size - std::min(entry.size, largest_size));
  }
  std::sort(entries_.data(), entries_.data() + entry_count_, [](const Entry &a, const Entry &b) {
    return a.key != b.key ? a.key < b.key : a.block < b.block; // no two are equal, so the order does not depend on the sort
  });
}

void VisitOrder::make_groups(Workers &workers, const CellTable &table) {
  const auto materials = static_cast<std::uint64_t>(table.material_count);
  const auto W = static_cast<std::size_t>(width_);
  const std::size_t most = entry_count_ / W + passes_.capacity() * static_cast<std::size_t>(threads_) + 1;
  grow(group_first_batch_, most + 1);
  grow(group_first_entry_, most + 1);
  grow(group_pass_, most);
  grow(group_of_part_, most);
  grow(lane_loads_, most * W);
  grow(lane_ranks_, most * W);
  passes_.clear();
  parts_.clear();
  group_count_ = 0;
  for (std::size_t e = 0; e < entry_count_;) {
    const std::uint64_t pass = (entries_[e].key >> size_bits) / threads_;
    passes_.push_back({entries_[e].material, static_cast<int>(pass / materials), group_count_, group_count_, 0});
    for (std::uint64_t part = pass * threads_; part < (pass + 1) * threads_; ++part) {
      parts_.push_back({e, e, group_count_});
      std::int64_t particles = 0;
      const int largest = e < entry_count_ ? entries_[e].size : 0;
      for (; e < entry_count_ && entries_[e].key >> size_bits == part; ++e) particles += entries_[e].size;
      const std::size_t blocks = e - parts_.back().first_entry;
      parts_.back().last_entry = e;
      if (blocks == 0) continue;
      const std::size_t batches = static_cast<std::size_t>(particles) / W;
      const std::size_t groups = std::clamp(batches / (blocks_per_lane * static_cast<std::size_t>(largest)), std::size_t(1),
                                            std::max(blocks / W, std::size_t(1)));
      for (std::size_t group = 0; group < groups; ++group)
        group_pass_[static_cast<std::size_t>(group_count_++)] = static_cast<int>(passes_.size()) - 1;
      passes_.back().particles += particles;
    }
    parts_.push_back({e, e, group_count_});
    passes_.back().last_group = group_count_;
  }
  workers.loop(static_cast<int>(parts_.size()), [&](int part) {
    if (parts_[static_cast<std::size_t>(part)].last_entry > parts_[static_cast<std::size_t>(part)].first_entry)
      fill_lanes(static_cast<std::size_t>(part));
  });
  std::size_t place = 0;
  for (unsigned part = 0; part < threads_; ++part) {
    groups_of_part_[part] = static_cast<int>(place);
    for (int pass = 0; pass < static_cast<int>(passes_.size()); ++pass)
      for (int group = part_begin(pass, part); group < part_begin(pass, part + 1); ++group) group_of_part_[place++] = group;
  }
  groups_of_part_[threads_] = group_count_;
  batch_count_ = 0;
  for (std::size_t group = 0; group < static_cast<std::size_t>(group_count_); ++group) {
    const int batches = group_first_batch_[group];
    group_first_batch_[group] = batch_count_;
    batch_count_ += batches;
  }
  group_first_batch_[static_cast<std::size_t>(group_count_)] = batch_count_;
  group_first_entry_[static_cast<std::size_t>(group_count_)] = static_cast<int>(entry_count_);
}

// Deals a part's blocks to the lanes of its groups, the largest first, each to the lane with the fewest particles so far; lanes of like length then make
// up a group.
void VisitOrder::fill_lanes(std::size_t part) {
  const auto W = static_cast<std::size_t>(width_);
  const auto first_group = static_cast<std::size_t>(parts_[part].first_group),
             groups = static_cast<std::size_t>(parts_[part + 1].first_group) - first_group, lanes = groups * W;
  std::uint64_t *loads = &lane_loads_[first_group * W]; // particles, lane
  int *ranks = &lane_ranks_[first_group * W];
  Entry *const first = entries_.data() + parts_[part].first_entry, *const last = entries_.data() + parts_[part].last_entry;
  for (std::size_t lane = 0; lane < lanes; ++lane) loads[lane] = lane;
  for (Entry *entry = first; entry != last; ++entry) {
    std::pop_heap(loads, loads + lanes, std::greater<>());
    std::uint64_t &least = loads[lanes - 1];
    entry->lane = static_cast<int>(least & 0xffffffffu);
    least += static_cast<std::uint64_t>(entry->size) << 32;
    std::push_heap(loads, loads + lanes, std::greater<>());
  }
  // The lanes in use of a batch are its first ones.
  std::sort(loads, loads + lanes, std::greater<>());
  for (std::size_t rank = 0; rank < lanes; ++rank) ranks[loads[rank] & 0xffffffffu] = static_cast<int>(rank);
  for (Entry *entry = first; entry != last; ++entry) entry->lane = ranks[entry->lane];
  std::sort(first, last,
            [](const Entry &a, const Entry &b) { return a.lane != b.lane ? a.lane < b.lane : a.block < b.block; });
  const Entry *entry = first;
  for (std::size_t group = 0; group < groups; ++group) {
    group_first_batch_[first_group + group] = static_cast<int>(loads[group * W] >> 32); // their number, for now
    while (static_cast<std::size_t>(entry->lane) < group * W) ++entry;
    group_first_entry_[first_group + group] = static_cast<int>(entry - entries_.data());
  }
}

// Block by block, lane by lane. Returns how many there are.
int VisitOrder::list_particles(int group, int *particles) const {
  const auto g = static_cast<std::size_t>(group);
  int *end = particles;
  for (int e = group_first_entry_[g]; e < group_first_entry_[g + 1]; ++e) {
    const Entry &entry = entries_[static_cast<std::size_t>(e)];
    for_each_run(table_, entry.block, [&](int first, int last) {
      for (int i = first; i < last; ++i)
        if (table_.only_material >= 0 || static_cast<int>(table_.materials[i]) == entry.material) *end++ = i;
    });
  }
  return static_cast<int>(end - particles);
}

// Returns the number of pair steps of the group.
std::int64_t VisitOrder::fill_group(int group, const int *particles) {
  const auto g = static_cast<std::size_t>(group);
  const int first_batch = group_first_batch_[g], batches = group_first_batch_[g + 1] - first_batch;
  const auto W = static_cast<std::size_t>(width_);
  for (int b = first_batch; b < first_batch + batches; ++b) {
    active_[static_cast<std::size_t>(b)] = 0;
    step_counts_[static_cast<std::size_t>(b)] = 0;
    close_steps_[static_cast<std::size_t>(b)] = 0;
  }
  const Entry *entry = entries_.data() + group_first_entry_[g], *const end = entries_.data() + group_first_entry_[g + 1];
  for (std::size_t lane = 0; lane < W; ++lane) {
    if (entry == end) {
      // Passes are worked through in turn, and of the groups of a part only one that is alone has lanes to spare.
      unsigned part = 0;
      while (part_begin(group_pass_[g], part + 1) <= group) ++part;
      const int spare = table_.spare_rows + static_cast<int>(part) * spare_rows_per_part + static_cast<int>(lane);
      for (int b = 0; b < batches; ++b) ids_[static_cast<std::size_t>(first_batch + b) * W + lane] = spare;
      continue;
    }
    int size = 0;
    for (const int of_lane = entry->lane; entry != end && entry->lane == of_lane; ++entry) size += entry->size;
    // Stable counting sort by neighbour count, most first, so that lanes in lockstep have lists of like length. The order within a block does not depend
    // on the blocks that share its lane.
    constexpr int bins = 96;
    int places[bins + 1] = {};
    const auto bin = [&](int i) { return bins - 1 - std::min(table_.neighbour_counts[i], bins - 1); };
    for (int k = 0; k < size; ++k) ++places[bin(particles[k]) + 1];
    for (int k = 0; k < bins; ++k) places[k + 1] += places[k];
    for (int k = 0; k < size; ++k) {
      const int i = particles[k];
      const auto b = static_cast<std::size_t>(first_batch + places[bin(i)]++);
      ids_[b * W + lane] = i;
      ++active_[b];
      step_counts_[b] = std::max(step_counts_[b], table_.neighbour_counts[i]);
      close_steps_[b] = std::max(close_steps_[b], table_.close_counts[i]);
    }
    particles += size;
    const int last = ids_[static_cast<std::size_t>(first_batch + size - 1) * W + lane];
    for (int b = size; b < batches; ++b) ids_[static_cast<std::size_t>(first_batch + b) * W + lane] = last;
  }
  std::int64_t steps = 0;
  for (int b = first_batch; b < first_batch + batches; ++b) steps += step_counts_[static_cast<std::size_t>(b)];
  return steps;
}

void VisitOrder::arrange(Workers &workers, const CellTable &table) {
  table_ = table;
  list_entries(table);
  make_groups(workers, table);
  const auto batches = static_cast<std::size_t>(batch_count_);
  grow(ids_, batches * static_cast<std::size_t>(width_));
  grow(active_, batches);
  grow(offsets_, batches);
  grow(step_counts_, batches);
  grow(close_steps_, batches);
  grow(records_, batches * static_cast<std::size_t>(record_size_) * static_cast<std::size_t>(width_));
  int largest = 0;
  for (int group = 0; group < group_count_; ++group)
    largest = std::max(largest, (group_begin(group + 1) - group_begin(group)) * width_);
  if (largest > largest_group_) {
    largest += largest / 8;
    group_particles_.reserve(static_cast<std::size_t>(largest) * threads_);
    largest_group_ = largest;
  }
}

void VisitOrder::begin_lists() {
  step_count_ = 0;
  pair_count_ = 0;
  largest_lists_ = 0;
}

bool VisitOrder::lists_are_complete() const { return step_count_ <= step_capacity() && largest_lists_ <= found_lists_size_; }

void VisitOrder::make_room() {
  const auto W = static_cast<std::size_t>(width_), steps = static_cast<std::size_t>(step_count_);
  // Prefetches may run past the end, which is harmless; loads do not.
  grow(gradients_, steps * 3 * W);
  grow(indices_, steps * W);
  if (largest_lists_ > found_lists_size_) {
    const std::int64_t size = (largest_lists_ + largest_lists_ / 8 + 15) / 16 * 16;
    found_lists_.reserve(static_cast<std::size_t>(size) * threads_);
    found_lists_size_ = size;
  }
}

CpuInterleaving VisitOrder::interleaving(const FoundLists &lists) {
  return {lists.entries,  list_starts_.data(), table_.neighbour_counts, ids_.data(),
          active_.data(), offsets_.data(),     step_counts_.data(),     indices_.data()};
}

CpuPairs VisitOrder::pairs(Row *velocities) {
  return {velocities,          ids_.data(),     active_.data(),    offsets_.data(), step_counts_.data(),
          close_steps_.data(), indices_.data(), gradients_.data(), records_.data(), record_size_};
}

} // namespace loam
