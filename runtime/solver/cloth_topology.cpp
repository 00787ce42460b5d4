#include "solver/cloth_topology.h"

#include <algorithm>
#include <numeric>

namespace loam {

ClothTopology::ClothTopology(const SolverCloth &whole)
    : whole_(whole), corners_(whole.triangles), origins_(whole.positions.size()),
      whole_vertex_count_(static_cast<int>(whole.positions.size())), vertex_count_(whole_vertex_count_) {
  std::iota(origins_.begin(), origins_.end(), 0);
  whole_.positions.clear();
  whole_.velocities.clear();
  whole_.rest.clear();
}

int ClothTopology::vertex_of(int triangle, int origin) const {
  const std::size_t first = 3 * at(triangle);
  for (std::size_t k = first; k < first + 2; ++k)
    if (whole_.triangles[k] == origin) return corners_[k];
  return corners_[first + 2];
}

bool ClothTopology::is_whole(std::size_t hinge) const {
  const int *t = whole_.parts.hinge_triangles.data() + 2 * hinge, *v = whole_.hinges.indices.data() + 4 * hinge;
  return vertex_of(t[0], v[0]) == vertex_of(t[1], v[0]) && vertex_of(t[0], v[1]) == vertex_of(t[1], v[1]);
}

void ClothTopology::find_triangles_around(std::vector<int> &starts, std::vector<int> &list) const {
  starts.assign(at(vertex_count_) + 1, 0);
  list.resize(corners_.size());
  for (const int v : corners_) ++starts[at(v) + 1];
  for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
  std::vector<int> next(starts.begin(), starts.end() - 1);
  for (std::size_t i = 0; i < corners_.size(); ++i) list[at(next[at(corners_[i])]++)] = static_cast<int>(i / 3);
}

// ---------------------------------------------------------------------------------------------------------- tearing ---

// The vertices at which an edge that has come apart ends.
std::vector<bool> ClothTopology::find_ends() const {
  std::vector<bool> ends(at(vertex_count_));
  for (std::size_t h = 0; h < whole_.hinges.indices.size() / 4; ++h) {
    if (is_whole(h)) continue;
    const int *t = whole_.parts.hinge_triangles.data() + 2 * h, *v = whole_.hinges.indices.data() + 4 * h;
    for (int k = 0; k < 2; ++k)
      if (const int vertex = vertex_of(t[0], v[k]); vertex == vertex_of(t[1], v[k])) ends[at(vertex)] = true;
  }
  return ends;
}

struct ClothTopology::Splitter {
  ClothTopology &cloth;
  const std::vector<Row> &positions;
  const std::vector<TriangleStrain> &strains;
  std::vector<int> starts, list; // the triangles around each vertex before any split
  std::vector<bool> touched;     // vertices around a split
  std::vector<int> &from;

  Splitter(ClothTopology &cloth, const std::vector<Row> &positions, const std::vector<TriangleStrain> &strains,
           std::vector<int> &from)
      : cloth(cloth), positions(positions), strains(strains), touched(at(cloth.vertex_count_)), from(from) {
    cloth.find_triangles_around(starts, list);
  }

  float mean_strain(int v) const {
    float sum = 0;
    for (int k = starts[at(v)]; k < starts[at(v) + 1]; ++k) sum += strains[at(list[at(k)])].strain;
    return sum / static_cast<float>(starts[at(v) + 1] - starts[at(v)]);
  }

  // Do two triangles around v share an edge that ends there?
  bool are_beside(int s, int t, int v) const {
    for (std::size_t i = 3 * at(s); i < 3 * at(s) + 3; ++i)
      for (std::size_t j = 3 * at(t); j < 3 * at(t) + 3; ++j)
        if (cloth.corners_[i] == cloth.corners_[j] && cloth.corners_[i] != v) return true;
    return false;
  }

