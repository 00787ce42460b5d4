/* Cloth: sheets made from triangle meshes, in the same substeps and iterations as all other matter.
 *
 * A triangle resists stretch along warp and weft and shear between them (Baraff and Witkin 1998), an edge between two triangles resists bending
 * (Bergou et al. 2006), all as XPBD constraints with the stiffnesses below. Threads along warp and weft keep what few iterations leave unanswered of a load from
 * stretching the cloth.
 *
 * Vertices keep `thickness` from colliders, with the collider's friction, and are swept against them, so that no vertex passes a surface. What lies between
 * vertices is not looked at: over a convex collider of radius R, edges of length L cut in by up to L^2 / (8 R), less the thickness.
 * Particles keep half a kernel radius from the triangles, and push and rub against them both ways; edges should be no longer than half of one. At the end of a substep each
 * particle's way is swept against the moving triangles. What a substep could not resolve is then taken from the particle: cloth that nothing holds (no attachment, no collider near) has its
 * share of that, so that both keep their momentum; with cloth that is held the particle alone stops. A fold that turns through itself around a grain lets it go: where matter is thrown
 * about in a bag, give the cloth a self_distance, with which folds stay open. Cloth collides with itself and with other cloth where its definition says so (self_distance).
 * In a world with cloth nothing sleeps.
 *
 * Thread contract: as for the world; during an asynchronous step every function here that takes a world answers LOAM_ERROR_BUSY.
 */
#ifndef LOAM_CLOTH_H
#define LOAM_CLOTH_H

#include <loam/base.h>
#include <loam/collider.h>
#include <loam/world.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef uint64_t loam_cloth_id;

/* What a cloth is made with. Fill it with loam_cloth_def_default first. The defaults are a light cotton. */
typedef struct loam_cloth_def {
  uint32_t struct_size;
  uint32_t reserved; /* 0 */

  /* The shape at rest, in the cloth's own frame; copied. Each vertex is a vertex of the cloth, in this order: so vertices must not be repeated for normals or textures. Every
   * vertex belongs to a triangle, every edge to at most two, which agree on their orientation. Within 1e4 m, at most 2^24 triangles. The way edges run matters little for
   * stretch and shear; bending is up to a sixth softer along the sides of a grid. */
  loam_mesh mesh;
  float position[3]; /* where the mesh's origin is at the start, metres; default 0 */
  float rotation[4]; /* unit quaternion x, y, z, w; default identity */
  float velocity[3]; /* m/s of all vertices at the start; default 0 */

  float areal_density;     /* kg/m^2, 1e-4 to 1e4; default 0.15 */
  float stretch_stiffness; /* force per width and strain along warp and weft, N/m, over 0 to 1e9; default 3000 */
  float
      shear_stiffness; /* force per width and shear angle, N/m, 0 to 1e9; default 60. A sheet without grain has half its stretch stiffness */
  float
      bending_stiffness; /* moment per width and curvature, N m, 0 to 1e6; default 1e-5. Much stiffer sheets (card) need many iterations and short substeps */
  float damping; /* of all three: stress for a rate of strain as for this many seconds of it, s, 0 to 10; default 1e-3 */

  float warp[3]; /* the direction of the warp in the cloth's own frame, laid into each triangle's plane; default (1, 0, 0) */

  /* How much longer than at rest a thread gets, as a share: chains of edges along warp and weft (within 15 degrees) are held to that as a whole, each by a direct solution, so
   * that long sheets do not hang on rubber where iterations are few. It should be more than the loads stretch the cloth to; 0: no threads. 0 to 10; default 0.005. */
  float greatest_stretch;
  float
      thickness; /* the distance that vertices keep from colliders, metres, 1e-6 to 1e3; 0 (the default): half the kernel radius */
  float particle_friction; /* Coulomb coefficient against particles, 0 to 100; default 0.5 */

  /* The distance that vertices keep from all others of this cloth, but for those that are nearer at rest, and (the mean of both) from those of other cloth that has one;
   * metres, 1e-6 to 1e3. 0 (the default): the cloth passes through itself, and that costs nothing. It should be a little more than the spacing of the vertices, the shorter
   * sides of the triangles: where it is less, sheets find their way between vertices; where it is much more, folds are round. What nears by more than twice the distance within a
   * substep may pass. */
  float self_distance;
  float self_friction; /* Coulomb coefficient of cloth on cloth, 0 to 100; of two cloths the mean counts; default 0.3 */

  /* The strain, of a triangle in any direction, above which the cloth tears: a vertex there is split, and a copy in the same place goes to the triangles on one side of the tear. So
   * there are more vertices, behind those there were, and other indices, see loam_cloth_view; what held a vertex holds the larger part. Tears go on from their ends by a
   * vertex a substep, and begin at the most strained triangle. What counts is the strain of the load that the triangle bears, but no more than the strain that shows and no less
   * than a fifth of it; so cloth that hangs too long because iterations are few does not soon tear for that, but it swings and tears early (a strip at 20 iterations, 8 substeps and a damping of 0.02 s at 0.046 instead of
   * 0.1). 1e-4 to 100; 0 (the default): never. Threads (greatest_stretch) are stiffer than the membrane: a load that stretches by more than greatest_stretch needs ten
   * times the force for every further strain. The stress of damping is part of the load: sand at
   * 1 m/s tears at once a cloth with a damping of 0.002 s that it does not tear with 0.0001 s. Cloth that may tear takes memory for all the vertices that it could fall into. */
  float tear_strain;
  uint32_t reserved_2; /* 0 */
} loam_cloth_def;

