/* The iterations against what they should converge to: the equilibrium of the same particles, by the same discretisation, solved exactly. */
#include "exact_beam.h"

namespace loam::test {
namespace {

/* Over the exact drop: 1.001 with 20 iterations a substep of 1 ms, 1.02 with 5, 1.2 with 2; 1.001 with 2 that start warm. */
TEST(ExactSolution, IsWhatABeamConvergesTo) {
  Cantilever beam;
  beam.length = 12;
  const double exact = exact_drop(beam, settled(beam));
  const auto ratio = [&](std::uint32_t iterations) {
    beam.iterations = iterations;
    const double ratio = beam.run().drop / exact;
    RecordProperty("ratio_" + std::to_string(iterations), std::to_string(ratio));
    return ratio;
  };
  EXPECT_NEAR(ratio(20), 1, 0.005);
  EXPECT_NEAR(ratio(5), 1, 0.03);
  EXPECT_GT(ratio(2), 1.1); // the control
  Course warm;
  warm.change = [](loam_world_def &def) { def.warm_start = 1; };
  EXPECT_NEAR(beam.run(warm).drop / exact, 1, 0.005); // two iterations
}

} // namespace
} // namespace loam::test