  // The triangles around v part into those on one side of the plane across `normal` and those on the other; false if all are on one.
  bool split(int v, const Vec3<float> &normal) {
    const std::vector<int> fan(list.begin() + starts[at(v)], list.begin() + starts[at(v) + 1]);
    const Vec3<float> x = xyz(positions[at(v)]);
    std::vector<int> part(fan.size(), -1);
    std::vector<bool> side;
    for (const int t : fan) {
      Vec3<float> middle = {0, 0, 0};
      for (std::size_t k = 3 * at(t); k < 3 * at(t) + 3; ++k) middle = middle + (xyz(positions[at(cloth.corners_[k])]) - x);
      side.push_back(dot(middle, normal) > 0.0f);
    }
    if (std::count(side.begin(), side.end(), side.front()) == static_cast<std::ptrdiff_t>(fan.size())) return false;
    // Parts: triangles side by side on the same side of the plane.
    int parts = 0;
    std::vector<int> size;
    for (std::size_t first = 0; first < fan.size(); ++first) {
      if (part[first] >= 0) continue;
      std::vector<std::size_t> open = {first};
      part[first] = parts;
      size.push_back(0);
      while (!open.empty()) {
        const std::size_t i = open.back();
        open.pop_back();
        ++size.back();
        for (std::size_t j = 0; j < fan.size(); ++j)
          if (part[j] < 0 && side[j] == side[i] && are_beside(fan[i], fan[j], v)) {
            part[j] = parts;
            open.push_back(j);
          }
      }
      ++parts;
    }
    // The largest keeps the vertex, and what holds it.
    const int keeps = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
    for (int p = 0; p < parts; ++p) {
      if (p == keeps) continue;
      for (std::size_t i = 0; i < fan.size(); ++i)
        if (part[i] == p)
          for (std::size_t k = 3 * at(fan[i]); k < 3 * at(fan[i]) + 3; ++k)
            if (cloth.corners_[k] == v) cloth.corners_[k] = cloth.vertex_count_;
      cloth.origins_.push_back(cloth.origin(v));
      from.push_back(v);
      ++cloth.vertex_count_;
    }
    for (const int t : fan)
      for (std::size_t k = 3 * at(t); k < 3 * at(t) + 3; ++k)
        if (at(cloth.corners_[k]) < touched.size()) touched[at(cloth.corners_[k])] = true;
    touched[at(v)] = true;
    return true;
  }

  // Splits one of a triangle's vertices, the one that is strained most all around.
  bool split_at(int triangle, const std::vector<bool> *ends) {
    int candidates[3];
    std::copy_n(cloth.corners_.begin() + 3 * triangle, 3, candidates);
    for (const int v : candidates)
      if (at(v) >= touched.size() || touched[at(v)]) return false;
    std::stable_sort(candidates, candidates + 3, [&](int a, int b) { return mean_strain(a) > mean_strain(b); });
    for (const int v : candidates)
      if ((ends == nullptr || (*ends)[at(v)]) && split(v, strains[at(triangle)].direction)) return true;
    return false;
  }
};

int ClothTopology::tear(const std::vector<Row> &positions, const std::vector<TriangleStrain> &strains, float bound,
                        std::vector<int> &from) {
  std::vector<int> strained;
  for (std::size_t t = 0; t < strains.size(); ++t)
    if (strains[t].strain > bound) strained.push_back(static_cast<int>(t));
  std::stable_sort(strained.begin(), strained.end(),
                   [&](int a, int b) { return strains[at(a)].strain > strains[at(b)].strain; });
  const int before = vertex_count_;
  const std::vector<bool> ends = find_ends();
  Splitter splitter(*this, positions, strains, from);
  for (const int t : strained) (void)splitter.split_at(t, &ends);
  if (vertex_count_ == before)
    for (const int t : strained)
      if (splitter.split_at(t, nullptr)) break;
  return vertex_count_ - before;
}

// ------------------------------------------------------------------------------------------------------ snapshots ---

std::vector<TornCorner> ClothTopology::torn_corners() const {
  std::vector<TornCorner> torn;
  for (std::size_t i = 0; i < corners_.size(); ++i)
    if (corners_[i] != whole_.triangles[i]) torn.push_back({static_cast<int>(i), corners_[i]});
  return torn;
}

int ClothTopology::vertex_count(const std::vector<TornCorner> &torn) const {
  int count = whole_vertex_count_;
  for (const TornCorner &c : torn) count = std::max(count, c.vertex + 1);
  return count;
}

bool ClothTopology::accepts(const std::vector<TornCorner> &torn) const {
  std::vector<int> corners = whole_.triangles;
  for (std::size_t i = 0; i < torn.size(); ++i) {
    const TornCorner &c = torn[i];
    if (c.corner < 0 || at(c.corner) >= corners.size() || (i > 0 && c.corner <= torn[i - 1].corner)) return false;
    if (c.vertex < whole_vertex_count_ || c.vertex >= most_vertices()) return false;
    corners[at(c.corner)] = c.vertex;
  }
  // Every vertex is somewhere, and everywhere of the same origin.
  std::vector<int> origins(at(vertex_count(torn)), -1);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    int &origin = origins[at(corners[i])];
    if (origin >= 0 && origin != whole_.triangles[i]) return false;
    origin = whole_.triangles[i];
  }
  return std::find(origins.begin(), origins.end(), -1) == origins.end();
}

