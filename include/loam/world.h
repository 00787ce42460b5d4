/* The world: everything that is simulated together, and its step.
 *
 * Thread contract of the whole header: a world is used by one thread at a time; two worlds may be used by two threads
 * at once. The library has no global state beside the last error text of each thread.
 *
 * During an asynchronous step, from loam_world_step_async to loam_world_wait, every function of this and the other headers that takes the world answers
 * LOAM_ERROR_BUSY and does nothing, but for four: loam_world_wait, loam_world_is_stepping, loam_world_get_backend, and loam_world_destroy, which waits.
 * Functions without a world may be called at any time.
 */
#ifndef LOAM_WORLD_H
#define LOAM_WORLD_H

#include <loam/base.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct loam_world loam_world;

/* Which machine runs the world. */
enum {
  LOAM_BACKEND_AUTO = 0, /* CUDA where a usable device is found, otherwise the CPU */
  LOAM_BACKEND_CPU = 1,
  LOAM_BACKEND_CUDA = 2 /* LOAM_ERROR_BACKEND_UNAVAILABLE where there is no device, no driver, or no CUDA build */
};

/* How the constraints of one iteration are visited. */
enum {
  LOAM_SOLVER_GAUSS_SEIDEL = 0, /* in turn, cells of one colour at a time: converges fastest */
  LOAM_SOLVER_JACOBI = 1        /* all at once, with split masses: fewer, larger launches; needs more iterations */
};

/* The form of the constraints' Lagrange multipliers. */
enum {
  LOAM_MULTIPLIER_PROJECTED_TENSOR =
      0, /* an impulse tensor a particle, corrected in every visit until it is that of the implicit step: with more
                                         * iterations or shorter substeps the motion converges to the material's */
  LOAM_MULTIPLIER_SCALAR =
      1 /* one scalar a particle, as in the XPBI paper; somewhat cheaper; bodies act softer than their moduli, and creep */
};

/* When the plastic return mapping acts. */
enum {
  LOAM_PLASTICITY_IMPLICIT = 0, /* inside every iteration, as the method asks */
  LOAM_PLASTICITY_SEMI_IMPLICIT =
      1 /* once, at the end of the substep; matter then behaves like jelly: for comparison only */
};

/* The instruction set of the CPU backend. Results have the same bits with each of them. */
enum {
  LOAM_INSTRUCTION_SET_AUTO = 0, /* the widest that this machine has */
  LOAM_INSTRUCTION_SET_PORTABLE = 1,
  LOAM_INSTRUCTION_SET_SSE4 = 2,
  LOAM_INSTRUCTION_SET_AVX2 = 3,
  LOAM_INSTRUCTION_SET_AVX512 = 4
};

