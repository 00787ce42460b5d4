/* A dam that breaks: the greatest error of the water's front against what Martin and Moyce measured in 1952, and against Koshizuka and Oka's of 1996. */
#include "physics/dam.h"
#include "study.h"

namespace loam::accuracy {

void dam(Study &study) {
  constexpr double frame = 0.004; // of the experiment
  const std::vector<double> substeps = study.quick() ? std::vector{1e-3, 2e-3} : std::vector{5e-4, 1e-3, 2e-3, 4e-3};
  const std::vector<std::uint32_t> iterations =
      study.quick() ? std::vector<std::uint32_t>{5} : std::vector<std::uint32_t>{1, 2, 5, 10, 20};
  std::vector<Setting> settings =
      combine({{}, {LOAM_SOLVER_JACOBI}}, substeps, iterations); // the density's constraints have no tensors
  if (!study.quick()) append(settings, presets(frame));
  study.sweep(
      "dam", "n^2 = 2", {"front over Martin and Moyce", "front over Koshizuka and Oka"}, settings,
      [&](const Setting &setting, Meter &meter) {
        test::Course course = meter.course();
        course.change = [&](loam_world_def &def) {
          setting.apply(def);
          def.substeps = std::uint32_t(std::lround(frame / setting.substep));
        };
        const test::Front front = test::break_dam(LOAM_LAW_FLUID, setting.form.solver, course);
        return std::vector{test::greatest_error(front, test::measured), test::greatest_error(front, test::measured_again)};
      });
}

} // namespace loam::accuracy
