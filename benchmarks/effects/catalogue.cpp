/* The effects, each a change of the scene. */
#include "effects.h"

#include "support/cloths.h"
#include "support/meshes.h"

#include <algorithm>
#include <cmath>

namespace loam::effects {

namespace {

using scenes::require;

constexpr float spacing = 0.01f;

struct Box {
  float lower[3], upper[3];
};

Box bounds(const scenes::Scene &scene) {
  Box box = {{1e9f, 1e9f, 1e9f}, {-1e9f, -1e9f, -1e9f}};
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    box.lower[i % 3] = std::min(box.lower[i % 3], scene.positions[i]);
    box.upper[i % 3] = std::max(box.upper[i % 3], scene.positions[i]);
  }
  return box;
}

/* ------------------------------------------------------------------------------------------------- the solver --- */

void scalar_multiplier(Setup &setup) { setup.def.multiplier = LOAM_MULTIPLIER_SCALAR; }
void no_position_correction(Setup &setup) { setup.def.minimum_distance = 0; }
void no_velocity_smoothing(Setup &setup) { setup.def.velocity_smoothing = 0; }
void jacobi(Setup &setup) { setup.def.solver = LOAM_SOLVER_JACOBI; }
/* What looking after each of as many iterations costs. */
void tolerance(Setup &setup) {
  const loam_world_def def = setup.def;
  setup.additions.push_back([def](loam_world *world, loam_material_id) {
    loam_accuracy_def accuracy;
    require(loam_accuracy_def_default(&accuracy, sizeof accuracy), "loam_accuracy_def_default");
    accuracy.mode = LOAM_ACCURACY_TOLERANCE;
    accuracy.substeps = def.substeps;
    accuracy.iterations = def.iterations;
    accuracy.tolerance = LOAM_LEAST_TOLERANCE;
    require(loam_world_use_accuracy(world, &accuracy), "loam_world_use_accuracy");
  });
}
void sleep_allowed(Setup &setup) { setup.def.sleep_speed = 1e-9f; /* as good as never: what watching costs */ }

/* ---------------------------------------------------------------------------------------------- the materials --- */

/* The upper half of the particles is made of something else. */
template <std::uint32_t Law> void upper_half_of(Setup &setup, void (*change)(loam_material_def &)) {
  const Box box = bounds(setup.scene);
  const float middle = 0.5f * (box.lower[1] + box.upper[1]);
  std::vector<float> upper, lower;
  for (std::size_t i = 0; i < setup.scene.positions.size(); i += 3) {
    std::vector<float> &half = setup.scene.positions[i + 1] > middle ? upper : lower;
    half.insert(half.end(), setup.scene.positions.begin() + std::ptrdiff_t(i),
                setup.scene.positions.begin() + std::ptrdiff_t(i) + 3);
  }
  setup.scene.positions = lower;
  setup.scene.velocities.clear();
  setup.additions.push_back([upper, change](loam_world *world, loam_material_id) {
    loam_material_def def;
    require(loam_material_def_default(Law, &def, sizeof def), "loam_material_def_default");
    change(def);
    loam_material_id material;
    require(loam_material_create(world, &def, &material), "loam_material_create");
    loam_particles_def particles;
    require(loam_particles_def_default(&particles, sizeof particles), "loam_particles_def_default");
    particles.material = material;
    particles.count = upper.size() / 3;
    particles.positions = upper.data();
    require(loam_particles_add(world, &particles, nullptr), "loam_particles_add");
  });
}

template <std::uint32_t Law> void upper_half_of(Setup &setup) {
  upper_half_of<Law>(setup, [](loam_material_def &) {});
}

void viscous_water(Setup &setup) {
  upper_half_of<LOAM_LAW_FLUID>(setup, [](loam_material_def &def) { def.viscosity = 1; });
}
void water_with_a_skin(Setup &setup) {
  upper_half_of<LOAM_LAW_FLUID>(setup, [](loam_material_def &def) { def.surface_tension = 0.072f; });
}
void water_with_eddies(Setup &setup) {
  upper_half_of<LOAM_LAW_FLUID>(setup, [](loam_material_def &def) { def.vorticity_confinement = 0.5f; });
}

void two_sands(Setup &setup) { upper_half_of<LOAM_LAW_DRUCKER_PRAGER>(setup); }

/* The second material is the one after the scene's. */
void two_sands_in_contact(Setup &setup) {
  two_sands(setup);
  const auto add = setup.additions.back();
  setup.additions.back() = [add](loam_world *world, loam_material_id sand) {
    loam_material_def def;
    require(loam_material_def_default(LOAM_LAW_DRUCKER_PRAGER, &def, sizeof def), "loam_material_def_default");
    add(world, sand);
    require(loam_material_set_meeting(world, sand, sand + 1, LOAM_MEETING_CONTACT, 0.5f), "loam_material_set_meeting");
  };
}

/* --------------------------------------------------------------------------------------------- the colliders --- */

/* In the middle of the sand's surface, which a ball of 8 spacings touches. */
template <class Define> void add_collider(Setup &setup, Define define) {
  const Box box = bounds(setup.scene);
  const float x = 0.5f * (box.lower[0] + box.upper[0]), z = 0.5f * (box.lower[2] + box.upper[2]), y = box.upper[1];
  setup.additions.push_back([=](loam_world *world, loam_material_id) {
    loam_collider_def def;
    require(loam_collider_def_default(&def, sizeof def), "loam_collider_def_default");
    def.position[0] = x;
    def.position[1] = y + 8.2f * spacing;
    def.position[2] = z;
    define(def);
    loam_collider_id collider;
    require(loam_collider_create(world, &def, &collider), "loam_collider_create");
  });
}

template <bool AsksReaction> void sphere(Setup &setup) {
  add_collider(setup, [](loam_collider_def &def) {
    def.kind = LOAM_COLLIDER_SPHERE;
    def.radius = 8 * spacing;
    def.reaction = AsksReaction ? 1 : 0;
  });
}

template <int Subdivisions> void ball_of_triangles(Setup &setup) {
  add_collider(setup, [](loam_collider_def &def) {
    static const meshes::Mesh ball = meshes::icosphere(8 * spacing, Subdivisions);
    def.kind = LOAM_COLLIDER_MESH;
    def.mesh = ball.view();
  });
}

/* ------------------------------------------------------------------------------------------------- the cloth --- */

/* A sheet of 48 x 48 squares: held at its corners, 1 m over the sand, or lying on it. */
enum class Sheet { held, held_and_apart, held_and_weak, lying };

template <Sheet Kind> void add_cloth(Setup &setup) {
  const Box box = bounds(setup.scene);
  const float x = 0.5f * (box.lower[0] + box.upper[0]), z = 0.5f * (box.lower[2] + box.upper[2]), y = box.upper[1];
  setup.additions.push_back([=](loam_world *world, loam_material_id) {
    constexpr float edge = 0.45f * spacing;
    const cloths::Grid grid(48, 48, edge);
    loam_cloth_def def = cloths::definition(grid);
    def.position[0] = x;
    def.position[1] = y + (Kind == Sheet::lying ? 0.6f * spacing : 1.0f);
    def.position[2] = z;
    if (Kind == Sheet::held_and_apart) def.self_distance = 1.2f * edge;
    if (Kind == Sheet::held_and_weak) def.tear_strain = 10; /* more than it will ever show */
    const cloths::Cloth cloth(world, def);
    if (Kind != Sheet::lying) cloth.attach({grid.at(0, 0), grid.at(48, 0), grid.at(0, 48), grid.at(48, 48)});
  });
}

/* ---------------------------------------------------------------------------------- what comes, goes and blows --- */

void room_for_a_stream(Setup &setup) { setup.def.particle_capacity = setup.scene.count() + 8192; }

/* Beside the sand, 3 cm in radius, at 1 m/s: 29 particles every 10 ms. */
void stream(Setup &setup) {
  room_for_a_stream(setup);
  const Box box = bounds(setup.scene);
  setup.additions.push_back([=](loam_world *world, loam_material_id sand) {
    loam_emitter_def def;
    require(loam_emitter_def_default(&def, sizeof def), "loam_emitter_def_default");
    def.material = sand;
    def.position[0] = box.upper[0] + 0.5f;
    def.position[1] = 1;
    def.radius = 3 * spacing;
    loam_emitter_id emitter;
    require(loam_emitter_create(world, &def, &emitter), "loam_emitter_create");
  });
}

/* That takes nothing: a box far below, or an age that nothing reaches. */
template <std::uint32_t Kind> void killer(Setup &setup) {
  setup.additions.push_back([](loam_world *world, loam_material_id) {
    loam_killer_def def;
    require(loam_killer_def_default(&def, sizeof def), "loam_killer_def_default");
    def.kind = Kind;
    def.position[1] = -10;
    for (float &half : def.half_extents) half = 1;
    def.age = 1e6f;
    loam_killer_id killer;
    require(loam_killer_create(world, &def, &killer), "loam_killer_create");
  });
}

void wind(Setup &setup) {
  setup.additions.push_back([](loam_world *world, loam_material_id) {
    loam_field_def def;
    require(loam_field_def_default(&def, sizeof def), "loam_field_def_default");
    def.rate = 0.01f;
    loam_field_id field;
    require(loam_field_create(world, &def, &field), "loam_field_create");
  });
}

/* ---------------------------------------------------------------------------------------------- the host's --- */

void kept_frames(Setup &setup) {
  setup.each_step = [](loam_world *world) {
    loam_particle_view view;
    view.struct_size = sizeof view;
    require(loam_particles_keep(world, &view), "loam_particles_keep");
  };
}

void mapped_densities(Setup &setup) {
  setup.each_step = [](loam_world *world) {
    loam_particle_view view;
    view.struct_size = sizeof view;
    require(loam_particles_map(world, &view), "loam_particles_map");
    require(loam_particles_unmap(world), "loam_particles_unmap");
  };
}

} // namespace

