// Contact of cloth with itself and with other cloth, over any executor: memory and stages. It exists while a world has cloth that asks for it.
#pragma once

#include <vector>

#include "kernels/cloth/self_contact.h"
#include "solver/cloth_grid.h"

namespace loam {

template <class Executor> class ClothSelfContact {
public:
  // A cloth that takes part.
  struct Sheet {
    const Row *positions;
    Row *velocities;
    const Row *rest;
    int vertex_count, vertex_capacity;
    float distance, friction;
  };

  explicit ClothSelfContact(Executor &executor)
      : positions_(executor.template array<Row>()), velocities_(executor.template array<Row>()),
        rest_(executor.template array<Row>()), frictions_(executor.template array<float>()), grid_(executor),
        contacts_(executor.template array<SelfContact>()), counter_(executor.template array<int>()),
        touches_(executor.template array<int>()), changes_(executor.template array<int>()) {}

  // The sheets from now on; pointers stay good until the next call. Throws Error if memory is refused.
  void set_sheets(Executor &ex, std::vector<Sheet> sheets, std::size_t particle_capacity) {
    count_ = vertices_ = 0;
    sheets_ = std::move(sheets);
    if (sheets_.empty()) {
      *this = ClothSelfContact(ex);
      return;
    }
    int most = 0;
    for (const Sheet &sheet : sheets_) most += sheet.vertex_capacity;
    const auto n = static_cast<std::size_t>(most);
    positions_.reserve(n);
    velocities_.reserve(n);
    rest_.reserve(n);
    counter_.reserve(1);
    touches_.reserve(n);
    changes_.reserve(3 * n);
    grid_.reserve(ex, n, particle_capacity);
    frictions_.reserve(sheets_.size());
    std::vector<float> frictions;
    for (const Sheet &sheet : sheets_) frictions.push_back(sheet.friction);
    ex.upload(frictions_.data(), frictions.data(), frictions.size());
  }
  bool any() const { return !sheets_.empty(); }
  std::uint64_t bytes() const {
    return positions_.bytes() + velocities_.bytes() + rest_.bytes() + frictions_.bytes() + grid_.bytes() +
           contacts_.bytes() + counter_.bytes() + touches_.bytes() + changes_.bytes();
  }
  int count() const { return count_; }

  // Changes no velocity; throws Error if memory is refused.
  void find(Executor &ex, float substep) {
    count_ = vertices_ = 0;
    float widest = 0, shortest = sheets_.front().distance;
    for (std::size_t k = 0; k < sheets_.size(); ++k) {
      const Sheet &sheet = sheets_[k];
      ex.for_each(sheet.vertex_count,
                  GatherSelfVertices{sheet.positions, sheet.velocities, vertices_from(vertices_), 0.5f * sheet.distance});
      ex.for_each(sheet.vertex_count, NumberRestVertices{sheet.rest, rest_.data() + vertices_, static_cast<float>(k)});
      vertices_ += sheet.vertex_count;
      widest = std::max(widest, sheet.distance);
      shortest = std::min(shortest, sheet.distance);
    }
    const SumVelocities::Value sum = ex.reduce(vertices_, SumVelocities{velocities_.data()});
    const Vec3<float> mean = {static_cast<float>(sum.x / vertices_), static_cast<float>(sum.y / vertices_),
                              static_cast<float>(sum.z / vertices_)};
    const float speed = ex.reduce(vertices_, GreatestSpeedBeside{velocities_.data(), mean});
    // What nears by more than twice its distance in a substep is not resolved by it.
    const float reach = 0.25f * widest + std::min(3.0f * substep * speed, 2.0f * widest);
    grid_.sort(ex, positions_.data(), vertices_, widest + reach);
    // No float atomics: impulses are whole multiples of this; their sum stays within 32 bits up to 128 distances a substep.
    quantum_ = shortest / substep / 16777216.0f;
    for (int attempt = 0; attempt < 2; ++attempt) {
      ex.set(counter_.data(), 1, 0);
      ex.for_each(vertices_, FindSelfContacts{vertices_from(0), grid_.grid, grid_.starts(), grid_.order(), substep, reach,
                                              contacts_.data(), static_cast<int>(contacts_.capacity()), counter_.data()});
      count_ = ex.read(counter_.data());
      if (static_cast<std::size_t>(count_) <= contacts_.capacity()) break;
      const auto found = static_cast<std::size_t>(count_);
      count_ = 0; // memory may be refused
      contacts_.reserve(found + found / 4 + 256);
    }
    ex.set(touches_.data(), vertices_, 0);
    ex.set(changes_.data(), 3 * vertices_, 0);
  }

  // In the iterations.
  void solve(Executor &ex, float substep) {
    const float recovery = std::min(contact_recovery_share, substep / contact_recovery_time);
    passes(ex, {substep, recovery, 1.0f, true}, 2);
  }
  // At the end of a substep: no pair that is apart comes much nearer than its distance.
  void keep_apart(Executor &ex, float substep) { passes(ex, {substep, 0.0f, 0.9f, false}, 8); }

private:
  template <class T> using Array = typename Executor::template Array<T>;
  SelfVertices vertices_from(int first) {
    return {positions_.data() + first, velocities_.data() + first, rest_.data() + first};
  }

  void passes(Executor &ex, const SelfContactPass &pass, int count) {
    if (count_ == 0) return;
    int first = 0;
    for (const Sheet &sheet : sheets_) {
      ex.for_each(sheet.vertex_count, ScatterSelfVelocities{sheet.velocities, velocities_.data() + first});
      first += sheet.vertex_count;
    }
    for (int k = 0; k < count; ++k) {
      ex.for_each(count_, CountSelfContacts{contacts_.data(), velocities_.data(), pass, touches_.data()});
      ex.for_each(count_, SolveSelfContacts{contacts_.data(), velocities_.data(), rest_.data(), frictions_.data(), pass,
                                            touches_.data(), changes_.data(), quantum_});
      ex.for_each(vertices_, ApplySelfChanges{velocities_.data(), changes_.data(), touches_.data(), quantum_});
    }
    first = 0;
    for (const Sheet &sheet : sheets_) {
      ex.for_each(sheet.vertex_count, ScatterSelfVelocities{velocities_.data() + first, sheet.velocities});
      first += sheet.vertex_count;
    }
  }

  std::vector<Sheet> sheets_;
  Array<Row> positions_, velocities_, rest_;
  Array<float> frictions_;
  ClothGrid<Executor> grid_;
  Array<SelfContact> contacts_;
  Array<int> counter_, touches_, changes_;
  float quantum_ = 1;
  int count_ = 0, vertices_ = 0;
};

} // namespace loam
