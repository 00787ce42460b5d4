/* One particle amid its neighbours, deformed by prescribed steps: the end-of-substep kernel alone, on one neighbourhood. For tests of the insides. */
#pragma once

#include <variant>

#include "kernels/inelastic/update_strain.h"
#include "scene/material.h"
#include "support/scalar_team.h"
#include "support/tensors.h"

namespace loam::test {

class MaterialPoint {
public:
  explicit MaterialPoint(const loam_material_def &def) : law_(make_law(def)) {
    for (int k = 0; k < 27; ++k)
      cloud_.add({0.01f * float(k % 3 - 1), 0.01f * float(k / 3 % 3 - 1), 0.01f * float(k / 9 - 1)}, 1e-6f, 600);
    cloud_.find_neighbours();
    compute_gradients(cloud_);
    std::visit([&](const auto &law) { cloud_.histories[centre] = law.initial_history(); }, law_);
  }

  /* A step of h seconds in which F becomes (I + H) F. */
  void deform(const Matrix &H, double h = 1) {
    for (std::size_t i = 0; i < cloud_.positions.size(); ++i) {
      const Row &x = cloud_.positions[i];
      const Vector v = H * Vector(double(x.x), double(x.y), double(x.z)) / h;
      cloud_.velocities[i] = {float(v.x()), float(v.y()), float(v.z()), 600};
    }
    ScalarTeam team{cloud_};
    const float *s = &cloud_.strains[6 * centre];
    team.set_symmetric(centre, Record::strain, {s[0], s[1], s[2], s[3], s[4], s[5]});
    team.set_field(centre, Record::history, cloud_.histories[centre]);
    std::visit(
        [&](const auto &law) {
          using Law = std::remove_cvref_t<decltype(law)>;
          const UpdateStrain<Law, false> stage{law,
                                               strain_limit(Law::greatest_strain),
                                               float(h),
                                               cloud_.strains.data(),
                                               cloud_.histories.data(),
                                               cloud_.log_volumes.data(),
                                               nullptr,
                                               0.0f,
                                               nullptr,
                                               nullptr,
                                               cloud_.neighbour_counts.data(),
                                               &limited_,
                                               &decomposed_};
          stage(team, centre);
        },
        law_);
  }

  Matrix hencky_strain() const {
    const float *s = &cloud_.strains[6 * centre];
    return apply(widen(Sym3<float>{s[0], s[1], s[2], s[3], s[4], s[5]}), [](double x) { return 0.5 * std::log1p(x); });
  }
  Matrix kirchhoff_stress() const {
    const Matrix e = hencky_strain();
    return std::visit(
        [&](const auto &law) -> Matrix {
          return double(law.stiffness(cloud_.histories[centre])) *
                 (2 * double(law.lame.mu) * e + double(law.lame.lambda) * e.trace() * Matrix::Identity());
        },
        law_);
  }
  double pressure() const { return -kirchhoff_stress().trace() / 3; }
  /* Von Mises' equivalent stress, sqrt(3/2) |dev tau|; under axial symmetry the difference of the principal stresses. */
  double equivalent_stress() const { return std::sqrt(1.5) * deviator(kirchhoff_stress()).norm(); }
  double history() const { return double(cloud_.histories[centre]); }
  void set_history(double value) { cloud_.histories[centre] = float(value); }
  double log_volume() const { return double(cloud_.log_volumes[centre]); }
  int limited() const { return limited_; } // how often the bound on strains acted
  double bulk() const {
    return std::visit([](const auto &law) { return double(law.bulk()); }, law_);
  }
  double shear_modulus() const {
    return std::visit([](const auto &law) { return double(law.lame.mu); }, law_);
  }

private:
  static constexpr int centre = 13;
  Cloud cloud_;
  LawVariant law_;
  int limited_ = 0, decomposed_ = 0;
};

} // namespace loam::test
