#include "scene/cloth_threads.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/graph_colouring.h"

namespace loam {
namespace {

using Vector = Vec3<double>;

class ThreadFinder {
public:
  ThreadFinder(const ClothMesh &mesh, const Vector &warp)
      : mesh_(mesh), free_(mesh.edges.size()), edges_of_(mesh.vertices.size()) {
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
      if (!runs_along(mesh.edges[e], warp)) continue;
      free_[e] = true;
      edges_of_[at(mesh.edges[e].from)].push_back(static_cast<int>(e));
      edges_of_[at(mesh.edges[e].to)].push_back(static_cast<int>(e));
    }
  }

  struct Thread {
    std::vector<int> vertices, edges;
  };
  std::vector<Thread> find() {
    std::vector<Thread> threads;
    std::vector<int> taken(mesh_.vertices.size(), -1); // by which thread, last
    for (std::size_t e = 0; e < free_.size(); ++e) {
      if (!free_[e]) continue;
      free_[e] = false;
      const int number = static_cast<int>(threads.size());
      Thread thread = {{mesh_.edges[e].from, mesh_.edges[e].to}, {static_cast<int>(e)}};
      for (const int v : thread.vertices) taken[at(v)] = number;
      for (int side = 0; side < 2; ++side) {
        extend(thread, taken, number);
        std::reverse(thread.vertices.begin(), thread.vertices.end());
        std::reverse(thread.edges.begin(), thread.edges.end());
      }
      threads.push_back(std::move(thread));
    }
    return threads;
  }

private:
  Vector along(int from, int to) const {
    const Vec3<float> &a = mesh_.vertices[at(from)], &b = mesh_.vertices[at(to)];
    const Vector d = {double(b.x) - double(a.x), double(b.y) - double(a.y), double(b.z) - double(a.z)};
    return (1 / length(d)) * d;
  }
  bool runs_along(const ClothEdge &edge, const Vector &warp) const {
    const int *t = mesh_.triangles.data() + 3 * at(edge.triangle);
    const Vector normal = cross(along(t[0], t[1]), along(t[0], t[2]));
    const Vector own = along(edge.from, edge.to), u = warp_in_plane(warp, (1 / length(normal)) * normal);
    const double cosine = std::fabs(dot(own, u));
    return cosine > 0.966 || cosine < 0.259;
  }
  // Goes on from the last vertex as straight as can be, by at most 45 degrees.
  void extend(Thread &thread, std::vector<int> &taken, int number) {
    for (;;) {
      const int last = thread.vertices.back(), before = thread.vertices[thread.vertices.size() - 2];
      const Vector direction = along(before, last);
      double straightest = 0.7071;
      int best = -1, best_vertex = -1;
      for (const int e : edges_of_[at(last)]) {
        if (!free_[at(e)]) continue;
        const int to = mesh_.edges[at(e)].from == last ? mesh_.edges[at(e)].to : mesh_.edges[at(e)].from;
        const double cosine = dot(direction, along(last, to));
        if (taken[at(to)] == number || !(cosine > straightest)) continue;
        straightest = cosine;
        best = e;
        best_vertex = to;
      }
      if (best < 0) return;
      free_[at(best)] = false;
      taken[at(best_vertex)] = number;
      thread.edges.push_back(best);
      thread.vertices.push_back(best_vertex);
    }
  }

  const ClothMesh &mesh_;
  std::vector<bool> free_; // edges that belong to no thread yet
  std::vector<std::vector<int>> edges_of_;
};

} // namespace

Vec3<double> warp_in_plane(const Vec3<double> &warp, const Vec3<double> &normal) {
  const Vector choices[] = {warp, {1, 0, 0}, {0, 1, 0}};
  Vector along{};
  for (const Vector &choice : choices) {
    along = choice - dot(choice, normal) * normal;
    if (dot(along, along) > 1e-4 * dot(choice, choice)) break;
  }
  return (1 / length(along)) * along;
}

ClothThreadList make_threads(const ClothMesh &mesh, const Vec3<double> &warp, double greatest_stretch,
                             double stretch_stiffness) {
  const auto found = ThreadFinder(mesh, warp).find();
  std::vector<int> vertices, starts = {0};
  for (const auto &thread : found) {
    vertices.insert(vertices.end(), thread.vertices.begin(), thread.vertices.end());
    starts.push_back(static_cast<int>(vertices.size()));
  }
  Colours colours = colour_constraints(vertices, starts, static_cast<int>(mesh.vertices.size()));
  ClothThreadList list;
  list.colours = colours.starts;
  list.starts.push_back(0);
  // Within a colour from long to short: threads that lie side by side then end at about the same time.
  for (std::size_t c = 0; c + 1 < colours.starts.size(); ++c)
    std::stable_sort(colours.order.begin() + colours.starts[c], colours.order.begin() + colours.starts[c + 1],
                     [&](int a, int b) { return found[at(a)].vertices.size() > found[at(b)].vertices.size(); });
  for (const int i : colours.order) {
    const auto &thread = found[at(i)];
    for (std::size_t j = 0; j < thread.vertices.size(); ++j) {
      list.vertices.push_back(thread.vertices[j]);
      float longest = ClothThreadList::no_link, compliance = 1;
      int triangle = -1;
      if (j < thread.edges.size()) {
        const Vec3<float> d = mesh.vertices[at(thread.vertices[j + 1])] - mesh.vertices[at(thread.vertices[j])];
        const double rest = static_cast<double>(length(d));
        longest = static_cast<float>(rest * (1 + greatest_stretch));
        triangle = mesh.edges[at(thread.edges[j])].triangle;
        compliance =
            static_cast<float>(rest * rest / (10 * stretch_stiffness * double(mesh.edges[at(thread.edges[j])].area)));
      }
      list.greatest_lengths.push_back(longest);
      list.compliances.push_back(compliance);
      list.link_triangles.push_back(triangle);
    }
    list.starts.push_back(static_cast<int>(list.vertices.size()));
  }
  return list;
}

} // namespace loam
