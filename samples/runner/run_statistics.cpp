#include "run_statistics.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace runner {

void RunStatistics::add_stages(const std::vector<loam_stage> &frame) {
  for (const loam_stage &stage : frame) {
    const auto known = std::find_if(stages.begin(), stages.end(),
                                    [&](const loam_stage &other) { return std::strcmp(other.name, stage.name) == 0; });
    if (known == stages.end()) {
      stages.push_back(stage);
    } else {
      known->seconds += stage.seconds;
      known->items += stage.items;
    }
  }
}

std::string make_statistics_json(const Scene &scene, const RunStatistics &run) {
  using Json = nlohmann::ordered_json;
  const loam_statistics last = run.frames.empty() ? loam_statistics{} : run.frames.back().statistics;
  std::uint64_t substeps = 0, iterations = 0, pair_visits = 0, speed_limited = 0, strain_limited = 0, outside_peak = 0;
  double peak_speed = 0, stiffness_share = 1, solution_error = 0, penetration = 0, stretch = 0;
  for (const FrameRecord &frame : run.frames) {
    substeps += frame.statistics.substeps;
    iterations += frame.statistics.iterations_done;
    solution_error = std::max(solution_error, frame.statistics.solution_error);
    penetration = std::max(penetration, frame.statistics.penetration);
    stretch = std::max(stretch, frame.statistics.stretch);
    pair_visits += frame.statistics.pair_visits;
    speed_limited += frame.statistics.speed_limited;
    strain_limited += frame.statistics.strain_limited;
    stiffness_share = std::min(stiffness_share, frame.statistics.stiffness_share);
    peak_speed = std::max(peak_speed, frame.statistics.max_speed);
    outside_peak = std::max(outside_peak, frame.outside);
  }
  const auto frames = static_cast<double>(run.frames.size());
  const auto per_second = [](double amount, double seconds) { return seconds > 0 ? amount / seconds : 0.0; };

  Json json;
  json["scene"] = scene.path.filename().string();
  json["title"] = scene.title;
  json["particles"] = run.particles;
  json["frames"] = run.frames.size();
  json["interrupted"] = run.interrupted;
  json["frame_rate"] = scene.frame_rate;
  json["simulated_seconds"] = frames / scene.frame_rate;
  json["kernel_radius"] = scene.world.kernel_radius;
  json["accuracy"] = run.accuracy;
  json["substeps_per_frame"] = frames > 0 ? static_cast<double>(substeps) / frames : 0.0;
  json["iterations_per_substep"] = substeps > 0 ? static_cast<double>(iterations) / static_cast<double>(substeps) : 0.0;
  json["solution_error"] = solution_error;
  json["over_budget"] = run.over_budget;
  json["solver"] = scene.world.solver == LOAM_SOLVER_JACOBI ? "jacobi" : "gauss-seidel";
  json["backend"] = run.backend;
  json["instruction_set"] = run.instruction_set;
  json["threads"] = run.threads;
  json["seconds"] = run.step_seconds;
  json["seconds_per_frame"] = frames > 0 ? run.step_seconds / frames : 0.0;
  json["pairs_peak"] = last.pairs_peak;
  json["pair_visits"] = pair_visits;
  json["pair_visits_per_second"] = per_second(static_cast<double>(pair_visits), run.step_seconds);
  json["stages"] = Json::array();
  for (const loam_stage &stage : run.stages)
    json["stages"].push_back({{"name", stage.name}, {"seconds", stage.seconds}, {"items", stage.items}});
  json["memory"] = Json::array();
  for (const loam_memory &row : run.memory) json["memory"].push_back({{"effect", row.effect}, {"bytes", row.bytes}});
  // Null where no collider has sides.
  json["outside_colliders"] = run.has_sides ? Json(run.frames.empty() ? 0 : run.frames.back().outside) : Json();
  json["outside_colliders_peak"] = run.has_sides ? Json(outside_peak) : Json();
  if (scene.watch) json["watched"] = run.frames.empty() ? run.particles : run.frames.back().watched;
  json["non_finite"] = last.non_finite;
  json["max_speed"] = last.max_speed;
  json["mean_speed"] = last.mean_speed;
  json["peak_speed"] = peak_speed;
  json["speed_limited"] = speed_limited;
  json["strain_limited"] = strain_limited;
  json["least_stiffness_share"] = stiffness_share;
  json["contacts"] = last.contacts;
  json["kinetic_energy"] = last.kinetic_energy;
  json["sleeping"] = last.sleeping;
  json["virial"] = last.virial;
  json["residual"] = last.residual;
  json["density_error"] = last.density_error;
  json["greatest_stretch"] = stretch;
  json["deepest_penetration"] = penetration;
  json["state_hash"] = fmt::format("{:016x}", run.state_hash);
  return json.dump(2) + "\n";
}

std::string make_series_csv(const RunStatistics &run) {
  std::string csv = "frame,time,watched,max_speed,mean_speed,virial,residual,outside,step_seconds,sleeping,substeps,"
                    "iterations,solution_error\n";
  for (const FrameRecord &frame : run.frames) {
    const loam_statistics &s = frame.statistics;
    csv += fmt::format("{},{:.6f},{},{:.6g},{:.6g},{:.6g},{:.6g},{},{:.6g},{},{},{},{:.6g}\n", frame.frame, frame.time,
                       frame.watched, s.max_speed, s.mean_speed, s.virial, s.residual, frame.outside, s.step_seconds,
                       s.sleeping, s.substeps, s.iterations_done, s.solution_error);
  }
  return csv;
}

} // namespace runner
