/* Fields: winds, attractors and blasts that act on matter through space, beside gravity.
 *
 * Each acts on the velocity of every particle that is not pinned, whatever its mass; attractors and blasts act on cloth as well (its wind is
 * loam_cloth_set_wind's). Several add up. A world without fields has no stage for them.
 *
 * Thread contract: as for the world; during an asynchronous step every function here that takes a world answers LOAM_ERROR_BUSY.
 */
#ifndef LOAM_FIELD_H
#define LOAM_FIELD_H

#include <loam/base.h>
#include <loam/world.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef uint64_t loam_field_id;

enum {
  /* Drag towards a velocity: dv/dt = rate (velocity - v), exact over a substep. With gravity g, matter by itself comes to fall at g / rate beyond the wind's
   * velocity, less a share of rate x substep / 2. */
  LOAM_FIELD_WIND = 0,

  /* A point mass, softened (Plummer 1911): dv/dt = -strength d / (|d|^2 + softening^2)^(3/2), d from the centre to the particle. */
  LOAM_FIELD_ATTRACTOR = 1,

  /* Once, at `time`: particles within `radius` of the centre get speed (1 - |d| / radius) away from it. */
  LOAM_FIELD_BLAST = 2
};

typedef struct loam_field_def {
  uint32_t struct_size;
  uint32_t kind;     /* LOAM_FIELD_*; default WIND */
  float position[3]; /* the centre, metres, within 1e6 kernel radii of the origin; default 0 */
  float velocity[3]; /* WIND: of the air, m/s, at most 1e6; default 0 */
  float rate;        /* WIND: 1/s, over 0, at most 1e6; default 1 */
  float strength;    /* ATTRACTOR: m^3/s^2, at most 1e12 in size; under 0 it pushes away; default 0 */
  float softening;   /* ATTRACTOR: metres, 0.01 to 1e6 kernel radii; default 0 */
  float speed;       /* BLAST: m/s, at most 1e6 in size; under 0 inwards; matter is slowed to r / substep; default 0 */

  /* BLAST: over 0. WIND: it blows within this of the centre; 0 (the default): everywhere. Metres, at most 1e6 kernel radii. */
  float radius;
  float time; /* BLAST: seconds of the world's time after the field was made or set: 0 (the default) to 1e6 */
} loam_field_def;

/* Errors: INVALID_ARGUMENT for null or an unknown size. */
LOAM_API loam_status loam_field_def_default(loam_field_def *def, size_t size);

/* Makes a field. It wakes what sleeps; so does a blast those whom it reaches, when it comes. A steady field that moves nothing lets matter fall asleep.
 * A blast that is over does nothing, and keeps its id until it is destroyed.
 * Errors: INVALID_ARGUMENT naming the field of the definition; CAPACITY beyond 1024 fields in a world. */
LOAM_API loam_status loam_field_create(loam_world *world, const loam_field_def *def, loam_field_id *field);

/* Gives it another definition, as if it were made now: the time of a blast counts anew. Errors: INVALID_HANDLE; INVALID_ARGUMENT. */
LOAM_API loam_status loam_field_set(loam_world *world, loam_field_id field, const loam_field_def *def);

/* Errors: INVALID_HANDLE. */
LOAM_API loam_status loam_field_destroy(loam_world *world, loam_field_id field);

#ifdef __cplusplus
}
#endif

#endif
