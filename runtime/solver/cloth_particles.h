// Contact of one cloth with the particles, over any executor: memory and stages. It exists while a world has both.
#pragma once

#include <algorithm>

#include "kernels/cloth/particle_contact.h"
#include "kernels/cloth/vertices.h"
#include "kernels/neighbours/sort_stages.h"

namespace loam {

// The particles of a substep.
struct ClothParticles {
  const Row *positions;
  Row *velocities;
  int count, capacity;
  float radius; // r
};

template <class Executor> class ClothParticleContact {
public:
  // The cloth, as far as it matters here.
  struct Sheet {
    const Row *positions;
    Row *velocities;
    const int *triangles;
    int vertex_count, triangle_count;
    float friction;
  };

  explicit ClothParticleContact(Executor &executor)
      : bounds_(executor.template array<Row>()), keys_(executor.template array<std::uint32_t>()),
        order_(executor.template array<std::uint32_t>()), starts_(executor.template array<int>()),
        contacts_(executor.template array<ClothContact>()), counter_(executor.template array<int>()),
        touches_(executor.template array<int>()), changes_(executor.template array<int>()) {}

  int count() const { return count_; }
  std::uint64_t bytes() const {
    return bounds_.bytes() + keys_.bytes() + order_.bytes() + starts_.bytes() + contacts_.bytes() + counter_.bytes() +
           touches_.bytes() + changes_.bytes();
  }

  // Changes no velocity; throws Error if memory is refused.
  void find(Executor &ex, const Sheet &sheet, const ClothParticles &particles, float substep) {
    count_ = 0;
    const auto triangles = static_cast<std::size_t>(sheet.triangle_count);
    const auto vertices = static_cast<std::size_t>(sheet.vertex_count);
    if (bounds_.capacity() < triangles) {
      keys_.reserve(triangles);
      order_.reserve(triangles);
      ex.reserve_sort(std::max(triangles, static_cast<std::size_t>(particles.capacity)));
      bounds_.reserve(triangles); // last: it tells that all of them are there, and any may be refused
    }
    counter_.reserve(1);
    touches_.reserve(vertices);
    changes_.reserve(3 * vertices);
    ex.for_each(sheet.triangle_count, BoundTriangles{sheet.positions, sheet.triangles, bounds_.data()});
    const float speeds = ex.reduce(particles.count, GreatestSpeed{particles.velocities}) +
                         ex.reduce(sheet.vertex_count, GreatestSpeed{sheet.velocities});
    const float r = particles.radius, stand_off = 0.5f * r;
    // What moves farther than four radii in a substep is not resolved by it.
    const float least = 0.25f * r, most = least + std::min(1.5f * 1.7321f * substep * speeds, 4.0f * r);
    const float radius = ex.reduce(sheet.triangle_count, GreatestRadius{bounds_.data()});
    make_grid(ex, sheet.triangle_count, radius + stand_off + most);
    const int cells = grid_.grid.cell_count();
    int key_bits = 1;
    while (((cells - 1) >> key_bits) != 0) ++key_bits;
    ex.for_each(sheet.triangle_count, AssignCells{grid_.grid, bounds_.data(), keys_.data(), order_.data()});
    ex.sort(keys_.data(), order_.data(), sheet.triangle_count, key_bits);
    ex.for_each(sheet.triangle_count, MarkCells{keys_.data(), starts_.data(), sheet.triangle_count, cells});
    grid_.starts = starts_.data();
    grid_.order = order_.data();
    for (int attempt = 0; attempt < 2; ++attempt) {
      ex.set(counter_.data(), 1, 0);
      ex.for_each(particles.count,
                  FindClothContacts{particles.positions, particles.velocities, sheet.positions, sheet.velocities,
                                    sheet.triangles, bounds_.data(), grid_, substep, stand_off, least, most,
                                    contacts_.data(), static_cast<int>(contacts_.capacity()), counter_.data()});
      const int found = ex.read(counter_.data());
      if (static_cast<std::size_t>(found) <= contacts_.capacity()) {
        count_ = found;
        break;
      }
      contacts_.reserve(static_cast<std::size_t>(std::min(found + found / 4 + 256, particles.capacity)));
    }
    if (count_ == 0) return;
    ex.set(touches_.data(), sheet.vertex_count, 0);
    ex.set(changes_.data(), 3 * sheet.vertex_count, 0);
    ex.for_each(count_, CountClothContacts{contacts_.data(), touches_.data()});
  }

  void solve(Executor &ex, const Sheet &sheet, const ClothParticles &particles, float substep) {
    if (count_ == 0) return;
    ex.for_each(count_, SolveClothContacts{contacts_.data(), particles.velocities, impulses(sheet, particles, substep),
                                           touches_.data(), substep, sheet.friction});
    apply(ex, sheet, particles, substep);
  }

  // Both give way, or, if not, the particles alone.
  void keep_off(Executor &ex, const Sheet &sheet, const ClothParticles &particles, float substep, bool both) {
    if (count_ == 0) return;
    ex.for_each(count_, KeepOffCloth{contacts_.data(), particles.velocities, impulses(sheet, particles, substep),
                                     both ? touches_.data() : nullptr, substep, 0.05f * particles.radius});
    if (both) apply(ex, sheet, particles, substep);
  }

private:
  // A thousandth of a millimetre a second where r / h is 16 m/s; sums stay within 32 bits up to 128 r / h.
  static float quantum(const ClothParticles &particles, float substep) { return particles.radius / substep / 16777216.0f; }
  ClothImpulses impulses(const Sheet &sheet, const ClothParticles &particles, float substep) {
    return {sheet.velocities, changes_.data(), quantum(particles, substep)};
  }

  void apply(Executor &ex, const Sheet &sheet, const ClothParticles &particles, float substep) {
    ex.for_each(sheet.vertex_count, ApplyClothChanges{sheet.velocities, changes_.data(), quantum(particles, substep)});
  }

  template <class T> using Array = typename Executor::template Array<T>;

  void make_grid(Executor &ex, int triangles, float cell) {
    grid_.grid.inverse_cell = 1.0f / (cell * 1.0001f);
    const CellBounds::Value cells = ex.reduce(triangles, CellBounds{bounds_.data(), grid_.grid.inverse_cell});
    std::int64_t size[3];
    for (int k = 0; k < 3; ++k) {
      grid_.lower[k] = cells.lower[k];
      grid_.upper[k] = cells.upper[k];
      grid_.grid.origin[k] = cells.lower[k];
      // The three cells around a particle along an axis must not be one.
      size[k] = std::max<std::int64_t>(3, static_cast<std::int64_t>(cells.upper[k]) - cells.lower[k] + 1);
    }
    const std::int64_t most = std::max<std::int64_t>(32768, 4 * static_cast<std::int64_t>(triangles));
    while (size[0] * size[1] > most || size[0] * size[1] * size[2] > most) {
      std::int64_t *widest = std::max_element(size, size + 3);
      *widest = std::max<std::int64_t>(3, *widest / 2);
    }
    for (int k = 0; k < 3; ++k) grid_.grid.size[k] = static_cast<int>(size[k]);
    const auto entries = static_cast<std::size_t>(grid_.grid.cell_count()) + 1;
    if (entries > starts_.capacity()) starts_.reserve(entries + entries / 4);
  }

  Array<Row> bounds_;
  Array<std::uint32_t> keys_, order_;
  Array<int> starts_;
  Array<ClothContact> contacts_;
  Array<int> counter_, touches_, changes_;
  TriangleGrid grid_{};
  int count_ = 0;
};

} // namespace loam