/* What a world is made with. Fill it with loam_world_def_default first, then change what matters. */
typedef struct loam_world_def {
  uint32_t struct_size; /* sizeof(loam_world_def) of the header that the host was compiled with */
  uint32_t backend;     /* LOAM_BACKEND_*; default AUTO */

  float gravity[3]; /* m/s^2; default (0, -9.81, 0) */

  /* r, in metres: the length scale of the discretisation. A particle feels others up to 2 r away; particles are placed
   * about r apart. Halving it makes eight times the particles. Range 1e-6 to 1e6; default 0.01. */
  float kernel_radius;

  /* A step of t seconds is cut into this many substeps of t / substeps. Accuracy and stiffness come from short substeps
   * first, from iterations second. Matter moving faster than r / substep is slowed down to that, and too stiff for the substep it is softened: see
   * loam_statistics.stiffness_share. 1 to 10000; default 16. */
  uint32_t substeps;

  /* Passes over all constraints in a substep. 1 to 1000; default 5. */
  uint32_t iterations;

  uint32_t solver;     /* LOAM_SOLVER_*; default GAUSS_SEIDEL */
  uint32_t plasticity; /* LOAM_PLASTICITY_*; default IMPLICIT */

  /* Share of the velocity differences between neighbours that is smoothed away per second (XSPH, equation 20 of the XPBI
   * paper, scaled by the substep so that it does not depend on it). 0 switches the stage off. 0 to 1e4, and at most 1 within a
   * substep; default 20. */
  float velocity_smoothing;

  /* The least distance between particles, as a share of r, that position correction keeps: the r - eps of the paper, whose
   * eps is 0.25 r. 0 switches the stage off. 0 to 1; default 0.75. */
  float minimum_distance;

  /* Singular values of the kernel-gradient correction below this share of a full neighbourhood's value are cut off: it decides
   * how far a sparse neighbourhood (a surface, a lone pair) may be trusted. 0.01 to 1; default 0.2. */
  float gradient_cutoff;

  /* Threads of the CPU backend that take part in a step, the caller's included. 0: as many as the machine has. At most 256.
   * Results do not depend on it. */
  uint32_t thread_count;
  uint32_t instruction_set; /* LOAM_INSTRUCTION_SET_*; default AUTO; one that the machine lacks is an error */

  /* The most particles the world will ever hold; memory for them is taken at once. 1 to 2^28; default 65536. */
  uint64_t particle_capacity;

  /* The most neighbour pairs (ordered, so about 28 a particle at the usual density). 0: pair storage grows when a step needs
   * more, outside the steady state. Otherwise a step that needs more fails with LOAM_ERROR_CAPACITY. Default 0. */
  uint64_t pair_capacity;

  loam_allocator allocator;
  loam_job_system job_system;
  loam_log log;

  uint32_t multiplier; /* LOAM_MULTIPLIER_*; default PROJECTED_TENSOR */

  /* Motion of neighbours against each other that no velocity gradient shows (zig-zags) is resisted by a spring with this share of the shear
   * modulus, and yields with the matter; it is independent of the substep and vanishes as r becomes small. For all laws but DRUCKER_PRAGER, with
   * PROJECTED_TENSOR. 0 to 100; default 10. */
  float zero_energy_stiffness;

  /* Sleep: particles that were slower than sleep_speed (m/s) for sleep_delay (s) are held in place and cost next to nothing until something reaches
   * them: a neighbour twice as fast, a moving collider, new gravity, a changed material, or loam_world_wake. The error is bounded by the speed: what would creep slower is stopped. A speed of 0.1 r to 0.5 r a second stops what no one sees; slower, loose grains at a pile's foot
   * stay awake for long; over about g sleep_delay / 2 it would stop what hangs in the air at the top of its flight.
   * sleep_speed: 0 to 1e3; default 0: nothing sleeps, and sleep takes neither time nor memory. sleep_delay: 0.01 to 1e3; default 0.5. */
  float sleep_speed;
  float sleep_delay;

  /* 1: the iterations of a substep start from the stress with which the last one ended, where no elastic wave crosses more than 2/3 r an
   * iteration in a substep and neighbours are not much lighter; so what rests is in equilibrium, as stiff as it should be, with any number of them. It
   * costs about half an iteration, and 24 bytes a particle (36 where something resists zero-energy modes). 0: they start from zero. Only with
   * GAUSS_SEIDEL, PROJECTED_TENSOR and plasticity IMPLICIT. Default 0. */
  uint32_t warm_start;
} loam_world_def;

/* Writes the defaults above. `size` is sizeof(loam_world_def); at most that many bytes are written.
 * Errors: INVALID_ARGUMENT if `def` is null or `size` is not that of a known version. */
LOAM_API loam_status loam_world_def_default(loam_world_def *def, size_t size);

/* Makes a world. The definition is copied. On success *world is to be given to loam_world_destroy; on failure it is null.
 * Errors: INVALID_ARGUMENT (names the field), OUT_OF_MEMORY, BACKEND_UNAVAILABLE. */
LOAM_API loam_status loam_world_create(const loam_world_def *def, loam_world **world);

/* Ends a world, its memory and all its ids. Mapped pointers become invalid. Null is allowed and does nothing. */
LOAM_API loam_status loam_world_destroy(loam_world *world);

/* Advances the world by `seconds` (over 0, at most 1), in the definition's number of substeps, or as accuracy.h has them chosen.
 * Errors: INVALID_ARGUMENT; IN_USE while particle buffers are mapped; CAPACITY or OUT_OF_MEMORY if the neighbour pairs need more
 * room; CAPACITY if a stream found no room (see loam_emitter_def.when_full); BUDGET after a step that
 * took more than that, see accuracy.h. On CAPACITY or OUT_OF_MEMORY the world stands at the end of the last whole
 * substep (*statistics.substeps_done of them): for a stream's sake that is the end of the step. */
LOAM_API loam_status loam_world_step(loam_world *world, float seconds);

