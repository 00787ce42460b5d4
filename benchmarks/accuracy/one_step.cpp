/* One substep of a bent beam that is let go, without gravity, over the exact solution of that step: the true error of what the iterations gave, beside the
 * residual that the library reports.
 *
 * The library and the exact solver start from the same state: from rest, straight, they are bent by what the velocities prescribe in steps so short that the stress
 * has no time to move anything. */
#include "beams.h"
#include "study.h"

#include <map>
#include <numeric>

namespace loam::accuracy {

namespace {

using reference::Vectors;

constexpr int bending_steps = 8;
constexpr double bending_step = 1e-7; // seconds

Vectors bending_velocities() { return settled_beam(LOAM_MULTIPLIER_PROJECTED_TENSOR) / (bending_steps * bending_step); }

/* Velocities of the free particles after a substep, one after the other. */
class ExactStep {
public:
  ExactStep(const Beam &beam, std::uint32_t multiplier) : bent_(bend(beam, multiplier)) {
    free_ = settled_beam(LOAM_MULTIPLIER_PROJECTED_TENSOR).cols();
  }
  const Vectors &after(double substep) {
    const auto [found, fresh] = known_.try_emplace(substep);
    if (fresh) {
      reference::ImplicitStep beam = bent_;
      beam.advance(substep);
      found->second = beam.velocities_by_id().leftCols(free_);
    }
    return found->second;
  }

private:
  static reference::ImplicitStep bend(const Beam &beam, std::uint32_t multiplier) {
    test::Cantilever cantilever = beam.cantilever;
    if (multiplier == LOAM_MULTIPLIER_SCALAR) cantilever.zero_energy_stiffness = 0;
    reference::ImplicitStep exact = test::exact_beam(cantilever, 0, 1e-7);
    Vectors velocities = Vectors::Zero(3, Eigen::Index(exact.particles().size()));
    const Vectors bending = bending_velocities();
    velocities.leftCols(bending.cols()) = bending;
    for (int step = 0; step < bending_steps; ++step) {
      exact.set_velocities(velocities);
      exact.advance(bending_step);
    }
    exact.set_velocities(Vectors::Zero(3, velocities.cols()));
    return exact;
  }

  reference::ImplicitStep bent_;
  Eigen::Index free_;
  std::map<double, Vectors> known_;
};

/* The same by the library, which `prepare` may be told how to take the step. */
Vectors step_of(
    const Beam &beam, const Setting &setting, const test::Course &course,
    const std::function<void(loam_world *)> &prepare = [](loam_world *) {}) {
  test::Solid solid(beam.cantilever.material(), beam.cantilever.free_points());
  solid.held = beam.cantilever.held_points();
  setting.apply(solid.def);
  solid.def.substeps = 1;
  solid.def.velocity_smoothing = solid.def.minimum_distance = 0; // neither is part of the equations that are solved
  solid.def.zero_energy_stiffness = beam.cantilever.zero_energy_stiffness;
  scenes::World world = solid.make();

  std::vector<std::uint32_t> ids(solid.scene.count());
  std::iota(ids.begin(), ids.end(), 0u);
  const auto set_velocities = [&](const Vectors &velocities) {
    const Eigen::MatrixXf narrow = velocities.cast<float>();
    scenes::require(loam_particles_move(world.get(), ids.data(), ids.size(), nullptr, narrow.data()), "loam_particles_move");
  };
  const Vectors bending = bending_velocities();
  for (int step = 0; step < bending_steps; ++step) {
    set_velocities(bending);
    world.step(float(bending_step));
  }
  set_velocities(Vectors::Zero(3, bending.cols()));
  prepare(world.get());
  course.step(world, float(setting.substep));
  return test::columns(world.snapshot().velocities).leftCols(bending.cols());
}

double error_of(const Vectors &velocities, const Vectors &exact) { return (velocities - exact).norm() / exact.norm(); }

/* What the library itself takes for the error, where it is asked to keep to a tolerance; it stands in the place of the residual. */
Row estimate(const Beam &beam, const Setting &setting, ExactStep &exact) {
  Row row;
  row.effect = "estimate";
  row.name = beam.name;
  row.solver = setting.form.solver_name();
  row.multiplier = setting.form.multiplier_name();
  row.substep = setting.substep;
  row.error_name = "velocity";
  test::Course course;
  course.step = [&](scenes::World &world, float seconds) {
    world.step(seconds);
    const loam_statistics statistics = world.statistics();
    row.iterations = statistics.iterations;
    row.particles = std::size_t(statistics.particles);
    row.residual = statistics.solution_error;
  };
  row.error = error_of(step_of(beam, setting, course,
                               [&](loam_world *world) {
                                 loam_accuracy_def def;
                                 scenes::require(loam_accuracy_def_default(&def, sizeof def), "loam_accuracy_def_default");
                                 def.mode = LOAM_ACCURACY_TOLERANCE;
                                 def.substeps = 1;
                                 def.iterations = setting.iterations;
                                 def.tolerance = LOAM_LEAST_TOLERANCE;
                                 scenes::require(loam_world_use_accuracy(world, &def), "loam_world_use_accuracy");
                               }),
                       exact.after(setting.substep));
  return row;
}

} // namespace

void one_step(Study &study) {
  const std::vector<Form> forms(std::begin(all_forms), std::end(all_forms));
  const std::vector<double> substeps =
      study.quick() ? std::vector{1e-3} : std::vector{1e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3};
  const std::vector<std::uint32_t> iterations =
      study.quick() ? std::vector<std::uint32_t>{1, 5, 20} : std::vector<std::uint32_t>{1, 2, 3, 5, 10, 20, 50};
  for (const Beam &beam : beams(study.quick())) {
    ExactStep with(beam, LOAM_MULTIPLIER_PROJECTED_TENSOR), without(beam, LOAM_MULTIPLIER_SCALAR);
    study.sweep("one step", beam.name, {"velocity"}, combine(forms, substeps, iterations),
                [&](const Setting &setting, Meter &meter) {
                  const Vectors &exact =
                      (setting.form.multiplier == LOAM_MULTIPLIER_SCALAR ? without : with).after(setting.substep);
                  return std::vector{error_of(step_of(beam, setting, meter.course()), exact)};
                });
    const std::vector<Form> forms_of_tensors = {{}, {LOAM_SOLVER_JACOBI}};
    for (const Setting &setting : combine(forms_of_tensors, substeps,
                                          study.quick() ? std::vector<std::uint32_t>{5, 10}
                                                        : std::vector<std::uint32_t>{3, 5, 7, 10, 15, 20, 30, 50}))
      study.add(estimate(beam, setting, with));
  }
}

} // namespace loam::accuracy