Setup sand_in_a_box(std::size_t particles, std::uint32_t threads) {
  Setup setup;
  setup.scene = scenes::jittered_block(scenes::sand(), particles, 0, {spacing});
  const Box box = bounds(setup.scene);
  for (const int axis : {0, 2})
    for (const int side : {-1, 1}) {
      scenes::Plane wall = {};
      wall.point[axis] = side < 0 ? box.lower[axis] - 0.5f * spacing : box.upper[axis] + 0.5f * spacing;
      wall.normal[axis] = float(-side);
      wall.friction = 0.3f;
      setup.scene.planes.push_back(wall);
    }
  setup.def = scenes::world_def(setup.scene);
  setup.def.substeps = substeps;
  setup.def.thread_count = threads;
  return setup;
}

std::vector<Effect> all() {
  return {
      {"solver", "projected-tensor multiplier", "instead of the scalar one", scalar_multiplier, nullptr},
      {"solver", "position correction", "", no_position_correction, nullptr},
      {"solver", "velocity smoothing", "", no_velocity_smoothing, nullptr},
      {"solver", "Jacobi", "instead of Gauss-Seidel, at as many iterations", nullptr, jacobi},
      {"solver", "a tolerance", "that all iterations are needed for", nullptr, tolerance},
      {"solver", "sleep, nothing asleep", "", nullptr, sleep_allowed},
      {"materials", "a second material of the same law", "half the sand", nullptr, two_sands},
      {"materials", "contact between two materials", "the halves stay apart", two_sands, two_sands_in_contact},
      {"materials", "elastic", "half the sand is rubber", two_sands, upper_half_of<LOAM_LAW_ELASTIC>},
      {"materials", "Von Mises", "half the sand is plasticine", two_sands, upper_half_of<LOAM_LAW_VON_MISES>},
      {"materials", "NACC", "half the sand is packed snow", two_sands, upper_half_of<LOAM_LAW_NACC>},
      {"materials", "Herschel-Bulkley", "half the sand is shaving foam", two_sands,
       upper_half_of<LOAM_LAW_HERSCHEL_BULKLEY>},
      {"materials", "Stomakhin's snow", "half the sand is snow", two_sands, upper_half_of<LOAM_LAW_STOMAKHIN_SNOW>},
      {"materials", "fluid", "half the sand is water", two_sands, upper_half_of<LOAM_LAW_FLUID>},
      {"materials", "its viscosity", "1 Pa s, as of syrup", upper_half_of<LOAM_LAW_FLUID>, viscous_water},
      {"materials", "its surface tension", "that of water", upper_half_of<LOAM_LAW_FLUID>, water_with_a_skin},
      {"materials", "its vorticity confinement", "half of what is lost", upper_half_of<LOAM_LAW_FLUID>, water_with_eddies},
      {"colliders", "a sphere", "touches the sand", nullptr, sphere<false>},
      {"colliders", "its reaction", "the sphere asks for it", sphere<false>, sphere<true>},
      {"colliders", "a mesh of 1 280 triangles", "the same sphere", nullptr, ball_of_triangles<3>},
      {"colliders", "a mesh of 20 480 triangles", "the same sphere", nullptr, ball_of_triangles<5>},
      {"cloth", "cloth, touching nothing", "2 401 vertices, held at its corners", nullptr, add_cloth<Sheet::held>},
      {"cloth", "its collisions with itself", "the same sheet, with a self_distance; nothing folds", add_cloth<Sheet::held>,
       add_cloth<Sheet::held_and_apart>},
      {"cloth", "its tearing", "the same sheet, with a tear_strain that it bears", add_cloth<Sheet::held>,
       add_cloth<Sheet::held_and_weak>},
      {"cloth", "cloth on sand", "2 401 vertices, lying on it", nullptr, add_cloth<Sheet::lying>},
      {"streams", "a stream", "29 particles every 10 ms, beside the sand", room_for_a_stream, stream},
      {"streams", "a killer's box", "takes nothing", nullptr, killer<LOAM_KILLER_BOX>},
      {"streams", "a killer of old particles", "takes nothing", nullptr, killer<LOAM_KILLER_AGE>},
      {"streams", "a wind", "light", nullptr, wind},
      {"host", "densities mapped after every step", "", nullptr, mapped_densities},
      {"host", "a frame kept after every step", "", nullptr, kept_frames},
  };
}

} // namespace loam::effects
