/* The smallest complete host: a cylinder of dry sand collapses into a pile, and the pile is measured. */
#include <loam/loam.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void check(loam_status status, const char *call) {
  if (status != LOAM_OK) {
    fprintf(stderr, "%s: %s: %s\n", call, loam_status_name(status), loam_last_error());
    exit(EXIT_FAILURE);
  }
}

static int ascending(const void *a, const void *b) {
  const float left = *(const float *)a, right = *(const float *)b;
  return (left > right) - (left < right);
}

int main(void) {
  /* Every definition starts from its defaults; then only what matters is changed. SI units throughout. */
  loam_world_def world_def;
  check(loam_world_def_default(&world_def, sizeof world_def), "loam_world_def_default");
  world_def.backend = LOAM_BACKEND_CPU; /* so that the particles below can be read where they are */
  world_def.kernel_radius = 0.01f;      /* particles about one centimetre apart */
  world_def.particle_capacity = 4096;
  loam_world *world = NULL;
  check(loam_world_create(&world_def, &world), "loam_world_create");

  loam_material_def sand_def; /* the defaults of this law are dry sand; see material.h */
  check(loam_material_def_default(LOAM_LAW_DRUCKER_PRAGER, &sand_def, sizeof sand_def), "loam_material_def_default");
  loam_material_id sand;
  check(loam_material_create(world, &sand_def, &sand), "loam_material_create");

  loam_collider_def floor_def; /* the default is the plane y = 0, solid below */
  check(loam_collider_def_default(&floor_def, sizeof floor_def), "loam_collider_def_default");
  loam_collider_id floor_plane;
  check(loam_collider_create(world, &floor_def, &floor_plane), "loam_collider_create");

  loam_fill_def fill;
  check(loam_fill_def_default(&fill, sizeof fill), "loam_fill_def_default");
  fill.material = sand;
  fill.region.kind = LOAM_REGION_CYLINDER; /* upright: its axis is y */
  fill.region.radius = 0.06f;
  fill.region.half_height = 0.06f;
  fill.region.center[1] = 0.065f;
  uint64_t count = 0;
  check(loam_particles_fill(world, &fill, &count), "loam_particles_fill");
  printf("filled a cylinder of radius %.3f m and height %.3f m with %llu particles\n", (double)fill.region.radius,
         2.0 * (double)fill.region.half_height, (unsigned long long)count);

  for (int frame = 0; frame < 120; ++frame) check(loam_world_step(world, 1.0f / 60.0f), "loam_world_step");

  /* The solver's own buffers, without a copy. */
  loam_particle_view view;
  view.struct_size = sizeof view;
  check(loam_particles_map(world, &view), "loam_particles_map");
  float *distances = malloc((size_t)view.count * sizeof *distances);
  if (distances == NULL) return EXIT_FAILURE;
  float height = 0.0f;
  for (uint64_t i = 0; i < view.count; ++i) {
    const float *position = view.positions + 4 * i;
    distances[i] = hypotf(position[0], position[2]);
    if (position[1] > height) height = position[1];
  }
  /* A few grains roll far away; the pile's edge is where 98 of 100 grains are closer to the axis. */
  qsort(distances, (size_t)view.count, sizeof *distances, ascending);
  printf("after two seconds: a pile of radius %.3f m and height %.3f m\n", (double)distances[view.count * 98 / 100],
         (double)height);
  free(distances);
  check(loam_particles_unmap(world), "loam_particles_unmap");

  check(loam_world_destroy(world), "loam_world_destroy");
  return EXIT_SUCCESS;
}
