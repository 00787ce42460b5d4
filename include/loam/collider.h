/* Colliders: what matter runs into. They are moved by the host; matter does not move them.
 *
 * Thread contract: as for the world; during an asynchronous step every function here that takes a world answers LOAM_ERROR_BUSY.
 */
#ifndef LOAM_COLLIDER_H
#define LOAM_COLLIDER_H

#include <loam/base.h>
#include <loam/world.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A triangle mesh that belongs to the host; the library reads it during the call only. Three indices a triangle. For a closed mesh
 * the triangles are counter-clockwise seen from outside. */
typedef struct loam_mesh {
  const float *positions; /* x, y, z of each vertex, metres */
  const uint32_t *indices;
  uint32_t vertex_count;
  uint32_t triangle_count;
} loam_mesh;

/* A solid by its signed distance, metres, at the points of a grid: under 0 inside. Between the points it is trilinear; outside of the grid nothing is
 * solid. Its details should be a few spacings wide, and about a kernel radius or more. Belongs to the host; read during the call only. */
typedef struct loam_distance_grid {
  const float *values; /* size[0] x size[1] x size[2], x fastest, then y, then z */
  float origin[3];     /* where the first value is, in the collider's own frame */
  float spacing;       /* between points, metres, 1e-6 to 1e6 */
  uint32_t size[3];    /* points along x, y, z; 2 to 65536 each, at most 2^28 in all */
  uint32_t reserved;   /* 0 */
} loam_distance_grid;

/* All but MESH are solid. A particle that finds itself inside a solid is not thrown out, but comes out slowly on the nearest side. */
enum {
  LOAM_COLLIDER_PLANE = 0,   /* the half space below the plane is solid: local y <= 0 */
  LOAM_COLLIDER_MESH = 1,    /* a surface, solid on neither side: matter stays on the side where it is */
  LOAM_COLLIDER_SPHERE = 2,  /* of `radius` */
  LOAM_COLLIDER_CAPSULE = 3, /* all within `radius` of the segment from (0, -half_height, 0) to (0, half_height, 0) */
  LOAM_COLLIDER_BOX = 4,     /* of `half_extents`, along the axes of its frame */
  LOAM_COLLIDER_HULL = 5, /* what `mesh` encloses: closed, convex to a thousandth of its size, facing outward, at most 1024
                                triangles */
  LOAM_COLLIDER_GRID = 6  /* where the distances of `grid` are 0 or less */
};

typedef struct loam_collider_def {
  uint32_t struct_size;
  uint32_t kind;     /* LOAM_COLLIDER_*; default PLANE */
  float position[3]; /* where the collider's origin is, metres; default 0 */
  float rotation[4]; /* unit quaternion x, y, z, w; default identity; normalised by the library */
  float friction; /* Coulomb coefficient, 0 to 100; default 0.6; for a material of its own see loam_collider_set_contact */
  uint32_t reserved; /* 0 */
  loam_mesh mesh;    /* MESH and HULL only, in the collider's own frame; copied */

  /* Lengths are each for the kinds that name them. Metres, over 0 and at most 1e8; half_height may be 0. Default 0. */
  float radius;
  float half_height;
  float half_extents[3];
  uint32_t reaction;       /* any kind: 1 if loam_collider_get_reaction will be asked, else 0; default 0 */
  loam_distance_grid grid; /* copied */

  float restitution; /* see loam_collider_contact; default 0 */
  float stick;       /* the same; default 0 */

  uint32_t deforms;    /* MESH only: 1 if its vertices will be moved, see loam_collider_move_vertices; default 0 */
  uint32_t reserved_2; /* 0 */
} loam_collider_def;

/* Errors: INVALID_ARGUMENT for null or an unknown size. */
LOAM_API loam_status loam_collider_def_default(loam_collider_def *def, size_t size);

/* Makes a collider. Meshes of kind MESH need not be perfect: degenerate triangles are dropped and counted, open and non-manifold edges are
 * accepted and counted (see loam_collider_get_report).
 * Errors: INVALID_ARGUMENT naming field and value (a NaN vertex, an index out of range, values of a grid that are no distances: they change
 * by more than twice the spacing from point to point, or are nowhere 0 or less); INVALID_MESH if no usable triangle is left, or if a HULL's mesh is
 * open, not convex or flat; OUT_OF_MEMORY; CAPACITY beyond 4096 colliders in a world. */
LOAM_API loam_status loam_collider_create(loam_world *world, const loam_collider_def *def, loam_collider_id *collider);

/* Errors: INVALID_HANDLE. */
LOAM_API loam_status loam_collider_destroy(loam_world *world, loam_collider_id collider);

/* Where the collider is to be at the end of the next step. During that step it moves there at constant velocity and spin (pose
 * interpolated over the substeps), carrying and pushing what it touches; after it, it rests there until moved again.
 * Errors: INVALID_HANDLE, INVALID_ARGUMENT. */
LOAM_API loam_status loam_collider_move(loam_world *world, loam_collider_id collider, const float position[3],
                                        const float rotation[4]);

/* Like move, but at once and without a velocity: a teleport. Matter that was inside or in between is not pushed. */
LOAM_API loam_status loam_collider_place(loam_world *world, loam_collider_id collider, const float position[3],
                                         const float rotation[4]);