void ClothTopology::set_torn_corners(const std::vector<TornCorner> &torn) {
  corners_ = whole_.triangles;
  vertex_count_ = vertex_count(torn);
  origins_.resize(at(vertex_count_));
  for (const TornCorner &c : torn) {
    corners_[at(c.corner)] = c.vertex;
    origins_[at(c.vertex)] = whole_.triangles[at(c.corner)];
  }
}

// ----------------------------------------------------------------------------------------------------- constraints ---

ClothConstraintList ClothTopology::membrane() const {
  ClothConstraintList list = whole_.membrane;
  for (std::size_t i = 0; i < whole_.parts.membrane_triangles.size(); ++i)
    std::copy_n(corners_.begin() + 3 * whole_.parts.membrane_triangles[i], 3,
                list.indices.begin() + 3 * static_cast<std::ptrdiff_t>(i));
  return list;
}

ClothConstraintList ClothTopology::hinges() const {
  ClothConstraintList list = whole_.hinges;
  const std::size_t count = list.indices.size() / 4, width = count > 0 ? list.fields.size() / count : 0;
  for (std::size_t h = 0; h < count; ++h) {
    const int *t = whole_.parts.hinge_triangles.data() + 2 * h;
    int *v = list.indices.data() + 4 * h;
    const bool whole = is_whole(h);
    for (int k = 0; k < 3; ++k) v[k] = vertex_of(t[0], v[k]);
    v[3] = vertex_of(t[1], v[3]);
    if (!whole)
      for (const int field : {0, 1, 2, 3}) list.fields[h * width + at(field)] = 0.0f; // its weights, and the sum at rest
  }
  return list;
}

ClothThreadList ClothTopology::threads() const {
  ClothThreadList list = whole_.threads;
  const std::vector<int> &link_triangles = whole_.parts.link_triangles;
  for (std::size_t thread = 0; thread + 1 < list.starts.size(); ++thread) {
    const auto first = at(list.starts[thread]), last = at(list.starts[thread + 1]) - 1;
    for (std::size_t j = first; j <= last; ++j) {
      const int origin = whole_.threads.vertices[j];
      const bool linked_back = j > first && list.greatest_lengths[j - 1] < ClothThreadList::no_link;
      const int before = j > first ? vertex_of(link_triangles[j - 1], origin) : -1;
      if (j == last) {
        list.vertices[j] = before;
        break;
      }
      const int after = vertex_of(link_triangles[j], origin);
      list.vertices[j] = linked_back ? before : after;
      if (list.vertices[j] != after) list.greatest_lengths[j] = ClothThreadList::no_link;
    }
  }
  return list;
}

std::vector<float> ClothTopology::inverse_masses() const {
  std::vector<double> masses(at(vertex_count_));
  for (std::size_t i = 0; i < corners_.size(); ++i)
    masses[at(corners_[i])] +=
        static_cast<double>(whole_.material.areal_density) * static_cast<double>(whole_.parts.areas[i / 3]) / 3;
  std::vector<float> result;
  for (const double mass : masses) result.push_back(static_cast<float>(1 / mass));
  return result;
}

} // namespace loam
