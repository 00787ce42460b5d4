/* Emitters: matter that streams into the world while it steps.
 *
 * A nozzle is an opening that matter leaves in layers, one particle spacing apart along the flow, all at the same speed. A layer is led by the
 * nozzle, at that speed whatever stands in its way, until the next one enters; so no two particles of a stream enter closer than the spacing less
 * its jitter, and the flow does not depend on what it runs into. So that a stream shows no layers, each place of the opening is ahead or behind by a
 * share of the spacing that is its own in every layer, up to a half: matter enters from half a spacing before the opening to half a spacing behind it.
 *
 * Thread contract: as for the world; during an asynchronous step every function here that takes a world answers LOAM_ERROR_BUSY.
 */
#ifndef LOAM_EMITTER_H
#define LOAM_EMITTER_H

#include <loam/base.h>
#include <loam/collider.h>
#include <loam/material.h>
#include <loam/world.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef uint64_t loam_emitter_id;

enum {
  LOAM_NOZZLE_DISC = 0, /* a disc at right angles to the flow */
  LOAM_NOZZLE_MESH = 1  /* a triangle mesh, open or closed, seen along the flow: the last that the flow crosses of it */
};

/* What happens to particles of a stream for which particle_capacity leaves no room. They never enter, and nothing that is there is overwritten; both ways they
 * are counted in the report and in loam_statistics. */
enum {
  LOAM_FULL_TELL = 0, /* loam_world_step does its step, then answers LOAM_ERROR_CAPACITY, with number and capacity needed */
  LOAM_FULL_DROP = 1  /* they are dropped, and that is all */
};

typedef struct loam_emitter_def {
  uint32_t struct_size;
  uint32_t nozzle;           /* LOAM_NOZZLE_*; default DISC */
  loam_material_id material; /* of this world; it cannot be destroyed while it streams */
  float position[3];         /* the disc's centre, or where the mesh's origin goes; metres */
  float rotation[4];         /* MESH: unit quaternion x, y, z, w; a zero quaternion means identity */
  float direction[3];        /* of the flow; any length over 0; default (0, -1, 0) */
  float radius;              /* DISC: at least half the spacing; metres */
  float speed;    /* along the direction: over 0, at most 1e4 m/s; over r / substep matter is slowed down; default 1 */
  loam_mesh mesh; /* MESH: read during the call only */

  /* What enters per second, as volume (m^3/s) or as mass (kg/s); give one of them at most. Both 0 (the default): what the opening's area carries at
   * `speed`. With less, places of each layer are left out by turns of a random choice; more is an error. What has entered since the start is exact to half
   * a layer, however long it runs. */
  float flow;
  float mass_flow;

  float spacing; /* of particles in a layer, and of layers, metres; 0 (the default): r. At least r / 2 */

  /* Each particle is moved within its layer by up to this share of the spacing, along each axis: 0 to 0.5, default 0.12. And it leaves the nozzle with up to
   * so much more or less velocity along each axis: 0 to 1e4 m/s, default 0. */
  float jitter;
  float velocity_jitter;

  /* Seconds after the emitter's creation, in the world's time. Default 0 and 0; a stop of 0 means never. 0 to 1e6, stop after start. */
  float start;
  float stop;
  uint32_t seed;      /* the same seed gives the same particles; default 1 */
  uint32_t when_full; /* LOAM_FULL_*; default TELL */
} loam_emitter_def;

/* Errors: INVALID_ARGUMENT for null or an unknown size. */
LOAM_API loam_status loam_emitter_def_default(loam_emitter_def *def, size_t size);

/* Makes an emitter. The first layer enters half a spacing's way after `start`. Its particles take consecutive ids as they come.
 * Errors: INVALID_ARGUMENT naming the field; INVALID_HANDLE for the material; INVALID_MESH; CAPACITY if a world has too many emitters, or if one layer
 * has more particles than particle_capacity; IN_USE while buffers are mapped; OUT_OF_MEMORY. */
LOAM_API loam_status loam_emitter_create(loam_world *world, const loam_emitter_def *def, loam_emitter_id *emitter);

/* Ends the stream; its particles stay. Errors: INVALID_HANDLE; IN_USE while buffers are mapped. */
LOAM_API loam_status loam_emitter_destroy(loam_world *world, loam_emitter_id emitter);

typedef struct loam_emitter_report {
  uint32_t struct_size; /* set by the caller to sizeof(loam_emitter_report) */
  uint32_t stopped;     /* 1: past its stop, nothing more will come */
  uint64_t entered;     /* particles so far */
  uint64_t dropped;     /* particles that found no room so far */
  double volume;        /* m^3 of one undeformed particle */
  double volume_flow;   /* m^3/s while it runs */
} loam_emitter_report;

/* Errors: INVALID_ARGUMENT for null or an unknown struct_size; INVALID_HANDLE. */
LOAM_API loam_status loam_emitter_get_report(const loam_world *world, loam_emitter_id emitter, loam_emitter_report *report);

#ifdef __cplusplus
}
#endif

#endif
