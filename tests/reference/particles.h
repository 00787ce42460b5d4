/* The particles of the reference solver: one array a quantity, in the order of the neighbour grid. */
#pragma once

#include "material.h"
#include <cstdint>
#include <vector>

namespace loam::reference {

/* What a neighbour reads and writes, side by side. */
template <typename Real> struct Motion {
  Vector3<Real> velocity;
  Real inverse_mass; // 0: pinned
};

template <typename Real> struct Particles {
  std::vector<std::uint32_t> ids; // in the order of creation
  std::vector<Vector3<Real>> positions;
  std::vector<Motion<Real>> motions;
  std::vector<Real> rest_volumes;
  std::vector<Matrix3<Real>> strains;   // b - I, elastic
  std::vector<Real> volume_corrections; // Drucker-Prager's history
  std::vector<Real> log_volume_changes; // log J of the true volume, elastic and plastic

  std::size_t size() const { return ids.size(); }

  /* The true volume: the elastic one would drift wherever the return mapping discards volume. */
  Real volume(std::size_t particle) const {
    return rest_volumes[particle] * std::exp(std::clamp(log_volume_changes[particle], Real(-0.7), Real(0.7)));
  }

  /* Puts particle order[k] in place k. */
  void reorder(const std::vector<std::uint32_t> &order) {
    const auto apply = [&order](auto &values) {
      auto sorted = values;
      for (std::size_t place = 0; place < order.size(); ++place) sorted[place] = values[order[place]];
      values.swap(sorted);
    };
    apply(ids);
    apply(positions);
    apply(motions);
    apply(rest_volumes);
    apply(strains);
    apply(volume_corrections);
    apply(log_volume_changes);
  }
};

} // namespace loam::reference
