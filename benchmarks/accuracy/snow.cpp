/* Snow that was thrown onto the ground: does it keep its shape when the substep is longer? The shape is compared with that at the shortest substep; with plasticity
 * once at the end of a substep as the control. */
#include "physics/thrown_snow.h"
#include "study.h"

namespace loam::accuracy {

void snow(Study &study) {
  const auto sweep = [&](const char *name, std::uint32_t plasticity, const std::vector<Setting> &settings) {
    const Setting fine{{}, study.quick() ? 1e-4 : 5e-5, 20};
    Meter unused(fine);
    const test::Shape finest = test::thrown_snow(fine.substep, plasticity, unused.course()).shape;
    study.sweep(
        "snow", name, {"shape over that of the finest setting"}, settings, [&](const Setting &setting, Meter &meter) {
          return std::vector{test::thrown_snow(setting.substep, plasticity, meter.course()).shape.difference(finest)};
        });
  };
  const std::vector<double> substeps =
      study.quick() ? std::vector{2.5e-4, 1e-3} : std::vector{1e-4, 2.5e-4, 5e-4, 1e-3, 2.5e-3};
  const std::vector<std::uint32_t> iterations =
      study.quick() ? std::vector<std::uint32_t>{5} : std::vector<std::uint32_t>{1, 2, 5, 10};
  std::vector<Setting> settings =
      combine({{}, {LOAM_SOLVER_GAUSS_SEIDEL, LOAM_MULTIPLIER_SCALAR}, {LOAM_SOLVER_JACOBI}}, substeps, iterations);
  if (!study.quick()) append(settings, presets(0.005));
  sweep("plasticity within the iterations", LOAM_PLASTICITY_IMPLICIT, settings);
  sweep("plasticity after the substep", LOAM_PLASTICITY_SEMI_IMPLICIT, combine({{}}, substeps, {5}));
}

} // namespace loam::accuracy