/* Where the vertices of a mesh are to be at the end of the next step, in the collider's own frame: x, y, z of each, metres, as many and in the order of the mesh
 * that the collider was made of; its triangles stay. `positions` belongs to the host and is read during the call only. During the step each vertex goes
 * there on a straight line at constant speed, in the frame of the collider, which may be moved as well; matter is carried and pushed, by friction too, by the
 * speed of the point that it touches. After it the vertices rest there until moved again; a second call before the step replaces the first. Another step
 * than expected (a failed one) leaves them where its last substep did, on their way.
 *
 * Features of the surface are those of the mesh as made: vertices that had the same place then should stay together, and parts of a skin that will come
 * apart should not touch in the mesh that the collider is made of. A triangle that loses its area is met as the line or point that it is. Surfaces that pass through each
 * other, or close on matter between them, leave it no place: it stays on its side of most of them, but not for certain. A triangle should not turn
 * by more than about a quarter turn in a substep.
 *
 * In a step in which its vertices move it wakes what sleeps within its greatest distance from its origin. Moving costs time by the number of
 * triangles, in every substep; resting costs none. Cloth attached to the collider is attached to its frame, not to its vertices.
 * Errors: INVALID_HANDLE; INVALID_ARGUMENT for a null, for another number of vertices, naming the index and value of what is not finite or beyond
 * 1e8 m, and for a collider that was made with deforms 0. The vertices then stay as they were. */
LOAM_API loam_status loam_collider_move_vertices(loam_world *world, loam_collider_id collider, const float *positions,
                                                 uint32_t vertex_count);

/* Like move_vertices, but at once and without a velocity, as loam_collider_place. */
LOAM_API loam_status loam_collider_place_vertices(loam_world *world, loam_collider_id collider, const float *positions,
                                                  uint32_t vertex_count);

/* How matter behaves on a collider. */
typedef struct loam_collider_contact {
  uint32_t struct_size; /* set by the caller */
  float friction;       /* Coulomb coefficient, 0 to 100 */

  /* Share of the speed, relative to the surface, at which a particle leaves after it hit: 0 to 1. Impacts slower than what gravity gives in four
   * substeps do not bounce, so that matter can rest. */
  float restitution;

  /* The tension, pascals, by which the surface holds on to what touches it: 0 to 1e9. It acts on a particle's own face, the power 2/3 of its volume, and
   * friction acts as if matter were pressed on by so much more. It lets go a tenth of half a kernel radius away from contact. A layer of
   * height H hangs from a ceiling if stick exceeds density x gravity x H. */
  float stick;
} loam_collider_contact;

/* How one material behaves on one collider, from the next step on. `material` 0 stands for all that have no contact of their own with this
 * collider, as the definition said; `contact` null takes a material's own away again. It ends with the material.
 * Errors: INVALID_HANDLE; INVALID_ARGUMENT naming the field, or for null with material 0. */
LOAM_API loam_status loam_collider_set_contact(loam_world *world, loam_collider_id collider, loam_material_id material,
                                               const loam_collider_contact *contact);

/* What holds for a material, or with `material` 0 for all that have no contact of their own. Errors: INVALID_HANDLE, INVALID_ARGUMENT. */
LOAM_API loam_status loam_collider_get_contact(const loam_world *world, loam_collider_id collider, loam_material_id material,
                                               loam_collider_contact *contact);

/* What matter did to a collider in the last loam_world_step: what a rigid body of the host is to be pushed by. Particles and cloth count that touch it;
 * not cloth that is attached to it, and not what sleeps: a host that weighs its matter does not let it sleep. */
typedef struct loam_collider_reaction {
  uint32_t struct_size; /* set by the caller */
  uint32_t reserved;    /* 0 */

  /* The momentum that contact took from the matter, kg m/s, in the world's directions. Over the step's seconds it is the mean force. */
  double impulse[3];

  /* The moment of those impulses about the collider's origin, where it was in each substep, kg m^2/s, in the world's directions. Each acts at the centre of
   * its particle, half a kernel radius off the surface, or at its vertex: so the moment is what the matter lost. */
  double torque[3];

  uint64_t contacts; /* contact planes of this collider that pressed on a particle or a vertex in the last substep */
} loam_collider_reaction;

/* Of a collider whose definition had reaction 1. All 0 before the first step; a step that fails and loam_snapshot_restore leave it as it was. The same bits
 * for any number of threads. Not in it: what the bounds of speed take (loam_statistics.speed_limited).
 * Errors: INVALID_HANDLE; INVALID_ARGUMENT, also if reaction was 0. */
LOAM_API loam_status loam_collider_get_reaction(const loam_world *world, loam_collider_id collider,
                                                loam_collider_reaction *reaction);

/* What the library found in a collider's mesh. Without a mesh all counts are 0. */
typedef struct loam_collider_report {
  uint32_t struct_size;          /* set by the caller */
  uint32_t triangles;            /* kept */
  uint32_t degenerate_triangles; /* dropped: zero area or repeated vertices */
  uint32_t open_edges;           /* edges of one triangle only */
  uint32_t non_manifold_edges;   /* edges of three triangles or more, or of two that disagree on the orientation */
  uint32_t closed;               /* 1 if there is an inside: no open or non-manifold edge */
} loam_collider_report;

/* Errors: INVALID_HANDLE, INVALID_ARGUMENT. */
LOAM_API loam_status loam_collider_get_report(const loam_world *world, loam_collider_id collider,
                                              loam_collider_report *report);

#ifdef __cplusplus
}
#endif

#endif
