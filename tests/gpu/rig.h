// A solver on the CPU, on the emulated device or on CUDA, with a scene in it, below the public interface.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "cpu/kernel_table.h"
#include "device_memory.h"
#include "emulated_machine.h"
#include "scene/material.h"
#include "scenes.h"
#include "solver/solver.h"

namespace loam::test {

using EmulatedSolver = Solver<TileExecutor<emulation::Machine>>;

enum class Runs { cpu, emulated, emulated_backwards, cuda };

struct Settings {
  bool jacobi = false, projected_tensor = true;
  std::uint32_t substeps = 8, iterations = 3;
  Vec3<float> gravity{0, -9.81f, 0};
  float sleep_speed = 0;
};

// One solver with a scene in it. With two materials, particles take them by turns.
class Rig {
public:
  Rig(Runs runs, const scenes::Scene &scene, const Settings &settings, const std::vector<loam_material_def> &materials)
      : count_(scene.count()) {
    SolverSettings solver = {scene.spacing, 0.2f,   0.75f, 20.0f, settings.jacobi, false, settings.projected_tensor,
                             1.0f,          count_, 0};
    solver.sleep_speed = settings.sleep_speed;
    solver.sleep_delay = 0.05f;
    solver.warm_start = true;
    ExecutionSettings execution = {};
    execution.thread_count = runs == Runs::emulated_backwards ? 2 : 1;
    execution.instruction_set = best_instruction_set();
    backend_ = runs == Runs::cpu    ? make_cpu_backend(solver, execution)
               : runs == Runs::cuda ? make_cuda_backend(solver, execution)
                                    : std::make_unique<EmulatedSolver>(solver, execution);

    std::vector<SolverMaterial> list;
    for (const loam_material_def &def : materials) list.push_back({make_law(def), def.name, true, {}, def.density});
    backend_->set_materials(list);
    for (std::size_t i = 0; i < count_; ++i) {
      const std::size_t material = i % materials.size();
      NewParticles particles = {};
      particles.material = static_cast<std::uint32_t>(material);
      particles.first_id = static_cast<std::uint32_t>(i);
      particles.volume = scene.volume();
      particles.inverse_mass = 1.0f / (materials[material].density * scene.volume());
      particles.positions = &scene.positions[3 * i];
      particles.velocities = scene.velocities.empty() ? nullptr : &scene.velocities[3 * i];
      particles.count = 1;
      backend_->add_particles(particles);
    }
    input_.substeps = settings.substeps;
    input_.iterations = settings.iterations;
    input_.gravity = settings.gravity;
    for (const scenes::Plane &plane : scene.planes) { // the ground: planes of these scenes face up
      const Pose pose = {{plane.point[0], plane.point[1], plane.point[2]}, {0, 0, 0, 1}};
      input_.colliders.push_back({backend_->add_shape(PlaneShape{}), {plane.friction, 0, 0}, pose, pose});
    }
  }
  void step(float seconds) {
    input_.seconds = seconds;
    backend_->step(input_);
  }
  Backend &backend() { return *backend_; }

  // In the order of the ids.
  std::vector<Vec3<float>> positions() { return rows(&loam_particle_view::positions); }
  std::vector<Vec3<float>> velocities() { return rows(&loam_particle_view::velocities); }

private:
  std::vector<Vec3<float>> rows(const float *loam_particle_view::*column) {
    loam_particle_view view = {};
    backend_->map(view);
    std::vector<std::uint32_t> ids(count_);
    std::vector<Row> values(count_);
    read_mapped(view, ids.data(), view.ids, count_ * sizeof(std::uint32_t));
    read_mapped(view, values.data(), view.*column, count_ * sizeof(Row));
    std::vector<Vec3<float>> ordered(count_);
    for (std::size_t i = 0; i < count_; ++i) ordered[ids[i]] = xyz(values[i]);
    return ordered;
  }
  std::size_t count_;
  std::unique_ptr<Backend> backend_;
  StepInput input_{};
};

inline float greatest_difference(const std::vector<Vec3<float>> &a, const std::vector<Vec3<float>> &b) {
  float most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, length(a[i] - b[i]));
  return most;
}
inline float root_mean_square(const std::vector<Vec3<float>> &a) {
  double sum = 0;
  for (const Vec3<float> &v : a) sum += static_cast<double>(dot(v, v));
  return static_cast<float>(std::sqrt(sum / static_cast<double>(a.size())));
}

} // namespace loam::test
