/* Sand that is pulled apart and pushed together again must come back without pressure. The end-of-substep kernel alone, on one neighbourhood. */
#include <gtest/gtest.h>

#include "kernels/inelastic/update_strain.h"
#include "scene/material.h"
#include "support/scalar_team.h"
#include "support/tensors.h"

namespace loam {
namespace {

using test::Matrix;
using test::Vector;

/* One particle amid its neighbours, deformed by prescribed steps. */
class MaterialPoint {
public:
  explicit MaterialPoint(DruckerPrager law, bool corrected) : law_(law), corrected_(corrected) {
    for (int k = 0; k < 27; ++k)
      cloud_.add({0.01f * float(k % 3 - 1), 0.01f * float(k / 3 % 3 - 1), 0.01f * float(k / 9 - 1)}, 1e-6f, 600);
    cloud_.find_neighbours();
  }
  void deform(const Matrix &H) {
    for (std::size_t i = 0; i < cloud_.positions.size(); ++i) {
      const Row &x = cloud_.positions[i];
      const Vector v = H * Vector(x.x, x.y, x.z);
      cloud_.velocities[i] = {float(v.x()), float(v.y()), float(v.z()), 600};
    }
    if (!corrected_) cloud_.histories[centre] = 0;
    test::compute_gradients(cloud_);
    test::ScalarTeam team{cloud_};
    int limited = 0;
    const UpdateStrain<DruckerPrager> stage{law_,
                                            strain_limit(DruckerPrager::greatest_strain),
                                            1.0f,
                                            cloud_.strains.data(),
                                            cloud_.histories.data(),
                                            cloud_.log_volumes.data(),
                                            cloud_.neighbour_counts.data(),
                                            &limited};
    stage(team, centre);
  }
  double pressure() const {
    const float *s = &cloud_.strains[6 * centre];
    const Matrix e = test::apply(test::widen(Sym3<float>{s[0], s[1], s[2], s[3], s[4], s[5]}),
                                 [](double x) { return 0.5 * std::log1p(x); });
    return -(double(law_.lame.lambda) + 2.0 / 3 * double(law_.lame.mu)) * e.trace();
  }
  double log_volume() const { return double(cloud_.log_volumes[centre]); }

private:
  static constexpr int centre = 13;
  test::Cloud cloud_;
  DruckerPrager law_;
  bool corrected_;
};

/* The pressure left after three cycles of 0.1 of stretch in all directions and back. */
double pressure_after_cycles(bool corrected) {
  MaterialPoint point(std::get<DruckerPrager>(make_law(default_material(LOAM_LAW_DRUCKER_PRAGER))), corrected);
  for (int cycle = 0; cycle < 3; ++cycle) {
    for (int step = 0; step < 1000; ++step) point.deform(1e-4 * Matrix::Identity());
    for (int step = 0; step < 1000; ++step) point.deform(Matrix::Identity() / 1.0001 - Matrix::Identity());
  }
  EXPECT_NEAR(point.log_volume(), 0, 1e-4); // the true volume is back
  return point.pressure();
}

TEST(VolumeCorrection, CyclesOfStretchLeaveNoPressure) { EXPECT_LT(std::fabs(pressure_after_cycles(true)), 1e3); }

TEST(VolumeCorrection, WithoutItTheyWouldLeaveAHundredKilopascals) { EXPECT_GT(pressure_after_cycles(false), 1e5); }

TEST(VolumeCorrection, ExpansionMustBeUndoneBeforePressureBuildsUp) {
  MaterialPoint point(std::get<DruckerPrager>(make_law(default_material(LOAM_LAW_DRUCKER_PRAGER))), true);
  point.deform(0.02 * Matrix::Identity());
  EXPECT_NEAR(point.pressure(), 0, 1);
  point.deform(-0.01 * Matrix::Identity());
  EXPECT_NEAR(point.pressure(), 0, 1); // still looser than at the start
  point.deform(-0.02 * Matrix::Identity());
  EXPECT_NEAR(point.pressure(), 1e6 / 1.2 * -3 * std::log(1.02 * 0.99 * 0.98), 2000);
}

} // namespace
} // namespace loam
