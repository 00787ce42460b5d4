/* Snapshots: the state of a world in a block of the host's memory, to go back to (rollback, replay, a saved game).
 *
 * A snapshot holds what moves: particles, vertices of cloth with what they are attached to, poses of colliders and the vertices
 * of meshes that deform, how far streams are, where fields and
 * killers are and which blasts are over, wind, gravity and what accuracy.h has set. It does not hold what the host described once, meshes above all, nor what
 * can be found again: neighbours, contacts, distances to colliders, statistics. So it is restored into a world that was described alike, be it the one that was saved, or one made anew:
 *
 *   of loam_world_def     kernel_radius, solver, plasticity, velocity_smoothing, minimum_distance, gradient_cutoff, particle_capacity,
 *                         multiplier, zero_energy_stiffness, warm_start, sleep_speed, sleep_delay
 *   materials             the same places in the order of creation (a place of a destroyed one is taken by the next), the same definitions but for
 *                         the name, and the same meetings
 *   colliders             the same places, kind, contacts, dimensions, meshes (as the collider was made) and grids
 *   cloths                the same places, mesh and definition, but for where the cloth began
 *   emitters              the same places and definitions, but for where the nozzle began and when_full
 *   fields and killers    the same places and definitions, but for their positions and rotations
 *
 * Everything else may differ: threads, instruction set, job system, allocator, pair_capacity, backend. From then on the world steps as the saved one
 * did, with the same bits where it runs on the same backend. Ids of particles become those of the snapshot, all others stay those of the world that is
 * restored. Free memory of the world is neither taken nor given back, but for materials and attachments that
 * need more than the world ever had.
 *
 * The format is little-endian on every machine that the library runs on, begins with "LOAMSNAP" and the version of the format below, and has a
 * checksum over all of its bytes. The library reads its own version only. A particle takes 56 bytes, and 24 more with a warm start; and 12 more, 24 with a warm start, where a
 * material of the world resists zero-energy modes (see loam_world_def.zero_energy_stiffness). Besides, a particle takes 1 byte each for its mass, its volume, its material and
 * what its law remembers of yielding where the world has 2 to 256 different values of it, and 4 where there are more: so sand that has flowed takes 84. A
 * vertex of a cloth takes 24 bytes, as does one of a mesh that deforms.
 *
 * Thread contract: as for the world; during an asynchronous step every function here that takes a world answers LOAM_ERROR_BUSY.
 */
#ifndef LOAM_SNAPSHOT_H
#define LOAM_SNAPSHOT_H

#include <loam/base.h>
#include <loam/world.h>

#ifdef __cplusplus
extern "C" {
#endif

#define LOAM_SNAPSHOT_VERSION 7

/* The bytes that a snapshot of the world as it is now takes, exactly. Reads part of the particles, and so takes about a quarter of the time of saving.
 * Errors: INVALID_ARGUMENT for null. */
LOAM_API loam_status loam_snapshot_size(const loam_world *world, uint64_t *bytes);

/* Writes a snapshot to `memory`, of any alignment. *bytes (may be null) receives its size. Buffers may be mapped. Takes no memory but for
 * bookkeeping.
 * Errors: INVALID_ARGUMENT for null; CAPACITY with the bytes needed if `capacity` is less; nothing is written then. */
LOAM_API loam_status loam_snapshot_save(const loam_world *world, void *memory, uint64_t capacity, uint64_t *bytes);

/* Puts the world into the state of a snapshot. `bytes` is its size, exactly as saved; `memory` is read during the call only.
 * Errors: INVALID_SNAPSHOT for what is cut short, has bytes behind its end, is of another version, or is damaged in a single bit; SNAPSHOT_MISMATCH
 * naming the first field in which the world's description differs, with both values; IN_USE while buffers are mapped; OUT_OF_MEMORY;
 * INVALID_ARGUMENT for null. */
LOAM_API loam_status loam_snapshot_restore(loam_world *world, const void *memory, uint64_t bytes);

#ifdef __cplusplus
}
#endif

#endif
