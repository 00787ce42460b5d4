#include "material_point_method.h"

#include "strain.h"
#include <stdexcept>

namespace loam::reference {

struct MaterialPointMethod::Stencil {
  std::size_t node[27];
  double weight[27];
  Vector3<double> offset[27]; // x_i - x_p
};

void MaterialPointMethod::add_point(const Vector3<double> &position, const Vector3<double> &velocity, double volume) {
  Point point;
  point.position = position;
  point.velocity = velocity;
  point.volume = volume;
  point.mass = material_.density * volume;
  points_.push_back(point);
}

void MaterialPointMethod::add_plane(const Vector3<double> &point, const Vector3<double> &normal, Boundary boundary,
                                    double friction) {
  planes_.push_back({point, normal.normalized(), boundary, friction});
}

double MaterialPointMethod::stable_step() const {
  const double wave = std::sqrt((material_.lame_lambda + 2 * material_.shear_modulus) / material_.density);
  double fastest = 0;
  for (const Point &point : points_) fastest = std::max(fastest, point.velocity.norm());
  return settings_.courant * settings_.cell / (wave + fastest);
}

void MaterialPointMethod::fit_grid() {
  Vector3<double> lowest = points_.front().position, highest = lowest;
  for (const Point &point : points_) {
    if (!point.position.allFinite()) throw std::runtime_error("material point method: a position is not finite");
    lowest = lowest.cwiseMin(point.position);
    highest = highest.cwiseMax(point.position);
  }
  double count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = std::floor(lowest[axis] / settings_.cell - 0.5),
                 high = std::floor(highest[axis] / settings_.cell - 0.5);
    count *= high - low + 3;
    if (count > 1e8) throw std::runtime_error("material point method: the points lie too far apart");
    first_[axis] = int(low);
    size_[axis] = int(high - low) + 3;
  }
  nodes_.assign(std::size_t(count), {Vector3<double>::Zero(), 0});
}

MaterialPointMethod::Stencil MaterialPointMethod::stencil(const Vector3<double> &position) const {
  Stencil result;
  double weight[3][3], offset[3][3];
  int base[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double x = position[axis] / settings_.cell;
    base[axis] = int(std::floor(x - 0.5));
    for (int k = 0; k < 3; ++k) {
      const double distance = base[axis] + k - x, beyond = 1.5 - std::fabs(distance);
      weight[axis][k] = k == 1 ? 0.75 - distance * distance : beyond * beyond / 2;
      offset[axis][k] = distance * settings_.cell;
    }
    base[axis] -= first_[axis];
  }
  for (int k = 0; k < 27; ++k) {
    const int x = k / 9, y = k / 3 % 3, z = k % 3;
    result.node[k] = (std::size_t(base[0] + x) * std::size_t(size_[1]) + std::size_t(base[1] + y)) * std::size_t(size_[2]) +
                     std::size_t(base[2] + z);
    result.weight[k] = weight[0][x] * weight[1][y] * weight[2][z];
    result.offset[k] = {offset[0][x], offset[1][y], offset[2][z]};
  }
  return result;
}

void MaterialPointMethod::scatter(double h) {
  const double inverse_moment = 4 / (settings_.cell * settings_.cell);
  for (const Point &point : points_) {
    const PrincipalStrain<double> principal = principal_hencky_strain(point.strain, 10.0);
    const Matrix3<double> stress = compose(principal.directions, material_.kirchhoff_stress(principal.strain));
    const Matrix3<double> affine = point.mass * point.affine - h * point.volume * inverse_moment * stress;
    const Vector3<double> momentum = point.mass * point.velocity;
    const Stencil near = stencil(point.position);
    for (int k = 0; k < 27; ++k) {
      Node &node = nodes_[near.node[k]];
      node.mass += near.weight[k] * point.mass;
      node.velocity += near.weight[k] * (momentum + affine * near.offset[k]);
    }
  }
}

void MaterialPointMethod::move_nodes(double h) {
  std::size_t index = 0;
  for (int x = 0; x < size_[0]; ++x)
    for (int y = 0; y < size_[1]; ++y)
      for (int z = 0; z < size_[2]; ++z) {
        Node &node = nodes_[index++];
        if (node.mass == 0) continue;
        node.velocity = node.velocity / node.mass + h * settings_.gravity;
        const Vector3<double> position = settings_.cell * Vector3<double>(first_[0] + x, first_[1] + y, first_[2] + z);
        for (const Plane &plane : planes_) {
          if (plane.normal.dot(position - plane.point) > 1e-6 * settings_.cell) continue;
          const double across = plane.normal.dot(node.velocity);
          const Vector3<double> along = node.velocity - across * plane.normal;
          if (plane.boundary == Boundary::sticky)
            node.velocity.setZero();
          else if (plane.boundary == Boundary::slip)
            node.velocity = along;
          else if (across < 0)
            node.velocity = along * std::max(0.0, 1 + plane.friction * across / std::max(along.norm(), 1e-300));
        }
      }
}

void MaterialPointMethod::gather(double h) {
  const double inverse_moment = 4 / (settings_.cell * settings_.cell);
  for (Point &point : points_) {
    const Stencil near = stencil(point.position);
    Vector3<double> velocity = Vector3<double>::Zero();
    Matrix3<double> affine = Matrix3<double>::Zero();
    for (int k = 0; k < 27; ++k) {
      const Vector3<double> weighted = near.weight[k] * nodes_[near.node[k]].velocity;
      velocity += weighted;
      affine += weighted * near.offset[k].transpose();
    }
    point.velocity = velocity;
    point.affine = inverse_moment * affine;
    point.position += h * velocity;

    const Matrix3<double> trial = reference::advance<double>(point.strain, h * point.affine);
    const PrincipalStrain<double> principal = principal_hencky_strain(trial, 10.0);
    const ReturnMapping<double> mapped = material_.project(principal.strain, point.volume_correction);
    point.volume_correction = mapped.volume_correction;
    point.strain = mapped.yielded ? strain_from_hencky(principal.directions, mapped.strain) : trial;
  }
}

void MaterialPointMethod::advance(double h) {
  if (points_.empty()) return;
  fit_grid();
  scatter(h);
  move_nodes(h);
  gather(h);
}

void MaterialPointMethod::run(double seconds) {
  for (double left = seconds; left > 0;) {
    const double h = std::min(stable_step(), left);
    advance(h);
    left -= h;
  }
}

} // namespace loam::reference