/* Begins a step like loam_world_step and returns at once; the step runs on a thread that the world starts with its first asynchronous step and keeps until it
 * is destroyed (so does, with it, what the hooks for memory and jobs are called from). Its result has the same bits. What was to be read of the last frame
 * meanwhile is to be kept before: loam_particles_keep.
 * Errors: those of loam_world_step for its arguments and for mapped buffers; OUT_OF_MEMORY without a thread; BUSY. Then no step was begun. */
LOAM_API loam_status loam_world_step_async(loam_world *world, float seconds);

/* Waits until the asynchronous step is over, and answers with what loam_world_step would have, its error text and its line in the log included. Any thread.
 * Errors: those of loam_world_step; INVALID_ARGUMENT if no step was begun. */
LOAM_API loam_status loam_world_wait(loam_world *world);

/* *running receives 1 while an asynchronous step is under way; 0 when loam_world_wait would return at once, or when none was begun.
 * Errors: INVALID_ARGUMENT for null. */
LOAM_API loam_status loam_world_is_stepping(const loam_world *world, uint32_t *running);

/* Makes the point `offset` (metres, each component at most 1e6 kernel radii in size) the origin: takes it away from the positions of all particles, of cloth and
 * what it is attached to in space, and of colliders with where they move to. For worlds in which the matter goes far: single precision has its digits near the
 * origin.
 *
 * A coordinate x moves exactly where the digits of x - offset fit: always when offset is a whole multiple of a power of two P (such as 1024 m), |x| is at most
 * 2^24 P, and |x - offset| is at most |x|. So shifting towards the matter loses nothing, and distances stay what they were to the last bit. Away from it,
 * coordinates are rounded to their new last place. Later steps are the same motion, in other bits: cells lie elsewhere.
 * Errors: INVALID_ARGUMENT; IN_USE while buffers are mapped. A kept frame stays as it is. */
LOAM_API loam_status loam_world_shift_origin(loam_world *world, const float offset[3]);

/* Gravity in m/s^2 from the next step on. Errors: INVALID_ARGUMENT if a component is not finite or beyond 1e6. */
LOAM_API loam_status loam_world_set_gravity(loam_world *world, const float gravity[3]);

/* Substeps and iterations from the next step on; ranges as in the definition. accuracy.h has more. */
LOAM_API loam_status loam_world_set_accuracy(loam_world *world, uint32_t substeps, uint32_t iterations);

/* Wakes all that sleeps, at the start of the next step; see loam_world_def.sleep_speed. */
LOAM_API loam_status loam_world_wake(loam_world *world);

/* The backend that the world really uses: LOAM_BACKEND_CPU or LOAM_BACKEND_CUDA; and, on the CPU, the instruction set. Either
 * pointer may be null. */
LOAM_API loam_status loam_world_get_backend(const loam_world *world, uint32_t *backend, uint32_t *instruction_set);

/* A 64-bit hash of the state of all matter: of each particle its place in the solver's order, position, velocity, strain, volumes, mass, what its law
 * remembers, id, material and, where a killer asks, age; of each vertex of cloth its position, velocity and mass; of each emitter how far its stream is.
 * It does not cover what the host says: definitions, gravity, poses of colliders, wind, attachments. Same build, backend and inputs: same hash, for any number of threads and any
 * instruction set; and two worlds that were told the same and have equal hashes step alike. */
LOAM_API loam_status loam_world_state_hash(const loam_world *world, uint64_t *hash);

/* ------------------------------------------------------------------------------------------------ statistics --- */

