/* What a particle costs in worlds of different sizes, and what the stages of a step take of it. */
#include "study.h"

namespace loam::accuracy {

namespace {

constexpr double substep = 5e-4;
constexpr std::uint32_t substeps = 4;

/* With the default number of iterations. */
class Block {
public:
  Block(const loam_material_def &material, std::size_t particles, const Form &form)
      : meter_({form, substep, 5}), world_(make(material, particles, meter_)) {
    test::Course course = meter_.course();
    world_.step(float(substeps * substep)); // the first one takes memory
    for (int frame = 0; frame < 2; ++frame) course.step(world_, float(substeps * substep));
  }
  const Meter &meter() const { return meter_; }
  std::vector<loam_stage> stages() const { return world_.stages(); }

private:
  static scenes::World make(const loam_material_def &material, std::size_t particles, Meter &meter) {
    const scenes::Scene scene = scenes::jittered_block(material, particles);
    loam_world_def def = scenes::world_def(scene);
    def.substeps = substeps;
    meter.course().change(def);
    return {def, scene};
  }
  Meter meter_;
  scenes::World world_;
};

} // namespace

void scaling(Study &study) {
  const std::size_t most = study.quick() ? 16384 : 262144;
  study.show("scaling up to " + std::to_string(most) + " particles");
  for (const Form &form : {Form{}, Form{LOAM_SOLVER_JACOBI}})
    for (std::size_t particles = 4096; particles <= most; particles *= 2) {
      const Block block(scenes::sand(), particles, form);
      study.add({"scaling", "sand", "", form.solver_name(), form.multiplier_name(), substep, 5, particles,
                 "seconds a particle and substep", block.meter().seconds_per_second() * substep / double(particles),
                 block.meter().seconds_per_second(), 0});
    }

  const std::size_t particles = study.quick() ? 4096 : 65536;
  loam_material_def water;
  scenes::require(loam_material_def_default(LOAM_LAW_FLUID, &water, sizeof water), "loam_material_def_default");
  for (const auto &[name, material] :
       {std::pair("sand", scenes::sand()), std::pair("rubber", scenes::rubber()), std::pair("water", water)}) {
    study.show(std::string("stages of ") + name);
    const Block block(material, particles, {});
    double whole = 0;
    for (const loam_stage &stage : block.stages()) whole += stage.seconds;
    for (const loam_stage &stage : block.stages())
      study.add({std::string("stages of ") + name, stage.name, "", "gauss_seidel", "tensor", substep, 5, particles,
                 "share of the step", stage.seconds / whole, stage.seconds / (substeps * substep), 0});
  }
}

} // namespace loam::accuracy
