// What matter does to the colliders that the host asks about, step by step. Where it asks about none, this holds no memory and runs no stage.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/contact/reaction.h"
#include "solver/backend.h"

namespace loam {

template <class Executor> class ColliderReactions {
public:
  explicit ColliderReactions(Executor &executor)
      : executor_(executor), sums_(executor.template array<ReactionSums>()), index_(executor.template array<int>()) {}

  bool any() const { return asked_ > 0; }

  // Before a step. The momentum of `mass`, the greatest of any particle or vertex, at r a substep is 2^44 units: half an ulp of a float is far more than
  // one, and half a million of such impulses have room. Throws Error OUT_OF_MEMORY.
  template <class GreatestMass>
  void prepare(const std::vector<ColliderState> &colliders, double radius, double substep, GreatestMass &&mass) {
    indices_.clear();
    asked_ = 0;
    for (const ColliderState &collider : colliders) indices_.push_back(collider.reaction != nullptr ? asked_++ : -1);
    if (asked_ == 0) {
      sums_.free();
      index_.free();
      return;
    }
    const auto count = static_cast<std::size_t>(asked_);
    if (sums_.capacity() < count) sums_.reserve(count);
    if (index_.capacity() < indices_.size()) index_.reserve(indices_.size());
    executor_.upload(index_.data(), indices_.data(), indices_.size());
    executor_.set(sums_.data(), asked_, ReactionSums{});
    impulse_units_ = std::ldexp(1.0, 44) / (static_cast<double>(mass()) * radius / substep);
    torque_units_ = impulse_units_ / (64 * radius);
    host_.resize(count);
  }
  // For the kernels of one substep.
  Reactions view(const Row *positions, const ColliderView *colliders, bool last_substep) {
    if (!any()) return {};
    return {sums_.data(), index_.data(), impulse_units_, torque_units_, positions, colliders, last_substep};
  }
  // After a step.
  void read(const std::vector<ColliderState> &colliders) {
    if (!any()) return;
    executor_.download(host_.data(), sums_.data(), host_.size());
    std::size_t next = 0;
    for (const ColliderState &collider : colliders) {
      if (collider.reaction == nullptr) continue;
      const ReactionSums &sums = host_[next++];
      for (int k = 0; k < 3; ++k) {
        collider.reaction->impulse[k] = static_cast<double>(sums.impulse[k]) / impulse_units_;
        collider.reaction->torque[k] = static_cast<double>(sums.torque[k]) / torque_units_;
      }
      collider.reaction->contacts = static_cast<std::uint64_t>(sums.contacts);
    }
  }
  std::uint64_t bytes() const { return sums_.bytes() + index_.bytes(); }

private:
  Executor &executor_;
  typename Executor::template Array<ReactionSums> sums_;
  typename Executor::template Array<int> index_;
  std::vector<int> indices_;
  std::vector<ReactionSums> host_;
  int asked_ = 0;
  double impulse_units_ = 1, torque_units_ = 1;
};

} // namespace loam
