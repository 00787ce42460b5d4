/* Particles: filling volumes with matter, and reading the matter back.
 *
 * Thread contract: as for the world; during an asynchronous step every function here that takes a world answers LOAM_ERROR_BUSY.
 */
#ifndef LOAM_PARTICLES_H
#define LOAM_PARTICLES_H

#include <loam/base.h>
#include <loam/collider.h>
#include <loam/material.h>
#include <loam/world.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------------------------------------- emitters --- */

enum {
  LOAM_REGION_NONE = 0, /* everything (as a cut), not allowed as the region itself */
  LOAM_REGION_BOX = 1,
  LOAM_REGION_SPHERE = 2,
  LOAM_REGION_CYLINDER = 3,
  LOAM_REGION_MESH = 4 /* the inside of a closed triangle mesh, by its generalised winding number (Jacobson et al. 2013) */
};

/* A volume in world coordinates. */
typedef struct loam_region {
  uint32_t kind;         /* LOAM_REGION_* */
  float center[3];       /* BOX, SPHERE, CYLINDER: its centre. MESH: where the mesh's origin goes. metres */
  float rotation[4];     /* unit quaternion x, y, z, w; a zero quaternion means identity */
  float half_extents[3]; /* BOX: half its edges along its own axes, metres */
  float radius;          /* SPHERE, CYLINDER; metres */
  float half_height;     /* CYLINDER: half its length along its own y axis; metres */
  loam_mesh mesh;        /* MESH: must be closed; read during the call only */
} loam_region;

enum {
  LOAM_SAMPLING_POISSON_DISK = 0, /* random, no two closer than the spacing (Bridson 2007) */
  LOAM_SAMPLING_LATTICE = 1       /* a cubic lattice, each point moved at random by up to jitter x spacing along each axis */
};

typedef struct loam_fill_def {
  uint32_t struct_size;
  uint32_t sampling;         /* LOAM_SAMPLING_*; default POISSON_DISK */
  loam_material_id material; /* of this world */
  loam_region region;        /* what to fill */
  loam_region cut; /* and only there, unless its kind is NONE (the default): "the upper bulb" is a mesh cut with a box */

  /* The least distance of Poisson-disk samples, or the lattice's constant, in metres. 0 (the default): 0.83 r or r, which give the
   * neighbourhoods that the solver expects. At least 0.5 r. */
  float spacing;
  float jitter; /* LATTICE only: share of the spacing, 0 to 0.5; default 0.12 */

  /* Particles keep this distance from the region's boundary, metres, 0 or more; default 0. For a mesh that is a collider too, r / 2
   * keeps the matter from being pushed at the start. The mass still fills the region that is left. */
  float inset;

  uint32_t seed;     /* the same seed gives the same particles; default 1 */
  float velocity[3]; /* m/s of all particles at the start; default 0 */
  uint32_t reserved; /* 0 */
} loam_fill_def;

/* Errors: INVALID_ARGUMENT for null or an unknown size. */
LOAM_API loam_status loam_fill_def_default(loam_fill_def *def, size_t size);

/* Fills a region with particles once. Their masses add up to the material's density times the region's volume.
 * *count (may be null) receives how many were made. Nothing is made on an error.
 * Errors: INVALID_ARGUMENT naming the field; INVALID_HANDLE for the material; INVALID_MESH naming the first open edges of a mesh that
 * does not close; CAPACITY with the particle_capacity that would be needed; IN_USE while buffers are mapped; OUT_OF_MEMORY. */
LOAM_API loam_status loam_particles_fill(loam_world *world, const loam_fill_def *def, uint64_t *count);

/* Particles given one by one, all of one material. Arrays of `count` elements, read during the call only. */
typedef struct loam_particles_def {
  uint32_t struct_size;
  uint32_t reserved; /* 0 */
  loam_material_id material;
  uint64_t count;
  const float *positions;  /* x, y, z; metres; finite, and within 1e6 r of the origin */
  const float *velocities; /* x, y, z; m/s; null: at rest */
  float volume;            /* m^3 of each undeformed particle; 0: r^3 */
  uint32_t pinned;         /* 1: infinite mass; these particles keep their velocity for ever (a clamped end). 0: free */
} loam_particles_def;

/* Errors: INVALID_ARGUMENT for null or an unknown size. */
LOAM_API loam_status loam_particles_def_default(loam_particles_def *def, size_t size);

