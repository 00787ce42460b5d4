#include "cpu/visit_order.h"

#include <algorithm>
#include <cstring>

#include "kernels/inelastic/record.h"

namespace loam {

VisitOrder::VisitOrder(const HostAllocator &allocator, int width, unsigned threads)
    : width_(width), threads_(threads), entries_(allocator), group_first_batch_(allocator), group_first_entry_(allocator),
      group_pass_(allocator), ids_(allocator), active_(allocator), offsets_(allocator), close_steps_(allocator),
      slots_(allocator), indices_(allocator), gradients_(allocator), records_(allocator), scratch_(allocator) {}

void VisitOrder::reserve(std::size_t particle_capacity, int material_count) {
  slots_.reserve(particle_capacity);
  passes_.reserve(static_cast<std::size_t>(27 * material_count));
  material_sizes_.resize(static_cast<std::size_t>(material_count));
}

std::size_t VisitOrder::order_bytes() const {
  return entries_.bytes() + group_first_batch_.bytes() + group_first_entry_.bytes() + group_pass_.bytes() + ids_.bytes() +
         active_.bytes() + offsets_.bytes() + close_steps_.bytes() + slots_.bytes() + scratch_.bytes();
}

namespace {

// An eighth more than asked for, so that small changes of the scene do not take memory each time.
template <class T> void grow(HostArray<T> &array, std::size_t count) {
  if (count > array.capacity()) array.reserve(count + count / 8 + 64);
}

} // namespace

void VisitOrder::list_entries(const CellTable &table) {
  const Colouring &colouring = table.colouring;
  const int w = colouring.block_width, n = colouring.colours_per_axis;
  const int by = table.grid.size[1] / w, bz = table.grid.size[2] / w, blocks = table.grid.size[0] / w * by * bz;
  grow(entries_, static_cast<std::size_t>(std::min<std::int64_t>(
                     table.particle_count, static_cast<std::int64_t>(blocks) * std::max(table.material_count, 1))));
  entry_count_ = 0;
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
      const std::uint64_t rank = (pass << 16) | static_cast<std::uint64_t>(0xffff - std::min(size, 0xffff));
      entries_[entry_count_++] = {(rank << 31) | static_cast<std::uint64_t>(block), block, material, size};
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
  // Keys are unique, so the order does not depend on the sort.
  std::sort(entries_.data(), entries_.data() + entry_count_, [](const Entry &a, const Entry &b) { return a.key < b.key; });
}

void VisitOrder::make_groups(const CellTable &table) {
  (void)table;
  const std::size_t most = entry_count_ / static_cast<std::size_t>(width_) + passes_.capacity() + 1;
  grow(group_first_batch_, most + 1);
  grow(group_first_entry_, most + 1);
  grow(group_pass_, most);
  passes_.clear();
  group_count_ = 0;
  batch_count_ = 0;
  std::uint64_t pass_key = ~std::uint64_t(0);
  for (std::size_t e = 0; e < entry_count_;) {
    const std::uint64_t key = entries_[e].key >> 47;
    if (key != pass_key) {
      pass_key = key;
      const int colour = static_cast<int>(key / static_cast<std::uint64_t>(table.material_count));
      passes_.push_back({entries_[e].material, colour, group_count_, group_count_, 0});
    }
    const auto group = static_cast<std::size_t>(group_count_);
    group_first_batch_[group] = batch_count_;
    group_first_entry_[group] = static_cast<int>(e);
    group_pass_[group] = static_cast<int>(passes_.size()) - 1;
    batch_count_ += entries_[e].size;
    std::size_t end = e;
    while (end < entry_count_ && end < e + static_cast<std::size_t>(width_) && entries_[end].key >> 47 == pass_key)
      passes_.back().particles += entries_[end++].size;
    e = end;
    passes_.back().last_group = ++group_count_;
  }
  group_first_batch_[static_cast<std::size_t>(group_count_)] = batch_count_;
  group_first_entry_[static_cast<std::size_t>(group_count_)] = static_cast<int>(entry_count_);
}

void VisitOrder::fill_group(const CellTable &table, int group, int pass_index) {
  const auto g = static_cast<std::size_t>(group);
  const int first_batch = group_first_batch_[g], batches = group_first_batch_[g + 1] - first_batch;
  const int first_entry = group_first_entry_[g];
  const auto in_use = static_cast<std::size_t>(group_first_entry_[g + 1] - first_entry);
  const auto W = static_cast<std::size_t>(width_);
  for (int b = first_batch; b < first_batch + batches; ++b) {
    active_[static_cast<std::size_t>(b)] = 0;
    offsets_[static_cast<std::size_t>(b)] = 0;
    close_steps_[static_cast<std::size_t>(b)] = 0;
  }
  for (std::size_t lane = 0; lane < W; ++lane) {
    if (lane >= in_use) {
      const int spare = table.spare_rows + pass_index * spare_rows_per_pass + static_cast<int>(lane);
      for (int b = 0; b < batches; ++b) ids_[static_cast<std::size_t>(first_batch + b) * W + lane] = spare;
      continue;
    }
    const Entry &entry = entries_[static_cast<std::size_t>(first_entry) + lane];
    // Stable counting sort by neighbour count, most first, so that lanes in lockstep have lists of like length.
    constexpr int bins = 96;
    int places[bins + 1] = {};
    const auto bin = [&](int i) { return bins - 1 - std::min(table.neighbour_counts[i], bins - 1); };
    const auto for_each_particle = [&](auto &&f) {
      for_each_run(table, entry.block, [&](int first, int last) {
        for (int i = first; i < last; ++i)
          if (table.only_material >= 0 || static_cast<int>(table.materials[i]) == entry.material) f(i);
      });
    };
    for_each_particle([&](int i) { ++places[bin(i) + 1]; });
    for (int k = 0; k < bins; ++k) places[k + 1] += places[k];
    for_each_particle([&](int i) {
      const auto b = static_cast<std::size_t>(first_batch + places[bin(i)]++);
      ids_[b * W + lane] = i;
      slots_[static_cast<std::size_t>(i)] = static_cast<int>(b * W + lane);
      ++active_[b];
      offsets_[b] = std::max(offsets_[b], table.neighbour_counts[i]);
      close_steps_[b] = std::max(close_steps_[b], table.close_counts[i]);
    });
    const int last = ids_[static_cast<std::size_t>(first_batch + entry.size - 1) * W + lane];
    for (int b = entry.size; b < batches; ++b) ids_[static_cast<std::size_t>(first_batch + b) * W + lane] = last;
  }
}

std::int64_t VisitOrder::arrange(Workers &workers, const CellTable &table) {
  table_ = table;
  list_entries(table);
  make_groups(table);
  const auto batches = static_cast<std::size_t>(batch_count_);
  grow(ids_, batches * static_cast<std::size_t>(width_));
  grow(active_, batches);
  grow(offsets_, batches + 1);
  grow(close_steps_, batches);

  const int groups_per_chunk = std::max(1, group_count_ / 128);
  workers.loop((group_count_ + groups_per_chunk - 1) / groups_per_chunk, [&](int chunk) {
    const int last = std::min(group_count_, (chunk + 1) * groups_per_chunk);
    for (int group = chunk * groups_per_chunk; group < last; ++group)
      fill_group(table, group, group_pass_[static_cast<std::size_t>(group)]);
  });

  // The offsets hold the lengths of the batches' lists so far.
  std::int64_t sum = 0;
  for (std::size_t b = 0; b < batches; ++b) {
    const int length = offsets_[b];
    offsets_[b] = static_cast<int>(sum);
    sum += length;
  }
  offsets_[batches] = static_cast<int>(sum);
  steps_ = sum;
  return sum;
}

void VisitOrder::make_room() {
  const auto W = static_cast<std::size_t>(width_), steps = static_cast<std::size_t>(steps_);
  // Prefetches may run past the end, which is harmless; loads do not.
  grow(indices_, steps * W);
  grow(gradients_, steps * 3 * W);
  if (table_.only_material >= 0) {
    std::size_t most = 0;
    for (int group = 0; group < group_count_; ++group)
      most = std::max(most, static_cast<std::size_t>(offsets_[static_cast<std::size_t>(group_begin(group + 1))] -
                                                     offsets_[static_cast<std::size_t>(group_begin(group))]));
    scratch_size_ = std::max(scratch_size_, (3 * W * most + most / 8 + 63) / 64 * 64);
    if (scratch_size_ * threads_ > scratch_.capacity()) scratch_.reserve(scratch_size_ * threads_);
  }
  grow(records_, static_cast<std::size_t>(batch_count_) * Record::field_count * W);
}

void VisitOrder::interleave_lists(const int *lists, int first_batch, int last_batch) {
  const auto W = static_cast<std::size_t>(width_);
  for (auto batch = static_cast<std::size_t>(first_batch); batch < static_cast<std::size_t>(last_batch); ++batch) {
    const int *ids = &ids_[batch * W];
    const auto first = static_cast<std::size_t>(offsets_[batch]),
               steps = static_cast<std::size_t>(offsets_[batch + 1]) - first;
    const int *list = lists + 3 * first * W;
    int *to = &indices_[first * W];
    for (std::size_t lane = 0; lane < W; ++lane, list += 3 * steps) {
      const bool idle = lane >= static_cast<std::size_t>(active_[batch]);
      const auto total = idle ? 0 : static_cast<std::size_t>(table_.neighbour_counts[ids[lane]]);
      const auto close = idle ? 0 : static_cast<std::size_t>(table_.close_counts[ids[lane]]);
      const int *far = list - close;
      for (std::size_t step = 0; step < close; ++step) to[step * W + lane] = list[2 * steps + step];
      for (std::size_t step = close; step < total; ++step) to[step * W + lane] = far[step];
      for (std::size_t step = total; step < steps; ++step) to[step * W + lane] = ids[lane];
    }
  }
}

CpuPairs VisitOrder::pairs(Row *velocities) {
  return {velocities,          ids_.data(),     active_.data(),    offsets_.data(),
          close_steps_.data(), indices_.data(), gradients_.data(), records_.data()};
}

} // namespace loam
