// Contact of one cloth with the particles, over any executor: memory and stages. It exists while a world has both.
#pragma once

#include <algorithm>

#include "kernels/cloth/particle_contact.h"
#include "kernels/cloth/vertices.h"
#include "solver/cloth_grid.h"

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
      : bounds_(executor.template array<Row>()), grid_(executor), contacts_(executor.template array<ClothContact>()),
        counter_(executor.template array<int>()), touches_(executor.template array<int>()),
        changes_(executor.template array<int>()) {}

  int count() const { return count_; }
  std::uint64_t bytes() const {
    return bounds_.bytes() + grid_.bytes() + contacts_.bytes() + counter_.bytes() + touches_.bytes() + changes_.bytes();
  }

  // Changes no velocity; throws Error if memory is refused.
  void find(Executor &ex, const Sheet &sheet, const ClothParticles &particles, float substep) {
    count_ = 0;
    const auto triangles = static_cast<std::size_t>(sheet.triangle_count);
    const auto vertices = static_cast<std::size_t>(sheet.vertex_count);
    bounds_.reserve(triangles);
    grid_.reserve(ex, triangles, static_cast<std::size_t>(particles.capacity));
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
    grid_.sort(ex, bounds_.data(), sheet.triangle_count, radius + stand_off + most);
    TriangleGrid triangle_grid = {grid_.grid, {}, {}, grid_.starts(), grid_.order()};
    for (int k = 0; k < 3; ++k) {
      triangle_grid.lower[k] = grid_.lower[k];
      triangle_grid.upper[k] = grid_.upper[k];
    }
    for (int attempt = 0; attempt < 2; ++attempt) {
      ex.set(counter_.data(), 1, 0);
      ex.for_each(particles.count,
                  FindClothContacts{particles.positions, particles.velocities, sheet.positions, sheet.velocities,
                                    sheet.triangles, bounds_.data(), triangle_grid, substep, stand_off, least, most,
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

  Array<Row> bounds_;
  ClothGrid<Executor> grid_;
  Array<ClothContact> contacts_;
  Array<int> counter_, touches_, changes_;
  int count_ = 0;
};

} // namespace loam
