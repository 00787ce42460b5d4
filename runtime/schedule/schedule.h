// The schedule: which stages a scene calls for, in order, and what each of them cost.
//
// It is compiled from what the world contains and again only when that changes. A stage that is not in it does not run, holds no memory and costs
// no branch inside a kernel.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace loam {

struct MemoryUse {
  std::string effect;
  std::uint64_t bytes;
};

struct Stage {
  std::string name;
  double seconds = 0;
  std::uint64_t items = 0;
};

// What the host has put beside matter, as each step is told anew.
struct Surroundings {
  bool colliders = false;
  bool emitters = false;
  bool fields = false;
  bool killers = false;
  bool tolerance = false;
  bool operator==(const Surroundings &) const = default;
};

// What a schedule is made from.
struct SceneContents {
  struct Material {
    std::string name;
    bool in_use;
    bool fluid = false;
    bool viscous = false, surface_tension = false, vorticity_confinement = false;
  };
  std::vector<Material> materials;
  bool position_correction = false;
  bool velocity_smoothing = false;
  Surroundings surroundings;
  bool cloth = false, cloth_self_contact = false;
  bool sleep = false;
  bool particles = false;
  bool warm_start = false;
};

class Schedule {
public:
  // Stage numbers; -1 where the scene does not call for it. Per material where it is a list.
  int sort = -1, search = -1, order = -1, gradients = -1, forces = -1, find_contacts = -1, position_correction = -1,
      contacts = -1, velocity_smoothing = -1, speed_limit = -1, final_contacts = -1, advance = -1, sleep = -1,
      statistics = -1, find_cloth_contacts = -1, prepare_cloth = -1, solve_cloth = -1, cloth_contacts = -1,
      cloth_particles = -1, cloth_self_contact = -1, finish_cloth = -1, emitters = -1, fields = -1, killers = -1,
      prepare_fluids = -1, viscosity = -1, surface_tension = -1, vorticity_confinement = -1, displace_fluids = -1,
      convergence = -1, warm_start = -1;
  std::vector<int> solve, strain;

  void compile(const SceneContents &contents);

  void begin_step();
  void record(int stage, double seconds, std::uint64_t items) {
    Stage &s = stages_[static_cast<std::size_t>(stage)];
    s.seconds += seconds;
    s.items += items;
  }
  const std::vector<Stage> &stages() const { return stages_; }

private:
  int add(std::string name);
  std::vector<Stage> stages_;
};

} // namespace loam
