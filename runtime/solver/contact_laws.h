// Laws of contact that hold for pairs of a collider and a material, as a table where the kernels find them. Where no pair has one there is no table.
#pragma once

#include <algorithm>
#include <vector>

#include "solver/backend.h"

namespace loam {

template <class Executor> class ContactLaws {
public:
  explicit ContactLaws(Executor &executor) : executor_(executor), table_(executor.template array<ContactLaw>()) {}

  // Before a step. Throws Error OUT_OF_MEMORY.
  void prepare(const std::vector<ColliderState> &colliders, std::size_t material_count) {
    laws_.clear();
    rows_.clear();
    for (const ColliderState &collider : colliders) {
      rows_.push_back(collider.pairs.empty() ? none : laws_.size());
      if (collider.pairs.empty()) continue;
      laws_.resize(laws_.size() + material_count, collider.law);
      for (const PairLaw &pair : collider.pairs) laws_[rows_.back() + pair.material] = pair.law;
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
  static constexpr std::size_t none = ~std::size_t(0);
  Executor &executor_;
  typename Executor::template Array<ContactLaw> table_;
  std::vector<ContactLaw> laws_;
  std::vector<std::size_t> rows_;
};

} // namespace loam