/* Adds particles; *first_id (may be null) receives the id of the first, the others follow. Errors as for fill. */
LOAM_API loam_status loam_particles_add(loam_world *world, const loam_particles_def *def, uint32_t *first_id);

/* Takes `count` particles out of the world, by their ids. Ids of removed particles do not come back. Costs a look at all ids and a move of as many
 * particles as go.
 * Errors: INVALID_ARGUMENT, also for an id that is named twice and for more ids than there are particles; INVALID_HANDLE naming the first id that no
 * particle has; IN_USE while buffers are mapped; OUT_OF_MEMORY. Nothing is removed on an error. */
LOAM_API loam_status loam_particles_remove(loam_world *world, const uint32_t *ids, uint64_t count);

/* Puts `count` particles elsewhere, by their ids. `positions` (x, y, z each; metres, finite, and within 1e6 r of the origin) and `velocities` (x, y,
 * z; m/s) have `count` elements in the order of the ids; one of them may be null: it stays. Strain, volume and mass stay. This also leads pinned
 * particles: they keep the velocity that they are given until the next call.
 * Errors: as for remove. Nothing moves on an error. */
LOAM_API loam_status loam_particles_move(loam_world *world, const uint32_t *ids, uint64_t count, const float *positions,
                                         const float *velocities);

/* The number of particles. */
LOAM_API loam_status loam_particles_count(const loam_world *world, uint64_t *count);

/* ------------------------------------------------------------------------------------------------- buffers --- */

enum { LOAM_MEMORY_HOST = 0, LOAM_MEMORY_CUDA_DEVICE = 1 };

/* The solver's own buffers, not copies: `count` elements each, read-only, in the solver's order, which changes with every step (the
 * particles are sorted in space); `ids` says which particle each element is. */
typedef struct loam_particle_view {
  uint32_t struct_size; /* set by the caller to sizeof(loam_particle_view) */
  uint32_t memory;      /* LOAM_MEMORY_*: which processor the pointers are good for */
  uint64_t count;
  const uint32_t *ids;       /* stable: 0, 1, 2 ... in the order of creation; those of removed particles do not come back */
  const float *positions;    /* stride of 4 floats: x, y, z, and the particle's present volume in m^3 */
  const float *velocities;   /* stride of 4 floats: x, y, z, and the inverse mass in 1/kg (0: pinned) */
  const uint32_t *materials; /* the lower 32 bits of the loam_material_id */
  const float
      *strains; /* stride of 6 floats xx, yy, zz, xy, xz, yz: b - I with b the elastic left Cauchy-Green tensor; the Hencky
                              * strain is log(I + this) / 2 */
  const float *densities; /* kg/m^3: mass over present volume; 0 for pinned particles. Of a FLUID: at the start of the last
                           * substep, from the kernel's sum; strains hold the volume change there, 1 / compression - 1, three times */
  const float *
      histories; /* the number that a particle's law remembers: the pressure in Pa of a FLUID, `consolidation` of NACC, see material.h;
                           * null while no material of the world has any */
} loam_particle_view;

/* Gives the pointers. They are valid until loam_particles_unmap or loam_world_destroy; in between, calls that would change the particles
 * fail with IN_USE. Costs no copy, except `densities`, which is computed by this call.
 * Errors: INVALID_ARGUMENT; IN_USE if already mapped; OUT_OF_MEMORY. */
LOAM_API loam_status loam_particles_map(loam_world *world, loam_particle_view *view);

/* Ends the mapping. Errors: INVALID_ARGUMENT if nothing is mapped. */
LOAM_API loam_status loam_particles_unmap(loam_world *world);

/* Copies the particles as they are now to buffers of their own on the same processor, and gives the pointers to those: a frame to be read, by any thread, while
 * the next step runs, asynchronously or not. It stays as it is until the next loam_particles_keep, loam_particles_drop or loam_world_destroy. Memory for it, of
 * particle_capacity particles, is taken by the first call; worlds that keep no frame have none.
 * Errors: INVALID_ARGUMENT; OUT_OF_MEMORY; an earlier frame is then as it was. */
LOAM_API loam_status loam_particles_keep(loam_world *world, loam_particle_view *view);

/* Gives back the memory of the kept frame. Errors: INVALID_ARGUMENT if there is none. */
LOAM_API loam_status loam_particles_drop(loam_world *world);

#ifdef __cplusplus
}
#endif

#endif
