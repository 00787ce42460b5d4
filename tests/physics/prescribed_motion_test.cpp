/* Affine motion is followed exactly, rotations strain nothing, and yielding matter meets the closed forms of its law. */
#include "prescribed_motion.h"

namespace loam {
namespace {

using test::Matrix;
using test::Vector;

constexpr double pi = 3.14159265358979323846;

TEST(AffinePatch, OneStepStrainsEveryParticleByTheVelocityGradient) {
  test::RandomTensors random(1);
  const scenes::Scene cloud = test::centred_cloud(scenes::rubber(), 5);
  for (int k = 0; k < 3; ++k) {
    const Matrix A = random.matrix(1);
    scenes::World world = test::prescribed(cloud, A);
    const double h = 1e-3;
    world.step(float(h));
    const Matrix D = Matrix::Identity() + h * A, expected = D * D.transpose() - Matrix::Identity();
    const scenes::Snapshot now = world.snapshot();
    for (std::size_t i = 0; i < now.count(); ++i) {
      EXPECT_LT((test::strain_of(now, i) - expected).norm(), 1e-5 * expected.norm()) << i;
      EXPECT_NEAR(double(now.volumes[i]) / double(cloud.volume()), D.determinant(), 1e-6);
    }
  }
}

TEST(AffinePatch, ManyStepsFollowTheDeformationGradient) {
  Matrix A;
  A << -1, 2, 0.5, 0, 1, -1.5, 0.3, 0, 0.7;
  scenes::World world = test::prescribed(test::centred_cloud(scenes::rubber(), 5), A, 50);
  world.step(0.1f); // stretches up to a quarter
  const Matrix F = Matrix::Identity() + 0.1 * A, expected = F * F.transpose() - Matrix::Identity();
  const scenes::Snapshot now = world.snapshot();
  for (std::size_t i = 0; i < now.count(); ++i)
    EXPECT_LT((test::strain_of(now, i) - expected).norm(), 1e-4 * expected.norm()) << i;
}

TEST(Objectivity, AFiniteRotationStrainsNothing) {
  for (const double angle : {0.01, 0.1, 0.3}) {
    const double h = 1e-3;
    const Matrix R = Eigen::AngleAxisd(angle, Vector(1, 2, -1).normalized()).toRotationMatrix();
    scenes::World world = test::prescribed(test::centred_cloud(scenes::rubber(), 4), (R - Matrix::Identity()) / h);
    world.step(float(h));
    EXPECT_EQ(world.statistics().speed_limited, 0u);
    const scenes::Snapshot now = world.snapshot();
    for (std::size_t i = 0; i < now.count(); ++i) EXPECT_LT(test::strain_of(now, i).norm(), 1e-4 * angle) << angle;
  }
}

TEST(AffinePatch, StrainsBeyondThePolynomialsRangeAreCounted) {
  const scenes::Scene cloud = test::centred_cloud(scenes::rubber(), 4);
  for (const auto &[rate, times] : {std::pair(50.0, 0u), std::pair(400.0, 64u)}) { // stretches of .05 and .4 in one step
    scenes::World world = test::prescribed(cloud, Vector(rate, 0, 0).asDiagonal().toDenseMatrix());
    world.step(1e-3f);
    EXPECT_EQ(world.statistics().strain_decomposed, times);
    EXPECT_EQ(world.statistics().strain_limited, 0u);
  }
}

/* Principal stresses, least compression first, of the particle in the middle after A for 0.1 s. */
Vector principal_stresses(const loam_material_def &material, const Matrix &A) {
  const scenes::Scene cloud = test::centred_cloud(material, 5);
  scenes::World world = test::prescribed(cloud, A, 100);
  world.step(0.1f);
  const Matrix stress = test::kirchhoff_stress(material, test::strain_of(world.snapshot(), cloud.count() / 2));
  const Vector principal = Eigen::SelfAdjointEigenSolver<Matrix>(stress).eigenvalues();
  return {-principal[2], -principal[1], -principal[0]};
}

TEST(DruckerPrager, TriaxialCompressionMeetsMohrCoulomb) {
  const Matrix A = Vector(-0.5, 0.1, 0.1).asDiagonal();
  for (const auto &[degrees, ratio] : {std::pair(30.0f, 3.0), std::pair(35.0f, 3.69), std::pair(20.0f, 2.04)}) {
    const Vector s = principal_stresses(scenes::sand(degrees), A);
    EXPECT_NEAR(s[2] / s[0], ratio, 0.01 * ratio);
    EXPECT_NEAR(s[1] / s[0], 1, 0.01);
    EXPECT_GT(s[0], 1000); // under load, not at the tip
  }
}

TEST(DruckerPrager, CohesionIsTheShearStressBorneWithoutPressure) {
  // s1 = s3 N + 2 c sqrt(N), N = (1 + sin) / (1 - sin): Mohr and Coulomb in triaxial compression
  loam_material_def material = scenes::sand(30);
  material.cohesion = 2000;
  const Vector s = principal_stresses(material, Vector(-0.5, 0.1, 0.1).asDiagonal());
  EXPECT_NEAR(s[2], 3 * s[0] + 2 * 2000 * std::sqrt(3.0), 0.01 * s[2]);
  // Pulled apart on all sides it bears c cot(phi), and without cohesion nothing.
  const Matrix apart = Matrix::Identity();
  EXPECT_NEAR(principal_stresses(material, apart)[0], -2000 * std::sqrt(3.0), 0.01 * 2000);
  EXPECT_NEAR(principal_stresses(scenes::sand(30), apart)[0], 0, 1);
}

TEST(VonMises, ABarYieldsAtTheUniaxialYieldStress) {
  for (const double sign : {1.0, -1.0}) {
    const Vector s =
        principal_stresses(scenes::plasticine(5e3f), sign * Vector(0.5, -0.25, -0.25).asDiagonal().toDenseMatrix());
    EXPECT_NEAR(s[2] - s[0], 5e3, 50);
  }
  // Below yield it is elastic: 2 mu (e1 - e2) for log strains of t A.
  const Vector s = principal_stresses(scenes::plasticine(5e7f), Vector(0.5, -0.25, -0.25).asDiagonal());
  EXPECT_NEAR(s[2] - s[0], 1e6 / 1.3 * (std::log(1.05) - std::log(0.975)), 0.01 * 5e4);
}

TEST(Elastic, HydrostaticPressureIsBulkModulusTimesLogVolume) {
  loam_material_def material = scenes::rubber(1e5f);
  const Vector s = principal_stresses(material, -0.5 * Matrix::Identity());
  const double bulk = 1e5 / (3 * (1 - 0.6));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(s[k], -bulk * 3 * std::log(0.95), 0.01 * s[k]);
}

TEST(DruckerPrager, ShearAtGivenPressureStopsAtTheConeOfTheFrictionAngle) {
  // |dev tau| = sqrt(2/3) 2 sin / (3 - sin) times 3 p
  Matrix A;
  A << -0.2, 3, 0, 0, -0.2, 0, 0, 0, -0.2;
  for (const double degrees : {20.0, 30.0, 40.0}) {
    const Vector s = principal_stresses(scenes::sand(float(degrees)), A);
    const double p = s.mean(), sine = std::sin(degrees * pi / 180);
    EXPECT_NEAR((s.array() - p).matrix().norm(), std::sqrt(2.0 / 3) * 2 * sine / (3 - sine) * 3 * p, 0.01 * p) << degrees;
  }
}

} // namespace
} // namespace loam
