/* Cloth that hangs, in frames of a sixtieth of a second: what a soft sheet stretches by its weight over rho g L^2 / (2 k), and the sag of a strip between two points
 * over the catenary's. */
#include "physics/hanging_cloth.h"
#include "study.h"

namespace loam::accuracy {

void cloth(Study &study) {
  constexpr double stretch = 0.15 * 9.81 / (2 * 30.0), catenary = 0.3196;
  std::vector<Setting> settings; // of its one solver
  for (const double substeps : study.quick() ? std::vector{1.0, 4.0, 16.0} : std::vector{1.0, 2.0, 4.0, 8.0, 16.0})
    for (const std::uint32_t iterations :
         study.quick() ? std::vector<std::uint32_t>{5, 20} : std::vector<std::uint32_t>{1, 2, 5, 10, 20, 50})
      settings.push_back({{}, 1 / (60 * substeps), iterations});
  if (!study.quick()) append(settings, presets(1 / 60.0));
  const auto accuracy = [](const Setting &setting) {
    return test::Accuracy{setting.iterations, std::uint32_t(std::lround(1 / (60 * setting.substep)))};
  };
  study.sweep("cloth", "soft sheet", {"stretch over the closed form"}, settings, [&](const Setting &setting, Meter &meter) {
    meter.count_vertices(17 * 17);
    return std::vector{(test::hanging_length(accuracy(setting), 30, 0, meter.course()) - 1) / stretch - 1};
  });
  study.sweep("cloth", "strip", {"sag over the catenary"}, settings, [&](const Setting &setting, Meter &meter) {
    meter.count_vertices(33 * 4);
    return std::vector{test::sag(accuracy(setting), meter.course()) / catenary - 1};
  });
}

} // namespace loam::accuracy
