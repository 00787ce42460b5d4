/* Accuracy and what it costs: how a world chooses the substeps and iterations of a step.
 *
 * Two things are to be kept apart. What a substep's equations ask for is approached by iterations; the equations themselves approach the motion of the matter as
 * substeps become shorter. A residual says something of the first only. docs/accuracy.html shows, for each effect, what settings cost and how far from references they
 * end, and how the estimate below compares with the true error of a substep.
 *
 * Thread contract: as in world.h.
 */
#ifndef LOAM_ACCURACY_H
#define LOAM_ACCURACY_H

#include <loam/base.h>
#include <loam/world.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What a step keeps to. */
enum {
  LOAM_ACCURACY_FIXED = 0, /* the iterations given, in the substeps given or chosen */
  LOAM_ACCURACY_TOLERANCE =
      1, /* iterations until the error of each substep's solution, as it is estimated, is within the tolerance */
  LOAM_ACCURACY_BUDGET = 2 /* substeps and iterations so that a step takes the time given, by what steps have cost so far */
};

/* Why a step had as many substeps as it had: what asked for most of them, see loam_statistics.substeps_reason. */
enum {
  LOAM_SUBSTEPS_GIVEN = 0,  /* loam_accuracy_def.substeps, or loam_world_def.substeps */
  LOAM_SUBSTEPS_LEAST = 1,  /* nothing: one is enough */
  LOAM_SUBSTEPS_WEIGHT = 2, /* what lies on other matter must not fall through its spacing */
  LOAM_SUBSTEPS_SPEED = 3,  /* the fastest matter, stream or collider's origin: neighbours are those of a substep's start */
  LOAM_SUBSTEPS_STIFFNESS = 4, /* elastic waves in the stiffest material, see loam_accuracy_def.courant */
  LOAM_SUBSTEPS_MOST = 5,      /* more were asked for, but most_substeps bounds them */
  LOAM_SUBSTEPS_BUDGET = 6,    /* as many as the budget pays for */
  LOAM_SUBSTEPS_CLOTH = 7      /* cloth: few substeps leave soft sheets far too long */
};

typedef struct loam_accuracy_def {
  uint32_t struct_size; /* sizeof(loam_accuracy_def) of the header that the host was compiled with */
  uint32_t mode;        /* LOAM_ACCURACY_*; default FIXED */

  /* Substeps of a step: 1 to 10000, default 16. 0: chosen anew at the beginning of each step, the least number in which
   *   an elastic wave crosses at most `courant` kernel radii,   matter goes half a kernel radius at most (less where courant is under 3: courant / 6), and
   *   what falls from rest at most half of one,   and, where there is cloth, courant / 1440 s at most go by
   * all within a substep, but no more than most_substeps. With BUDGET it has to be 0. */
  uint32_t substeps;

  /* Iterations of a substep. FIXED: so many; 1 to 1000, default 5. TOLERANCE: at most so many; at least 3. BUDGET: so many where the budget pays for the substeps
   * that stability needs; fewer (2 at least) where it does not, and half as many or more where whole substeps leave time over. */
  uint32_t iterations;

  uint32_t most_substeps; /* that are chosen: 1 to 10000; default 256 */
  float courant;          /* 0.01 to 100; default 3 */

  /* TOLERANCE: the error of the solution of a substep: how far the velocity changes that the constraints give (of stress, pressure, contact, cloth) are from those that
   * ever more iterations would give, as a share of them (in the norm of kinetic energy). It is estimated from what the last two iterations changed, and costs a
   * few per cent of the time and 32 bytes a particle. In the swinging beams that it was held against exact solutions of, it was within a factor of two with
   * Gauss-Seidel, where waves cross less than about five kernel radii a substep, and within six with Jacobi. Where substeps are so short that constraints change
   * velocities by less than about a ten-thousandth, rounding is an error of its own. Iterations converge the faster the shorter substeps are: a courant of 1 or less
   * makes a tolerance cheap. LOAM_LEAST_TOLERANCE to 0.5; 0 with other modes. */
  float tolerance;

  /* BUDGET: seconds of wall time for a step: over 0, at most 10; 0 with other modes. It is met on average: what a step takes too much, the next ones take less.
   * What it does not pay for is done all the same where stability needs it, see loam_world_use_accuracy. Steps are no longer the same for the same inputs, for
   * time is not; but what was chosen can be read (loam_statistics.substeps and iterations) and, given to a world as FIXED, makes the same bits. */
  float budget;
} loam_accuracy_def;

/* The least tolerance that can be asked for: single precision reaches it where constraints change velocities noticeably. */
#define LOAM_LEAST_TOLERANCE 1e-4f

/* Writes FIXED with the defaults above. Errors: INVALID_ARGUMENT for null or an unknown size. */
LOAM_API loam_status loam_accuracy_def_default(loam_accuracy_def *def, size_t size);

/* Settings by name. All of them choose substeps by what moves and how stiff it is, so they fit any scene; docs/accuracy.html shows what they cost and buy. */
enum {
  LOAM_ACCURACY_PRESET_FAST = 0, /* for effects in the background: the coarsest that stays stable; stiff bodies act softer */
  LOAM_ACCURACY_PRESET_BALANCED = 1, /* for games */
  LOAM_ACCURACY_PRESET_ACCURATE = 2, /* where forces, deflections and run-outs count */
  LOAM_ACCURACY_PRESET_REFERENCE = 3 /* to compare with; no real time */
};
/* Errors: INVALID_ARGUMENT for null, an unknown size or preset. */
LOAM_API loam_status loam_accuracy_def_preset(uint32_t preset, loam_accuracy_def *def, size_t size);

/* From the next step on. loam_world_set_accuracy is the same with FIXED, substeps and iterations.
 * With BUDGET, a step whose budget does not pay for what stability needs (that no matter is faster than r a substep, two iterations) is done with that, and
 * answers LOAM_ERROR_BUDGET; loam_statistics.least_budget is what would have paid for it.
 * Errors: INVALID_ARGUMENT for a value out of range, and for two that contradict each other: a tolerance or a budget with another mode, substeps with BUDGET. */
LOAM_API loam_status loam_world_use_accuracy(loam_world *world, const loam_accuracy_def *def);

/* What is in use. Errors: INVALID_ARGUMENT for null or an unknown size. */
LOAM_API loam_status loam_world_get_accuracy(const loam_world *world, loam_accuracy_def *def, size_t size);

#ifdef __cplusplus
}
#endif

#endif
