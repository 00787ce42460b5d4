/* Cantilevers under their own weight: the drop of the end in equilibrium, over that of the same particles solved exactly (what the iterations leave), and over
 * that of the continuous body by finite elements (what the particles leave too). */
#include "beams.h"
#include "elastica.h"
#include "study.h"

namespace loam::accuracy {

namespace {

using test::Cantilever;

constexpr std::uint32_t tensor = LOAM_MULTIPLIER_PROJECTED_TENSOR, scalar = LOAM_MULTIPLIER_SCALAR;
constexpr Form gauss_seidel = {}, scalar_gauss_seidel = {LOAM_SOLVER_GAUSS_SEIDEL, scalar};

/* Frames short against the beam's period, even at long substeps. */
double measured_drop(Cantilever beam, const Setting &setting, Meter &meter) {
  beam.step = setting.substep;
  beam.substeps = std::uint32_t(std::clamp(0.005 / setting.substep, 1.0, 50.0));
  return beam.run(meter.course()).drop;
}

/* The softer the beam, the slower it is. Settings with which it falls off its clamp are of no interest, nor are those that converge far beyond what is asked. */
std::vector<Setting> settings(const Beam &beam, bool quick) {
  if (quick) {
    std::vector<Setting> few = combine({gauss_seidel}, {1e-3, 2e-3}, {2, 5, 10});
    append(few, combine({scalar_gauss_seidel}, {1e-3}, {5, 10}));
    append(few, {{{LOAM_SOLVER_JACOBI, tensor}, 1e-3, 10}});
    return few;
  }
  const std::vector<Form> forms(std::begin(all_forms), std::end(all_forms));
  const double modulus = beam.cantilever.youngs_modulus();
  std::vector<Setting> all;
  if (modulus < 5e4) return combine(forms, {2e-3, 5e-3}, {1, 2, 3, 5, 10});
  if (modulus > 5e5) append(all, combine({gauss_seidel, scalar_gauss_seidel}, {1e-5}, {1}));
  append(all, combine(forms, {1e-4, 2e-4}, {1, 2, 5}));
  append(all, combine(forms, {5e-4}, {1, 2, 3, 5, 10}));
  append(all, combine(forms, {1e-3}, {1, 2, 3, 5, 10, 20}));
  append(all, combine(forms, {2e-3, 5e-3}, {5, 10, 20, 50}));
  if (modulus < 5e5) append(all, presets(1 / 60.0));
  return all;
}

} // namespace

void beam(Study &study) {
  for (const Beam &beam : beams(study.quick())) {
    study.show("beam, " + beam.name + ": exact solutions");
    const double continuous = finite_element_drop(beam.cantilever);
    study.sweep("beam", beam.name, {"drop over the exact one", "drop over finite elements"}, settings(beam, study.quick()),
                [&](const Setting &setting, Meter &meter) {
                  const double drop = measured_drop(beam.cantilever, setting, meter);
                  return std::vector{drop / exact_drop(setting.form.multiplier) - 1, drop / continuous - 1};
                });
  }

  const Beam middle = beams(true)[0];
  Meter ten(Setting{gauss_seidel, 1e-3, 10});
  const double at_ten = measured_drop(middle.cantilever, {gauss_seidel, 1e-3, 10}, ten);
  study.sweep("iterations", "E 1e5 Pa", {"drop over that with 10 iterations"},
              combine({gauss_seidel}, {1e-3},
                      study.quick() ? std::vector<std::uint32_t>{40} : std::vector<std::uint32_t>{20, 50, 200}),
              [&](const Setting &setting, Meter &meter) {
                return std::vector{measured_drop(middle.cantilever, setting, meter) / at_ten - 1};
              });

  if (study.quick()) return;
  Cantilever far; // slender, so that it bends far without large strains
  far.length = 48;
  far.load = 5;
  study.sweep("far bent", "q L^3 / (E I) = 5", {"drop over the elastica"},
              {{gauss_seidel, 1e-3, 5},
               {gauss_seidel, 1e-3, 20},
               {gauss_seidel, 5e-4, 10},
               {scalar_gauss_seidel, 1e-3, 20},
               {scalar_gauss_seidel, 5e-4, 10}},
              [&](const Setting &setting, Meter &meter) {
                return std::vector{measured_drop(far, setting, meter) / reference::elastica(far.load).drop - 1};
              });

  for (const int layers : {4, 8, 16}) {
    Cantilever beam;
    beam.layers = layers;
    beam.length = 4 * layers;
    const double continuous = finite_element_drop(beam);
    study.sweep("layers", std::to_string(layers) + " layers", {"drop over finite elements"}, {{gauss_seidel, 5e-4, 15}},
                [&](const Setting &setting, Meter &meter) {
                  return std::vector{measured_drop(beam, setting, meter) / continuous - 1};
                });
  }
}

} // namespace loam::accuracy