/* Totals of the last loam_world_step. */
typedef struct loam_statistics {
  uint32_t struct_size;   /* set by the caller to sizeof(loam_statistics) */
  uint32_t substeps_done; /* whole substeps of the last step */

  uint64_t particles;   /* now in the world */
  uint64_t pairs;       /* ordered neighbour pairs in the last substep */
  uint64_t pairs_peak;  /* the most in any substep so far: what pair_capacity would have to be */
  uint64_t pair_visits; /* pairs x iterations, summed over the substeps of the step */
  uint64_t contacts;    /* collider contact planes in the last substep */
  uint64_t non_finite; /* particles whose position, velocity or strain is not finite now; such a particle is held in place */
  uint64_t speed_limited;  /* times a particle was slowed to r / substep in the step */
  uint64_t strain_limited; /* times a strain was clamped to its bound in the step */

  double step_seconds; /* wall time of the step */

  /* Of the last iteration. SCALAR: the root of the sum of (C + alpha~ lambda)^2 over the sum of C^2; small means that the iteration has settled, not
   * that the step is solved exactly. PROJECTED_TENSOR: the root of the sum of squared stresses that one more visit would change, over that of the
   * stresses; small means that the step is solved. 0 where nothing is strained, or where single precision overflows. */
  double residual;

  /* The stress that matter shows over the stress that its weight calls for, from the virial theorem along gravity:
   *   (sum of pair forces' moments - sum V0 tau : u u^T) / (sum m g . x - moment of the contact forces),  u the direction of gravity.
   * 1 in true equilibrium at rest. An unconverged solve passes on only part of the stress, so matter deforms as if its moduli were smaller by this
   * factor: 2 means twice too soft. Meaningful only at rest. 0 without gravity or contacts, or where single precision overflows. */
  double virial;

  double kinetic_energy; /* J */
  double max_speed;      /* m/s */
  double mean_speed;     /* m/s */
  double momentum[3];    /* kg m/s */

  /* The least share of its Young's modulus that a material acted with in the step: with PROJECTED_TENSOR, elastic waves may cross r an iteration in a
   * substep, c <= iterations r / substep; stiffer matter is softened to that (its yield stress stays), since an unconverged step would otherwise give back more
   * energy than it was given. 1: none was. For the full stiffness take shorter substeps or more iterations. */
  double stiffness_share;

  /* Times in the step that the end of a substep took a particle's strain by an eigen-decomposition: elastic strains beyond about a fifth leave the
   * range of the polynomials that serve all others. It costs a few times as much, and no accuracy. */
  uint64_t strain_decomposed;

  uint64_t sleeping; /* particles that sleep now, see loam_world_def.sleep_speed */

  /* Of the emitters, in the step: particles that came in, and particles that found no room. With a particle_capacity of capacity_needed none would have
   * been dropped since the world was made; 0 where none was. */
  uint64_t particles_entered;
  uint64_t particles_dropped;
  uint64_t capacity_needed;

  uint64_t particles_killed; /* by killers, at the end of the step */

  uint64_t cloth_tears; /* vertices of cloth that tore apart in the step, see loam_cloth_def.tear_strain */

  /* What the step did for accuracy, see accuracy.h. */
  uint32_t substeps;          /* that it was cut into */
  uint32_t iterations;        /* of each substep that has something to solve; with a tolerance, the most that one took */
  uint32_t substeps_reason;   /* LOAM_SUBSTEPS_* */
  uint32_t substeps_unsolved; /* with a tolerance: those whose iterations ended above it */
  uint64_t iterations_done;   /* of all substeps together */
  double solution_error;      /* with a tolerance: the greatest of the substeps' estimates; otherwise 0 */
  double least_budget;        /* with a budget: seconds that what stability needs takes, by the costs so far; otherwise 0 */

  /* How far matter was from what it should keep to, at the start of the last substep. */
  double density_error; /* of fluids: the mean compression, density over rest density less 1, 0 where it is less */
  double stretch;       /* of cloth: the greatest stretch of a triangle in any direction, less 1; 0 without */
  double penetration;   /* m: how deep a sphere of radius r/2 around a particle was within a collider, at most */
} loam_statistics;

/* Errors: INVALID_ARGUMENT for null or an unknown struct_size. */
LOAM_API loam_status loam_world_get_statistics(const loam_world *world, loam_statistics *statistics);

/* One stage of the schedule that the world's contents call for, in the order of execution. */
typedef struct loam_stage {
  char name[48];  /* such as "solve dry_sand" or "neighbour search"; always terminated */
  double seconds; /* wall time within the last loam_world_step */
  uint64_t items; /* what it worked through in that step: particles, pairs or contacts, times its executions */
} loam_stage;

/* Copies up to `capacity` stages of the next step, as the world's contents call for them now; *count receives how many there are. Times and items are those of the
 * last step, or 0 where what the world contains has changed since. `stages` may be null when `capacity` is 0. */
LOAM_API loam_status loam_world_get_stages(const loam_world *world, loam_stage *stages, uint32_t capacity, uint32_t *count);

/* Memory that the world holds for one effect, on the machine that runs it. */
typedef struct loam_memory {
  char effect[48]; /* such as "particles", "neighbour pairs", "colliders" */
  uint64_t bytes;
} loam_memory;

/* Copies up to `capacity` rows; *count receives how many there are. `rows` may be null when `capacity` is 0. */
LOAM_API loam_status loam_world_get_memory(const loam_world *world, loam_memory *rows, uint32_t capacity, uint32_t *count);

#ifdef __cplusplus
}
#endif

#endif
