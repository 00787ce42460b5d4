// The order in which CUDA visits particles, and the storage laid out in that order. See tile_views.h for the layout.
//
// Everything is made on the device; the host reads one small table a substep, that of the passes:
//
//   1  a key for each particle: material, colour, block, rank       4  prefix sums: which entry, which pass, where its list goes
//      within the block                                             5  visits, starts of entries and passes; the table comes to the host
//   2  sort by it: the visits                                       6  entries sorted from large to small within their pass
//   3  an entry begins where the block changes, a pass where
//      colour or material do
//
// An entry is one block's particles of one material, what a tile works through in turn. Storage is by material first, so that all visits of a
// material are one piece; passes run by colour first, so that materials take turns.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "order_stages.h"

namespace loam {

template <class Machine> class TileVisitOrder {
public:
  // Visits that may run at once: blocks of one colour, particles of one material.
  struct Pass {
    int material, colour;
    int first_entry, last_entry;
    int first_visit, last_visit;
  };
  struct VisitRange {
    int first, last;
  };

  explicit TileVisitOrder(Machine &machine)
      : machine_(machine), keys_(machine.template array<std::uint64_t>()),
        particles_(machine.template array<std::uint32_t>()), sums_(machine.template array<VisitSums>()),
        visits_(machine.template array<Visit>()), entry_starts_(machine.template array<int>()),
        entry_passes_(machine.template array<int>()), entry_keys_(machine.template array<std::uint32_t>()),
        entry_order_(machine.template array<std::uint32_t>()), pass_rows_(machine.template array<PassRow>()),
        indices_(machine.template array<int>()), gradients_(machine.template array<float>()),
        records_(machine.template array<float>()) {}

  // Room for a world's particles and materials; may be called again for more materials.
  void reserve(std::size_t particle_capacity, int material_count, int record_size) {
    record_stride_ = (record_size + TilePairs::sector - 1) / TilePairs::sector * TilePairs::sector;
    keys_.reserve(particle_capacity);
    particles_.reserve(particle_capacity);
    sums_.reserve(particle_capacity);
    visits_.reserve(particle_capacity);
    entry_starts_.reserve(particle_capacity + 1);
    entry_passes_.reserve(particle_capacity);
    entry_keys_.reserve(particle_capacity);
    entry_order_.reserve(particle_capacity);
    // A visit reads as many fields as a record can have, so past the last record there must be some.
    records_.reserve(particle_capacity * static_cast<std::size_t>(record_stride_) + TilePairs::most_fields);
    const std::size_t passes = static_cast<std::size_t>(most_colours) * static_cast<std::size_t>(material_count);
    pass_rows_.reserve(passes + 1);
    rows_.resize(passes + 1);
    passes_.reserve(passes);
    materials_.resize(static_cast<std::size_t>(material_count));
  }

  // Orders the visits and makes room for the lists. Throws Error before anything of the lists has changed.
  void arrange(const CellTable &table) {
    const int count = table.particle_count;
    const Colouring &colouring = table.colouring;
    const int w = colouring.block_width, colours = colouring.colours();
    const int block_bits = bits_for(table.grid.cell_count() / (w * w * w));
    // With one bit to spare for particles that are not visited.
    const int key_bits = AssignVisits::count_bits + block_bits + bits_for(colours * table.material_count) + 1;

    const SortedVisits sorted = {keys_.data(), particles_.data(), table.neighbour_counts, block_bits};
    machine_.for_each(count, AssignVisits{table, block_bits, keys_.data(), particles_.data()});
    machine_.sort(keys_.data(), particles_.data(), count, key_bits);
    const int visits = table.active_cells == nullptr
                           ? count
                           : static_cast<int>(machine_.reduce(count, CountVisited{table.keys, table.active_cells}));
    machine_.for_each(visits, CountVisits{sorted, sums_.data()});
    machine_.exclusive_sum(sums_.data(), visits);
    machine_.for_each(visits, PlaceVisits{sorted, sums_.data(), table.close_counts, visits, visits_.data(),
                                          entry_starts_.data(), entry_passes_.data(), pass_rows_.data()});
    const PassRow total = read_passes(colours, table.material_count);
    visit_count_ = total.first_visit;

    const auto pairs = static_cast<std::size_t>(total.first_line) * TilePairs::line;
    grow(indices_, pairs);
    grow(gradients_, 3 * pairs);

    const int entries = total.first_entry, pass_bits = bits_for(static_cast<int>(passes_.size()));
    machine_.for_each(entries,
                      RankEntries{entry_starts_.data(), entry_passes_.data(), entry_keys_.data(), entry_order_.data()});
    machine_.sort(entry_keys_.data(), entry_order_.data(), entries, RankEntries::size_bits + pass_bits);
  }

  const std::vector<Pass> &passes() const { return passes_; }
  int visit_count() const { return visit_count_; }
  VisitRange visits_of(int material) const { return materials_[static_cast<std::size_t>(material)]; }
  TileBlocks blocks(const Pass &pass) {
    return {reinterpret_cast<const int *>(entry_order_.data()) + pass.first_entry, entry_starts_.data(),
            pass.last_entry - pass.first_entry};
  }
  TilePairs pairs(Row *velocities) {
    return {velocities, visits_.data(), indices_.data(), gradients_.data(), records_.data(), record_stride_};
  }

  std::size_t list_bytes() const { return indices_.bytes() + gradients_.bytes(); }
  std::size_t record_bytes() const { return records_.bytes(); }
  std::size_t order_bytes() const {
    return keys_.bytes() + particles_.bytes() + sums_.bytes() + visits_.bytes() + entry_starts_.bytes() +
           entry_passes_.bytes() + entry_keys_.bytes() + entry_order_.bytes() + pass_rows_.bytes();
  }

private:
  template <class T> using Array = typename Machine::template Array<T>;
  static constexpr int most_colours = 27;

  // The least b with 2^b >= count.
  static int bits_for(int count) {
    int bits = 0;
    while ((static_cast<std::int64_t>(1) << bits) < count) ++bits;
    return std::max(bits, 1);
  }
  // An eighth more than asked for, so that small changes of the scene do not take memory each time.
  template <class T> static void grow(Array<T> &array, std::size_t count) {
    if (count > array.capacity()) array.reserve(count + count / 8 + 64);
  }

  // Reads the table of passes; returns its last row, the totals. A few rows are all that most scenes have.
  PassRow read_passes(int colours, int material_count) {
    const std::size_t most = static_cast<std::size_t>(colours * material_count) + 1;
    const auto is_end = [](const PassRow &row) { return row.number == PassRow::end; };
    const auto read = [&](std::size_t count) {
      machine_.download(rows_.data(), pass_rows_.data(), count);
      return std::find_if(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(count), is_end);
    };
    const std::size_t few = std::min<std::size_t>(most, 64);
    auto end = read(few);
    if (end == rows_.begin() + static_cast<std::ptrdiff_t>(few)) end = read(most);

    passes_.clear();
    std::fill(materials_.begin(), materials_.end(), VisitRange{0, 0});
    for (auto row = rows_.begin(); row != end; ++row) {
      const int material = row->number / colours;
      passes_.push_back(
          {material, row->number % colours, row->first_entry, row[1].first_entry, row->first_visit, row[1].first_visit});
      VisitRange &range = materials_[static_cast<std::size_t>(material)];
      if (range.first == range.last) range.first = row->first_visit;
      range.last = row[1].first_visit;
    }
    std::sort(passes_.begin(), passes_.end(), [&](const Pass &a, const Pass &b) {
      return a.colour * material_count + a.material < b.colour * material_count + b.material;
    });
    return *end;
  }

  Machine &machine_;
  int visit_count_ = 0;
  std::vector<PassRow> rows_;
  std::vector<Pass> passes_;
  std::vector<VisitRange> materials_;
  Array<std::uint64_t> keys_;
  Array<std::uint32_t> particles_;
  Array<VisitSums> sums_;
  Array<Visit> visits_;
  Array<int> entry_starts_, entry_passes_;
  Array<std::uint32_t> entry_keys_, entry_order_;
  Array<PassRow> pass_rows_;
  Array<int> indices_;
  Array<float> gradients_, records_;
  int record_stride_ = 0;
};

} // namespace loam
