/* Killers: volumes and ages that take particles out of the world.
 *
 * They look once a step, at its end: so a volume should be at least as thick as matter goes in a step. The particles that go are counted, their ids can be asked
 * for and do not come back, and their places are free for others: a stream that ends in a killer runs for ever within a capacity. A world without killers has no
 * stage for them.
 *
 * Thread contract: as for the world; during an asynchronous step every function here that takes a world answers LOAM_ERROR_BUSY.
 */
#ifndef LOAM_KILLER_H
#define LOAM_KILLER_H

#include <loam/base.h>
#include <loam/world.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef uint64_t loam_killer_id;

enum {
  LOAM_KILLER_BOX = 0,    /* particles in a box */
  LOAM_KILLER_SPHERE = 1, /* in a sphere */
  LOAM_KILLER_AGE = 2     /* that are older than an age. While a world has one of these, a particle takes 8 bytes more */
};

typedef struct loam_killer_def {
  uint32_t struct_size;
  uint32_t kind;             /* LOAM_KILLER_*; default BOX */
  loam_material_id material; /* only particles of this; 0 (the default): of any. It cannot be destroyed meanwhile */
  float position[3];         /* the volume's centre, metres; default 0 */
  float rotation[4];         /* BOX: unit quaternion x, y, z, w; default identity */
  float half_extents[3];     /* BOX: over 0, at most 1e8 m; default 0 */
  float radius;              /* SPHERE: the same */
  float
      age; /* AGE: seconds, over 0, at most 1e6; to a step. It counts from where a particle entered, or the first killer of this kind was made */
  uint32_t outside;  /* BOX, SPHERE: 1: particles outside of the volume; default 0 */
  uint32_t reserved; /* 0 */
} loam_killer_def;

/* Errors: INVALID_ARGUMENT for null or an unknown size. */
LOAM_API loam_status loam_killer_def_default(loam_killer_def *def, size_t size);

/* Makes a killer. Pinned particles go as well.
 * Errors: INVALID_ARGUMENT naming the field; INVALID_HANDLE for the material; CAPACITY beyond 1024 killers in a world; IN_USE while buffers are mapped;
 * OUT_OF_MEMORY. */
LOAM_API loam_status loam_killer_create(loam_world *world, const loam_killer_def *def, loam_killer_id *killer);

/* Gives it another definition; its count goes on. Errors: those of create; INVALID_HANDLE. */
LOAM_API loam_status loam_killer_set(loam_world *world, loam_killer_id killer, const loam_killer_def *def);

/* Errors: INVALID_HANDLE; IN_USE while buffers are mapped. */
LOAM_API loam_status loam_killer_destroy(loam_world *world, loam_killer_id killer);

/* What it killed: *total since it was made, and the ids of those of the last step, in ascending order. Up to `capacity` ids are copied; *count receives how many
 * there are. `total` may be null, and `ids` when `capacity` is 0. Where several killers claim a particle, the one that was made first has it, in the order of
 * their places. loam_snapshot_restore brings the total back, and leaves no ids.
 * Errors: INVALID_HANDLE; INVALID_ARGUMENT. */
LOAM_API loam_status loam_killer_get_killed(const loam_world *world, loam_killer_id killer, uint64_t *total, uint32_t *ids,
                                            uint64_t capacity, uint64_t *count);

#ifdef __cplusplus
}
#endif

#endif
