/* A team of one lane: runs the kernels over neighbours one particle at a time, in plain floats, so that a test can look at what they read and
 * write. Neighbours are found by trying all pairs. For tests of the insides. */
#pragma once

#include <vector>

#include "kernels/inelastic/record.h"
#include "kernels/neighbours/compute_gradients.h"
#include "math/matrix.h"

namespace loam::test {

struct Cloud {
  float radius = 0.01f;
  std::vector<Row> positions, velocities; // fourth components: volume, inverse mass
  std::vector<float> strains, histories, drifts, log_volumes, rest_volumes;
  std::vector<std::vector<int>> neighbours;
  std::vector<std::vector<Vec3<float>>> gradients;
  std::vector<int> neighbour_counts, close_counts;
  std::vector<float> records; // Record::field_count a particle

  int size() const { return int(positions.size()); }
  void add(Vec3<float> x, float volume, float inverse_mass) {
    positions.push_back({x.x, x.y, x.z, volume});
    velocities.push_back({0, 0, 0, inverse_mass});
    strains.insert(strains.end(), 6, 0.0f);
    histories.push_back(0);
    drifts.insert(drifts.end(), 3, 0.0f);
    log_volumes.push_back(0);
    rest_volumes.push_back(volume);
  }
  void find_neighbours() {
    neighbours.assign(positions.size(), {});
    gradients.assign(positions.size(), {});
    for (std::size_t i = 0; i < positions.size(); ++i)
      for (std::size_t j = 0; j < positions.size(); ++j) {
        const Vec3<float> d = xyz(positions[j]) - xyz(positions[i]);
        if (i != j && dot(d, d) < 4 * radius * radius) neighbours[i].push_back(int(j));
      }
    neighbour_counts.clear();
    for (std::size_t i = 0; i < positions.size(); ++i) {
      neighbour_counts.push_back(int(neighbours[i].size()));
      gradients[i].resize(neighbours[i].size());
    }
    close_counts = neighbour_counts;
    records.assign(positions.size() * Record::field_count, 0.0f);
  }
  const float *record(int i, int field) const { return &records[std::size_t(i * Record::field_count + field)]; }
};

struct ScalarTeam {
  using Lane = float;
  using Real = float;
  using Item = int;
  struct Neighbour {
    int item;
    std::size_t place;
    Neighbour operator*() const { return *this; }
    bool operator!=(const Neighbour &end) const { return place != end.place; }
    void operator++() { ++place; }
  };
  struct Range {
    Neighbour first, last;
    Neighbour begin() const { return first; }
    Neighbour end() const { return last; }
  };

  Cloud &cloud;

  int id(const Neighbour &k) const { return cloud.neighbours[std::size_t(k.item)][k.place]; }
  static Vec4<float> vector4(const Row &row) { return {row.x, row.y, row.z, row.w}; }
  static Row row(const Vec4<float> &v) { return {v.x, v.y, v.z, v.w}; }

  Range neighbours(int p) const { return {{p, 0}, {p, cloud.neighbours[std::size_t(p)].size()}}; }
  Range close_neighbours(int p) const { return neighbours(p); }
  Vec4<float> neighbour_velocity(const Neighbour &k) const { return vector4(cloud.velocities[std::size_t(id(k))]); }
  void set_neighbour_velocity(const Neighbour &k, const Vec4<float> &v) { cloud.velocities[std::size_t(id(k))] = row(v); }
  Vec4<float> neighbour_row(const Neighbour &k, const Row *rows) const { return vector4(rows[id(k)]); }
  Vec3<float> gradient(const Neighbour &k) const { return cloud.gradients[std::size_t(k.item)][k.place]; }
  void set_gradient(const Neighbour &k, const Vec3<float> &g) { cloud.gradients[std::size_t(k.item)][k.place] = g; }
  float neighbour_count(const Neighbour &k, const int *counts) const { return float(counts[id(k)]); }
  float neighbour_lookup(const Neighbour &k, const std::uint32_t *numbers, const float *table) const {
    return table[numbers[id(k)]];
  }

  Vec4<float> velocity(int p) const { return vector4(cloud.velocities[std::size_t(p)]); }
  void set_velocity(int p, const Vec4<float> &v) { cloud.velocities[std::size_t(p)] = row(v); }
  Vec4<float> own_row(int p, const Row *rows) const { return vector4(rows[p]); }
  void set_own_row(int p, Row *rows, const Vec4<float> &v) { rows[p] = row(v); }
  float own_value(int p, const float *values, int stride, int offset) const { return values[p * stride + offset]; }
  void set_own_value(int p, float *values, int stride, int offset, float value) { values[p * stride + offset] = value; }
  float own_count(int p, const int *counts) const { return float(counts[p]); }

  float field(int p, int f) const { return *cloud.record(p, f); }
  void set_field(int p, int f, float value) { cloud.records[std::size_t(p * Record::field_count + f)] = value; }
  Vec3<float> vector(int p, int f) const { return {field(p, f), field(p, f + 1), field(p, f + 2)}; }
  void set_vector(int p, int f, const Vec3<float> &v) {
    set_field(p, f, v.x);
    set_field(p, f + 1, v.y);
    set_field(p, f + 2, v.z);
  }
  Sym3<float> symmetric(int p, int f) const {
    return {field(p, f), field(p, f + 1), field(p, f + 2), field(p, f + 3), field(p, f + 4), field(p, f + 5)};
  }
  void set_symmetric(int p, int f, const Sym3<float> &s) {
    const float values[6] = {s.xx, s.yy, s.zz, s.xy, s.xz, s.yz};
    for (int i = 0; i < 6; ++i) set_field(p, f + i, values[i]);
  }

  template <class V> static const V &sum(const V &v) { return v; }
  template <class V> static const V &spread(const V &v) { return v; }
  void count(int, bool mask, int *counter) const { *counter += mask ? 1 : 0; }
};

template <bool NonAffine = false> void compute_gradients(Cloud &cloud, float cutoff = 0.2f, float *corrections = nullptr) {
  ScalarTeam team{cloud};
  const ComputeGradients<NonAffine> stage{cloud.positions.data(),
                                          cloud.velocities.data(),
                                          cloud.strains.data(),
                                          cloud.histories.data(),
                                          cloud.drifts.data(),
                                          cloud.rest_volumes.data(),
                                          cloud.neighbour_counts.data(),
                                          cloud.close_counts.data(),
                                          corrections,
                                          SmoothingKernel::make(double(cloud.radius)),
                                          cutoff,
                                          Record::field_count,
                                          {}};
  for (int i = 0; i < cloud.size(); ++i) stage(team, i);
}

} // namespace loam::test
