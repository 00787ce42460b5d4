// Contact of one cloth with the particles, over any executor: memory and stages. It exists while a world has both.
#pragma once

#include <algorithm>

#include "kernels/cloth/particle_contact.h"
#include "kernels/cloth/sweep_cloth.h"
#include "kernels/cloth/vertices.h"
#include "solver/cloth_grid.h"

namespace loam {

// The particles of a substep.
struct ClothParticles {
  const Row *positions;
  Row *velocities;
  int count, capacity;
  float radius;    // r
  float speed = 0; // the greatest component of any velocity at the start of the substep, m/s
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
    bool held; // by something that is neither cloth nor particles
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
    const float speeds = particles.speed + ex.reduce(sheet.vertex_count, GreatestSpeed{sheet.velocities});
    const float r = particles.radius, stand_off = 0.5f * r;
    // What moves farther than four radii in a substep is not resolved by it.
    const float least = 0.25f * r, most = least + std::min(1.5f * 1.7321f * substep * speeds, 4.0f * r);
    const float radius = ex.reduce(sheet.triangle_count, GreatestRadius{bounds_.data()});
    grid_.sort(ex, bounds_.data(), sheet.triangle_count, radius + stand_off + most);
    for (int attempt = 0; attempt < 2; ++attempt) {
      ex.set(counter_.data(), 1, 0);
      ex.for_each(particles.count,
                  FindClothContacts{particles.positions, particles.velocities, sheet.positions, sheet.velocities,
                                    sheet.triangles, bounds_.data(), triangle_grid(), substep, stand_off, least, most,
                                    contacts_.data(), static_cast<int>(contacts_.capacity()), counter_.data()});
      const int found = ex.read(counter_.data());
      if (static_cast<std::size_t>(found) <= contacts_.capacity()) {
        count_ = found;
        break;
      }
      contacts_.reserve(static_cast<std::size_t>(std::min(found + found / 4 + 256, particles.capacity)));
    }
    counted_ = false;
    ex.set(touches_.data(), sheet.vertex_count, 0);
    ex.set(changes_.data(), 3 * sheet.vertex_count, 0);
  }

  void forget() { count_ = 0; }

  // In the iterations: both give way.
  void solve(Executor &ex, const Sheet &sheet, const ClothParticles &particles, float substep) {
    pass(ex, sheet, particles, {substep, -1.0f});
  }
  // At the end of a substep, likewise: nothing passes a point.
  void keep_off(Executor &ex, const Sheet &sheet, const ClothParticles &particles, float substep) {
    for (int k = 0; k < 8; ++k) pass(ex, sheet, particles, {substep, margin(particles)});
  }

  // The particles' ways end where the cloth is; it receives its part of that by apply(), when it has moved.
  void sweep(Executor &ex, const Sheet &sheet, const ClothParticles &particles, float substep, bool pushes_back) {
    const float fastest = 1.7321f * ex.reduce(sheet.vertex_count, GreatestSpeed{sheet.velocities});
    SweepCloth stage = {contacts_.data(),
                        particles.positions,
                        particles.velocities,
                        sheet.positions,
                        impulses(sheet, particles, substep),
                        sheet.triangles,
                        bounds_.data(),
                        triangle_grid(),
                        substep,
                        margin(particles),
                        0.75f * particles.radius,
                        substep * fastest,
                        sheet.held || !pushes_back};
    ex.for_each(count_, stage);
    stage.contacts = nullptr;
    ex.for_each(particles.count, stage);
  }
  void apply(Executor &ex, const Sheet &sheet, const ClothParticles &particles, float substep) {
    ex.for_each(sheet.vertex_count, ApplyClothChanges{sheet.velocities, changes_.data(),
                                                      sheet.held ? nullptr : touches_.data(), quantum(particles, substep)});
  }

private:
  void pass(Executor &ex, const Sheet &sheet, const ClothParticles &particles, const ClothShortfall &shortfall) {
    if (count_ == 0) return;
    if (!sheet.held || !counted_)
      ex.for_each(count_, CountClothContacts{contacts_.data(), particles.velocities, sheet.velocities, shortfall, sheet.held,
                                             touches_.data()});
    counted_ = true;
    ex.for_each(count_,
                SolveClothContacts{contacts_.data(), particles.velocities, impulses(sheet, particles, shortfall.substep),
                                   touches_.data(), shortfall, sheet.friction});
    apply(ex, sheet, particles, shortfall.substep);
  }
  // A thousandth of a millimetre a second where r / h is 16 m/s; sums stay within 32 bits up to 128 r / h.
  static float quantum(const ClothParticles &particles, float substep) { return particles.radius / substep / 16777216.0f; }
  ClothImpulses impulses(const Sheet &sheet, const ClothParticles &particles, float substep) {
    return {sheet.velocities, changes_.data(), quantum(particles, substep)};
  }

  static float margin(const ClothParticles &particles) { return 0.05f * particles.radius; }
  TriangleGrid triangle_grid() const {
    TriangleGrid result = {grid_.grid, {}, {}, grid_.starts(), grid_.order()};
    for (int k = 0; k < 3; ++k) {
      result.lower[k] = grid_.lower[k];
      result.upper[k] = grid_.upper[k];
    }
    return result;
  }

  template <class T> using Array = typename Executor::template Array<T>;

  Array<Row> bounds_;
  ClothGrid<Executor> grid_;
  Array<ClothContact> contacts_;
  Array<int> counter_, touches_, changes_;
  int count_ = 0;
  bool counted_ = false; // the touches of cloth that is held
};

} // namespace loam
