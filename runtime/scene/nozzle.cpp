#include "scene/nozzle.h"

#include <algorithm>
#include <cmath>

#include "scene/checks.h"
#include "scene/pose.h"
#include "scene/triangle_mesh.h"

namespace loam {

namespace {

Vec3<double> wide(const float v[3]) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

[[noreturn]] void too_many(double places, std::uint64_t most) {
  throw Error(LOAM_ERROR_CAPACITY, format("a layer of the nozzle has about %.0f particles; particle_capacity is %llu",
                                          places, static_cast<unsigned long long>(most)));
}

// Axes at right angles to the flow.
void make_axes(Nozzle &nozzle) {
  const Vec3<double> n = nozzle.along;
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  const Vec3<double> least = x <= y && x <= z ? Vec3<double>{1, 0, 0}
                             : y <= z         ? Vec3<double>{0, 1, 0}
                                              : Vec3<double>{0, 0, 1};
  const Vec3<double> across = cross(n, least);
  nozzle.across[0] = (1 / std::sqrt(dot(across, across))) * across;
  nozzle.across[1] = cross(n, nozzle.across[0]);
}

void fill_disc(Nozzle &nozzle, double radius, double spacing, std::uint64_t most) {
  nozzle.area = 3.14159265358979323846 * radius * radius;
  const double estimate = nozzle.area / (spacing * spacing);
  if (!(estimate <= 1.3 * static_cast<double>(most) + 16)) too_many(estimate, most);
  const int half = static_cast<int>(radius / spacing) + 1;
  for (int j = -half; j <= half; ++j)
    for (int i = -half; i <= half; ++i) {
      const double u = i * spacing, v = j * spacing;
      if (u * u + v * v <= radius * radius) nozzle.places.push_back(u * nozzle.across[0] + v * nozzle.across[1]);
    }
}

// Triangles seen along the flow, on a raster eight times as fine as the lattice: it gives the area, its every eighth point is a place.
class Shadow {
public:
  Shadow(const Nozzle &nozzle, const std::vector<Vec3<double>> &vertices, double spacing) : step_(spacing / fine) {
    for (const Vec3<double> &x : vertices)
      points_.push_back({dot(x, nozzle.across[0]), dot(x, nozzle.across[1]), dot(x, nozzle.along)});
    low_ = high_ = points_.front();
    for (const Vec3<double> &p : points_) {
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), 0};
      high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y), 0};
    }
    columns_ = (high_.x - low_.x) / step_ + 1;
    rows_ = (high_.y - low_.y) / step_ + 1;
  }
  double places() const { return columns_ * rows_ / (fine * fine); }
  void draw(const std::vector<std::uint32_t> &indices) {
    width_ = static_cast<std::size_t>(columns_) + 1;
    heights_.assign(width_ * (static_cast<std::size_t>(rows_) + 1), empty);
    for (std::size_t t = 0; t + 2 < indices.size(); t += 3)
      draw(points_[indices[t]], points_[indices[t + 1]], points_[indices[t + 2]]);
  }
  void read(Nozzle &nozzle) const {
    std::size_t covered = 0;
    for (std::size_t at = 0; at < heights_.size(); ++at) {
      if (heights_[at] == empty) continue;
      ++covered;
      const std::size_t i = at % width_, j = at / width_;
      if (i % fine != fine / 2 || j % fine != fine / 2) continue;
      nozzle.places.push_back((low_.x + (static_cast<double>(i) + 0.5) * step_) * nozzle.across[0] +
                              (low_.y + (static_cast<double>(j) + 0.5) * step_) * nozzle.across[1] +
                              heights_[at] * nozzle.along);
    }
    nozzle.area = static_cast<double>(covered) * step_ * step_;
  }

private:
  static constexpr std::size_t fine = 8;
  static constexpr double empty = -1e300;
  void draw(Vec3<double> a, Vec3<double> b, Vec3<double> c) {
    const double twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (twice == 0) return; // seen from the side
    const auto first = [&](double low, double origin) {
      return static_cast<std::size_t>(std::max(0.0, (low - origin) / step_ - 0.5));
    };
    const std::size_t j0 = first(std::min({a.y, b.y, c.y}), low_.y), i0 = first(std::min({a.x, b.x, c.x}), low_.x);
    const double right = std::max({a.x, b.x, c.x}), top = std::max({a.y, b.y, c.y});
    for (std::size_t j = j0; j * width_ < heights_.size(); ++j) {
      const double y = low_.y + (static_cast<double>(j) + 0.5) * step_;
      if (y > top) break;
      for (std::size_t i = i0; i < width_; ++i) {
        const double x = low_.x + (static_cast<double>(i) + 0.5) * step_;
        if (x > right) break;
        const double s = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / twice;
        const double t = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / twice;
        if (s < 0 || t < 0 || s + t > 1) continue;
        double &height = heights_[j * width_ + i];
        height = std::max(height, a.z + s * (b.z - a.z) + t * (c.z - a.z));
      }
    }
  }

  double step_, columns_ = 0, rows_ = 0;
  std::size_t width_ = 0;
  std::vector<Vec3<double>> points_;
  Vec3<double> low_{}, high_{};
  std::vector<double> heights_;
};

} // namespace

Nozzle make_nozzle(const loam_emitter_def &def, double spacing, std::uint64_t most) {
  Nozzle nozzle;
  const Vec3<double> direction = wide(def.direction);
  nozzle.along = (1 / std::sqrt(dot(direction, direction))) * direction;
  make_axes(nozzle);
  if (def.nozzle == LOAM_NOZZLE_DISC) {
    fill_disc(nozzle, static_cast<double>(def.radius), spacing, most);
  } else {
    const TriangleMesh mesh = make_triangle_mesh(def.mesh, "mesh");
    const float identity[4] = {0, 0, 0, 1};
    const bool turned_not = def.rotation[0] == 0 && def.rotation[1] == 0 && def.rotation[2] == 0 && def.rotation[3] == 0;
    const Pose pose = make_pose(def.position, turned_not ? identity : def.rotation);
    std::vector<Vec3<double>> vertices;
    for (const Vec3<float> &x : mesh.vertices) {
      const Vec3<float> turned = rotate(pose.rotation, x);
      vertices.push_back({static_cast<double>(turned.x), static_cast<double>(turned.y), static_cast<double>(turned.z)});
    }
    Shadow shadow(nozzle, vertices, spacing);
    if (!(shadow.places() <= 16 * static_cast<double>(most) + 1e5)) too_many(shadow.places(), most);
    shadow.draw(mesh.indices);
    shadow.read(nozzle);
    if (nozzle.places.empty())
      throw Error(LOAM_ERROR_INVALID_MESH,
                  format("mesh has no place for a particle, as seen along direction: a lattice of %g m misses it", spacing));
  }
  if (nozzle.places.size() > most) too_many(static_cast<double>(nozzle.places.size()), most);
  return nozzle;
}

} // namespace loam
