/* The iterations against what they should converge to: the equilibrium of the same particles, by the same discretisation, solved exactly. */
#include "cantilever.h"
#include "implicit_step.h"

namespace loam::test {
namespace {

reference::Vectors columns(const std::vector<float> &points) {
  return Eigen::Map<const Eigen::Matrix<float, 3, Eigen::Dynamic>>(points.data(), 3, Eigen::Index(points.size() / 3))
      .cast<double>();
}

double exact_drop(const Cantilever &of) {
  reference::ImplicitStep::Settings settings;
  settings.gravity = {0, -Cantilever::gravity, 0};
  settings.zero_energy_stiffness = double(of.zero_energy_stiffness);
  settings.tolerance = 1e-6;
  reference::ImplicitStep beam(settings, reference::Material<double>::from(of.material()));
  const reference::Vectors free = columns(of.free_points()), held = columns(of.held_points());
  const double volume = std::pow(Cantilever::spacing, 3);
  beam.add_particles(free, reference::Vectors::Zero(3, free.cols()), volume);
  beam.add_particles(held, reference::Vectors::Zero(3, held.cols()), volume, true);
  beam.settle(3, 100);
  const reference::Vectors fallen = free - beam.positions_by_id().leftCols(free.cols());
  return of.at_end(fallen.row(1).rightCols(of.layers * of.width).mean());
}

/* Over the exact drop: 1.001 with 20 iterations a substep of 1 ms, 1.02 with 5, 1.2 with 2. */
TEST(ExactSolution, IsWhatABeamConvergesTo) {
  Cantilever beam;
  beam.length = 12;
  const double exact = exact_drop(beam);
  const auto ratio = [&](std::uint32_t iterations) {
    beam.iterations = iterations;
    const double ratio = beam.run().drop / exact;
    RecordProperty("ratio_" + std::to_string(iterations), std::to_string(ratio));
    return ratio;
  };
  EXPECT_NEAR(ratio(20), 1, 0.005);
  EXPECT_NEAR(ratio(5), 1, 0.03);
  EXPECT_GT(ratio(2), 1.1); // the control
}

} // namespace
} // namespace loam::test
