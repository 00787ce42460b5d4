// Laws of contact that hold for pairs of a collider and a material, a fluid's adhesion included, as a table where the kernels find them. Where no pair has one there is no table.
#pragma once

#include <algorithm>
#include <vector>

#include "solver/backend.h"

namespace loam {

template <class Executor> class ContactLaws {
public:
  explicit ContactLaws(Executor &executor) : executor_(executor), table_(executor.template array<ContactLaw>()) {}

  // Before a step. Throws Error OUT_OF_MEMORY.
  void prepare(const std::vector<ColliderState> &colliders, const std::vector<SolverMaterial> &materials) {
    laws_.clear();
    rows_.clear();
    const bool clings = std::any_of(materials.begin(), materials.end(), [](const auto &m) { return adhesion_of(m) > 0.0f; });
    for (const ColliderState &collider : colliders) {
      const bool own_laws = clings || !collider.pairs.empty();
      rows_.push_back(own_laws ? laws_.size() : none);
      if (!own_laws) continue;
      laws_.resize(laws_.size() + materials.size(), collider.law);
      for (const PairLaw &pair : collider.pairs) laws_[rows_.back() + pair.material] = pair.law;
      for (std::size_t m = 0; m < materials.size(); ++m) laws_[rows_.back() + m].stick += adhesion_of(materials[m]);
    }
    if (laws_.empty()) {
      table_.free();
      return;
    }
    if (laws_.size() > table_.capacity()) table_.reserve(laws_.size());
    executor_.upload(table_.data(), laws_.data(), laws_.size());
  }

  // Of a collider with all materials, by their numbers; null if its own law holds for all.
  const ContactLaw *of(std::size_t collider) const {
    return rows_[collider] == none ? nullptr : table_.data() + rows_[collider];
  }
  std::uint64_t bytes() const { return table_.bytes(); }

private:
  // With which a fluid clings to every collider.
  static float adhesion_of(const SolverMaterial &material) {
    const Fluid *fluid = std::get_if<Fluid>(&material.law);
    return fluid != nullptr && material.in_use ? fluid->adhesion : 0.0f;
  }
  static constexpr std::size_t none = ~std::size_t(0);
  Executor &executor_;
  typename Executor::template Array<ContactLaw> table_;
  std::vector<ContactLaw> laws_;
  std::vector<std::size_t> rows_;
};

} // namespace loam