/* Errors: INVALID_ARGUMENT for null or an unknown size. */
LOAM_API loam_status loam_cloth_def_default(loam_cloth_def *def, size_t size);

/* Makes a cloth. Memory for it is taken now; none is taken by steps, but for contacts with colliders, which grow when a step needs more.
 * Errors: INVALID_ARGUMENT naming field and value (a NaN vertex, an index out of range); INVALID_MESH naming the vertices, triangle or edge (two vertices in one place, a
 * vertex of no triangle, a triangle without area, an edge of three triangles); OUT_OF_MEMORY; CAPACITY beyond 4096 cloths in a world. */
LOAM_API loam_status loam_cloth_create(loam_world *world, const loam_cloth_def *def, loam_cloth_id *cloth);

/* Errors: INVALID_HANDLE; IN_USE while the cloth is mapped. */
LOAM_API loam_status loam_cloth_destroy(loam_world *world, loam_cloth_id cloth);

/* ---------------------------------------------------------------------------------------------- attachments --- */

/* Vertices held at points of space or of a collider, with which they then move and turn. A vertex is held by one attachment at most. */
typedef struct loam_cloth_attachment_def {
  uint32_t struct_size;
  uint32_t count;           /* of vertices, at least 1 */
  const uint32_t *vertices; /* read during the call only */
  const float *
      points; /* x, y, z for each vertex, metres: in space, or in the collider's own frame. Null (the default): where each vertex is now */
  loam_collider_id collider; /* 0 (the default): space */
  float compliance;          /* of the spring that holds each vertex, m/N, 0 or 1e-9 to 1e9; 0 (the default): rigid */
  uint32_t reserved;         /* 0 */
} loam_cloth_attachment_def;

/* Errors: INVALID_ARGUMENT for null or an unknown size. */
LOAM_API loam_status loam_cloth_attachment_def_default(loam_cloth_attachment_def *def, size_t size);

/* Attaches vertices, all or, on an error, none. A vertex that is not at its point goes there within the next substep if the attachment is rigid. Rigidly attached vertices
 * pass through colliders.
 * Errors: INVALID_HANDLE for the cloth or the collider; INVALID_ARGUMENT naming the vertex; IN_USE for a vertex that is attached already, and while the cloth is
 * mapped; OUT_OF_MEMORY. */
LOAM_API loam_status loam_cloth_attach(loam_world *world, loam_cloth_id cloth, const loam_cloth_attachment_def *def);

/* Lets go of vertices, all or, on an error, none. They keep their velocities.
 * Errors: INVALID_HANDLE; INVALID_ARGUMENT naming the vertex that is not attached; IN_USE while the cloth is mapped. */
LOAM_API loam_status loam_cloth_release(loam_world *world, loam_cloth_id cloth, const uint32_t *vertices, uint32_t count);

/* ----------------------------------------------------------------------------------------------------- wind --- */

/* Air of 1.2 kg/m^3 that moves at `velocity` (m/s, each component at most 1e4) past the cloth, from the next step on. On each triangle of area A with the normal n, and with u
 * the air's velocity past it:
 *   drag 1/2 rho C_D A |u| |n . u| along u,  and lift 1/2 rho C_L A |u| |n . u| times the sine of their angle, across u, to the side where the cloth yields to the air.
 * `drag` C_D and `lift` C_L are 0 to 100; with both 0, as at the start, there is no air.
 * Errors: INVALID_HANDLE, INVALID_ARGUMENT. */
LOAM_API loam_status loam_cloth_set_wind(loam_world *world, loam_cloth_id cloth, const float velocity[3], float drag,
                                         float lift);

/* -------------------------------------------------------------------------------------------------- buffers --- */

/* The solver's own buffers, not copies: read-only, in the order of the mesh's vertices; those that tears have made come behind. */
typedef struct loam_cloth_view {
  uint32_t struct_size; /* set by the caller to sizeof(loam_cloth_view) */
  uint32_t memory;      /* LOAM_MEMORY_*: which processor the pointers are good for */
  uint32_t vertex_count;
  uint32_t reserved;
  const float *positions;  /* stride of 4 floats: x, y, z, 0 */
  const float *velocities; /* stride of 4 floats: x, y, z, and the inverse mass in 1/kg (0: rigidly attached) */
  const float
      *normals; /* stride of 4 floats: the mean of the triangles around, of length 1 (0 where there is none), and 0 */
  const uint32_t *indices; /* three vertices a triangle, as in the mesh until the cloth tears */
  uint32_t triangle_count; /* that of the mesh, always */
  uint32_t reserved_2;
} loam_cloth_view;

/* Gives the pointers. They are valid until loam_cloth_unmap or loam_world_destroy; in between, calls that would change the cloth fail with IN_USE. Costs no copy, except
 * `normals`, which are computed by this call.
 * Errors: INVALID_HANDLE; INVALID_ARGUMENT; IN_USE if mapped already; OUT_OF_MEMORY. */
LOAM_API loam_status loam_cloth_map(loam_world *world, loam_cloth_id cloth, loam_cloth_view *view);

/* Ends the mapping. Errors: INVALID_HANDLE; INVALID_ARGUMENT if the cloth is not mapped. */
LOAM_API loam_status loam_cloth_unmap(loam_world *world, loam_cloth_id cloth);

#ifdef __cplusplus
}
#endif

#endif
