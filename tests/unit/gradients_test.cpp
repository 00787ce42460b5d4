/* Corrected kernel gradients, over clouds of every shape. */
#include <gtest/gtest.h>

#include "kernels/inelastic/kinematics.h"
#include "support/scalar_team.h"
#include "support/tensors.h"

namespace loam {
namespace {

using test::Cloud;
using test::Matrix;
using test::RandomTensors;
using test::ScalarTeam;
using test::Vector;

constexpr float r = 0.01f, volume = r * r * r;

Vec3<float> place(const Vector &x) { return {float(x.x()), float(x.y()), float(x.z())}; }

Cloud jittered_cube(int edge, double jitter, double inverse_mass_spread = 0) {
  RandomTensors random(1);
  Cloud cloud;
  for (int x = 0; x < edge; ++x)
    for (int y = 0; y < edge; ++y)
      for (int z = 0; z < edge; ++z)
        cloud.add(place(double(r) * (Vector(x, y, z) + random.vector(jitter))), volume * float(random.between(0.7, 1.3)),
                  float(1000 * std::exp(random.between(-1, 1) * inverse_mass_spread)));
  cloud.find_neighbours();
  return cloud;
}

Matrix velocity_gradient(Cloud &cloud, int p) {
  ScalarTeam team{cloud};
  const Vec3<float> s = team.vector(p, Record::gradient_sum);
  return test::widen(velocity_gradient_step(team, p, 1.0f, team.velocity(p).xyz(), s));
}

void set_linear_velocities(Cloud &cloud, const Matrix &gradient) {
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    const Row &x = cloud.positions[i];
    const Vector v = gradient * Vector(x.x, x.y, x.z);
    cloud.velocities[i] = {float(v.x()), float(v.y()), float(v.z()), cloud.velocities[i].w};
  }
}

TEST(Gradients, OfALinearFieldAreExactOnADisorderedCloud) {
  Cloud cloud = jittered_cube(7, 0.3);
  test::compute_gradients(cloud, 0.01f);
  RandomTensors random(8);
  for (int k = 0; k < 3; ++k) {
    const Matrix gradient = random.matrix(2);
    set_linear_velocities(cloud, gradient);
    for (int p = 0; p < cloud.size(); ++p) // corners, edges and faces included
      EXPECT_LT((velocity_gradient(cloud, p) - gradient).norm(), 1e-5 * gradient.norm()) << p;
  }
}

TEST(Gradients, WithoutTheCorrectionWouldBeFarOff) { // the control: what the correction is for
  Cloud cloud = jittered_cube(7, 0.3);
  test::compute_gradients(cloud, 10.0f); // cuts everything
  set_linear_velocities(cloud, Matrix::Identity());
  for (int p = 0; p < cloud.size(); ++p) EXPECT_EQ(velocity_gradient(cloud, p).norm(), 0);
}

TEST(Gradients, SumAndSquareAreThoseOfTheGradients) {
  Cloud cloud = jittered_cube(5, 0.2, 1);
  test::compute_gradients(cloud);
  for (int p = 0; p < cloud.size(); ++p) {
    const auto i = std::size_t(p);
    Matrix square = Matrix::Zero();
    Vector sum = Vector::Zero();
    for (std::size_t k = 0; k < cloud.neighbours[i].size(); ++k) {
      const Vec3<float> g = cloud.gradients[i][k];
      const Vector G(g.x, g.y, g.z);
      square += double(cloud.velocities[std::size_t(cloud.neighbours[i][k])].w) * G * G.transpose();
      sum += G;
    }
    ScalarTeam team{cloud};
    EXPECT_LT((test::widen(team.symmetric(p, Record::gradient_square)) - square).norm(), 1e-5 * square.norm());
    const Vec3<float> s = team.vector(p, Record::gradient_sum);
    EXPECT_LT((Vector(s.x, s.y, s.z) - sum).norm(), 1e-4 / double(r) * 1e-1);
    EXPECT_EQ(team.field(p, Record::inverse_mass), cloud.velocities[i].w);
    EXPECT_FLOAT_EQ(team.field(p, Record::inverse_volume), 1 / cloud.rest_volumes[i]);
  }
}

TEST(Gradients, JacobiSplitsMassesByTheConstraintsThatShareThem) {
  Cloud cloud = jittered_cube(4, 0.1);
  test::compute_gradients(cloud);
  const std::vector<float> plain = cloud.records;
  std::vector<float> corrections(cloud.positions.size() * 6);
  test::compute_gradients(cloud, 0.2f, corrections.data());
  ScalarTeam team{cloud};
  for (int p = 0; p < cloud.size(); ++p) {
    const float sharers = 1 + float(cloud.neighbour_counts[std::size_t(p)]);
    EXPECT_FLOAT_EQ(team.field(p, Record::inverse_mass), sharers * cloud.velocities[std::size_t(p)].w);
    EXPECT_GT(team.field(p, Record::gradient_square), plain[std::size_t(p * Record::field_count + Record::gradient_square)]);
  }
}

/* Along directions in which no neighbour lies nothing is known, and the gradient there must be 0, not large. */
TEST(Gradients, SparseNeighbourhoodsKnowNothingBeyondTheirSpan) {
  struct Shape {
    const char *name;
    int x, y, z; // lattice points along each axis
    int known;   // dimensions
  };
  for (const Shape &shape : {Shape{"sheet", 5, 5, 1, 2}, Shape{"line", 7, 1, 1, 1}, Shape{"lone", 1, 1, 1, 0}}) {
    Cloud cloud;
    for (int x = 0; x < shape.x; ++x)
      for (int y = 0; y < shape.y; ++y)
        for (int z = 0; z < shape.z; ++z) cloud.add({0.01f * float(x), 0.01f * float(y), 0.01f * float(z)}, volume, 1000);
    cloud.find_neighbours();
    test::compute_gradients(cloud, 0.05f);
    set_linear_velocities(cloud, Matrix::Identity());
    const int middle = cloud.size() / 2;
    Matrix expected = Matrix::Zero();
    for (int k = 0; k < shape.known; ++k) expected(k, k) = 1;
    EXPECT_LT((velocity_gradient(cloud, middle) - expected).norm(), 1e-5) << shape.name;
  }
}

TEST(Gradients, CoincidentAndNearlyCoplanarParticlesStayFiniteAndBounded) {
  RandomTensors random(9);
  for (const double thickness : {0.0, 1e-7, 1e-4, 1e-2, 0.1}) {
    Cloud cloud;
    for (int k = 0; k < 60; ++k) {
      Vector x = random.vector(2.5 * double(r));
      x.z() *= thickness;
      if (k % 5 == 4) x = Vector(cloud.positions.back().x, cloud.positions.back().y, cloud.positions.back().z);
      cloud.add(place(x), volume, 1000);
    }
    cloud.find_neighbours();
    test::compute_gradients(cloud);
    for (std::size_t i = 0; i < cloud.gradients.size(); ++i)
      for (const Vec3<float> &g : cloud.gradients[i]) {
        ASSERT_TRUE(is_finite(g));
        // |G| <= V |grad W| / cut-off, and V |grad W| stays under 1.2 / r for volumes up to 1.3 r^3
        ASSERT_LT(length(g), 1.2f / r / 0.2f);
      }
  }
}

TEST(Gradients, PseudoInverseIsTheInverseWhereTheMatrixIsRegularAndCutsWhatIsNot) {
  RandomTensors random(10);
  for (int k = 0; k < 500; ++k) {
    const Vector values(random.between(0.25, 2), random.between(0.25, 2), random.between(0.25, 2));
    const Sym3<float> A = test::narrow(random.symmetric(values));
    Vec3<float> unknown;
    EXPECT_LT((test::widen(pseudo_inverse(A, 0.2f, unknown)) - test::widen(A).inverse()).norm(), 2e-5);
    EXPECT_EQ(length(unknown), 0.0f);
    Vector poor = values;
    poor.x() = random.between(-0.1, 0.19); // rounding can make it negative
    const Matrix B = random.symmetric(poor);
    const Matrix expected = test::apply(B, [](double x) { return x > 0.2 ? 1 / x : 0; });
    EXPECT_LT((test::widen(pseudo_inverse(test::narrow(B), 0.2f, unknown)) - expected).norm(), 5e-5);
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(B);
    EXPECT_NEAR(std::fabs(eigen.eigenvectors().col(0).dot(Vector(unknown.x, unknown.y, unknown.z))), 1, 1e-5);
  }
  Vec3<float> unknown;
  EXPECT_EQ(test::widen(pseudo_inverse(zero_symmetric<float>(), 0.2f, unknown)).norm(), 0);
}

} // namespace
} // namespace loam
