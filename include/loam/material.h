/* Materials: what matter is made of.
 *
 * All laws but FLUID share the Saint Venant-Kirchhoff energy in Hencky (logarithmic) strain e: psi = mu |e|^2 + lambda/2 tr(e)^2, with the
 * Lame parameters mu and lambda from Young's modulus and Poisson's ratio. They differ in their yield surface.
 *
 * Thread contract: as for the world; during an asynchronous step every function here that takes a world answers LOAM_ERROR_BUSY.
 */
#ifndef LOAM_MATERIAL_H
#define LOAM_MATERIAL_H

#include <loam/base.h>
#include <loam/world.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  LOAM_LAW_ELASTIC = 0,        /* never yields: rubber, jelly */
  LOAM_LAW_VON_MISES = 1,      /* yields at a shear stress that pressure does not change: metal, plasticine */
  LOAM_LAW_DRUCKER_PRAGER = 2, /* yields at a shear stress that grows with pressure: sand, gravel, soil */
  LOAM_LAW_NACC =
      3, /* non-associated Cam-Clay: hardens when compacted, softens and breaks when it opens: snow, clay, candy */
  LOAM_LAW_HERSCHEL_BULKLEY = 4, /* a fluid that stands until a shear stress is reached: foam, paint, mud, dough */
  LOAM_LAW_STOMAKHIN_SNOW = 5,   /* yields at a compression and at a stretch, and hardens or softens with its volume: snow */
  LOAM_LAW_FLUID = 6             /* resists compression alone, and comes apart freely: water */
};

typedef struct loam_material_def {
  uint32_t struct_size;
  uint32_t law;         /* LOAM_LAW_*. Each reads its own fields below and ignores the others'. */
  float density;        /* kg/m^3 of the undeformed matter; 1e-3 to 1e6 */
  float youngs_modulus; /* Pa; 1 to 1e13 */
  float poissons_ratio; /* 0 to 0.49 */

  /* VON_MISES: the uniaxial yield stress in Pa, over 0: a bar under tension flows at it. The Frobenius norm of the deviatoric
   * Kirchhoff stress is bounded by sqrt(2/3) of it. See also hardening_modulus. */
  float yield_stress;

  /* DRUCKER_PRAGER: the angle of internal friction in radians, 0 to 1.5 (sand about 0.5 to 0.7), as in triaxial compression, and
   * the cohesion in Pa, 0 or more (Mohr-Coulomb's c: the shear stress borne without pressure). The yield cone is that of Klar et
   * al. 2016 with the volume correction of Tampubolon et al. 2017. */
  float friction_angle;
  float cohesion;

  char name[32]; /* appears in stage names and messages; need not be unique; always terminated */

  /* VON_MISES: by how many Pa the yield stress grows per unit of equivalent plastic strain, 0 (no hardening) to 1e13: under tension a bar
   * flows at yield_stress + hardening_modulus x (its plastic logarithmic strain so far). */
  float hardening_modulus;

  /* NACC, after Wolper et al. 2019: with the pressure p and q = sqrt(3/2) |dev stress| the stress stays within the ellipse
   *   (1 + 2 cohesion_ratio) q^2 + critical_state_slope^2 (p + cohesion_ratio p0)(p - p0) <= 0,
   *   p0 = K (1e-5 + sinh(hardening_factor max(-a, 0))),  K the bulk modulus.
   * a is the logarithm of the plastic volume change: compaction lowers it and hardens, opening raises it and softens, and from a = 0 on
   * the matter bears no tension. loam_design_strengths() finds these from strengths in Pa. */
  float consolidation;    /* a of new particles: -2 / hardening_factor to 1; below 0 for matter that holds together */
  float cohesion_ratio;   /* beta: tensile over compressive strength, 0 to 10 */
  float hardening_factor; /* xi: 0.1 to 1000. Also STOMAKHIN_SNOW's, there 0 to 1000 */
  float
      critical_state_slope; /* M: the greatest q over p; 0.01 to 10; 6 sin(phi) / (3 - sin(phi)) for a friction angle phi */
  uint32_t constant_hardness; /* 1: a never changes, the matter neither hardens nor breaks; 0 (the default) */

  /* HERSCHEL_BULKLEY, after Yue et al. 2015: in simple shear at the rate g, in 1/s, the shear stress is
   * shear_yield_stress + consistency g^flow_exponent; below shear_yield_stress the matter is elastic. The elastic moduli should be well over
   * the stresses that occur: a strain of stress / modulus is what the matter springs back by. */
  float shear_yield_stress; /* Pa; 0 to 1e13 */
  float consistency;        /* Pa s^flow_exponent; over 0, to 1e13 */
  float
      flow_exponent; /* 0.1 to 10: under 1 thins with the rate (paint), 1 is Bingham's fluid, over 1 thickens (starch in water) */

  /* STOMAKHIN_SNOW, after Stomakhin et al. 2013: principal stretches stay within [1 - critical_compression, 1 + critical_stretch], and both
   * moduli are multiplied by exp(hardening_factor (1 - J)) with J the plastic volume change; the exponent is held within [-3, 3]. */
  float critical_compression; /* 0 to 0.39; large: chunky and wet, small: powdery and dry */
  float critical_stretch;     /* 0 to 0.64 */

  /* FLUID ignores the moduli. It is position-based fluids (Macklin and Mueller 2013) with physical masses: a particle's density, summed over its neighbours with
   * the kernel, is kept from growing over `density`, by the pressure that this takes. Where it is over `density` already, as in matter that was
   * made too dense, particles part without taking up speed, half of the excess in a substep, and no more than 3 % of the volume in a substep or
   * 2000 % a second. Matter made twice too dense takes about 0.06 s.
   *
   * It is soft where few iterations are to carry much: at 5 of them, water n particles deep keeps its volume while n^2 gravity substep^2 / r stays
   * under 2; from about 3 on it packs, by a quarter at 4, and simmers.
   *
   * `density` is that of a cubic lattice of the constant r: a fill of any sampling has it on average, and comes to rest with it. Walls count as more fluid, so
   * that particles do not crowd along them. Particles of other materials count with their volume, and are pushed back with the opposite impulse.
   * A fluid stays out of the deformation of others, and how they meet cannot be chosen.
   *
   * The friction of a collider acts on fluids too; 0 lets them slip. */

  /* FLUID: dynamic viscosity in Pa s, 0 (none) to 1e9; water has 0.001, oil 0.1, syrup 3, honey 10. It damps all motion but rigid motion, with Monaghan's
   * pairwise form (2005), which keeps momentum and angular momentum. Between two fluids their harmonic mean acts, and other matter is dragged along as if
   * it were as viscous. Stable for any: no more is felt than a kinematic viscosity (viscosity over density) of 10 r^2 / substep. */
  float viscosity;

  /* FLUID: surface tension in N/m, 0 (none) to 1e9; water has 0.072, mercury 0.49. It acts where fluid ends in nothing, as a stress along the surface, and keeps
   * momentum; walls and other matter count as more fluid, so that drops meet a wall at a right angle. Drops of 4 to 6 r oscillate with the period of their
   * tension within 8 %. No more is felt than 0.1 density r^3 / substep^2, and what shows of 0.072 needs a kernel radius of millimetres. */
  float surface_tension;

  /* FLUID: the tension in Pa, 0 (none) to 1e9, with which it clings to every collider; added to what the collider's contact says, see `stick` in collider.h. */
  float adhesion;

  /* FLUID: vorticity confinement, 0 (none) to 1: of the energy that pressure, being solved for coarsely, takes from the motion, the share that eddies may get back.
   * They last longer for it: one of 16 r across that keeps 11 % of its energy over some two turns keeps 15 % with 1. The force is a curl of Steinhoff's second form
   * (harmonic means of the neighbourhood's vorticity; Steinhoff et al. 2005) with a strength of 4 r^2 |vorticity|; being a share, it means the same for every substep
   * and radius. It keeps momentum, but angular momentum only about. A fluid without pressure, as in free fall, feels nothing; one that was stirred comes to rest.
   * Acts within each material, on no other matter. */
  float vorticity_confinement;
} loam_material_def;

/* Defaults for a law: water for FLUID (1000 kg/m^3), dry sand (1600 kg/m^3, 1 MPa, 0.3, 30 degrees, no cohesion), plasticine for VON_MISES (1500 kg/m^3, 1 MPa, 0.3,
 * 5 kPa), soft rubber for ELASTIC (1000 kg/m^3, 100 kPa, 0.3), the presets "packed snow" for NACC and "shaving foam" for HERSCHEL_BULKLEY, the
 * paper's snow for STOMAKHIN_SNOW. More by name: loam_material_def_preset() in material_design.h. Young's moduli are those that games can afford: piles of matter do not look
 * different with a larger one.
 * Errors: INVALID_ARGUMENT for null, an unknown law, or an unknown size. */
LOAM_API loam_status loam_material_def_default(uint32_t law, loam_material_def *def, size_t size);

/* Errors: INVALID_ARGUMENT naming field, value and range; CAPACITY beyond 4096 materials in a world. */
LOAM_API loam_status loam_material_create(loam_world *world, const loam_material_def *def, loam_material_id *material);

/* Errors: INVALID_HANDLE; IN_USE while particles are made of it. */
LOAM_API loam_status loam_material_destroy(loam_world *world, loam_material_id material);

/* Changes a material from the next step on, for the particles that are made of it too.
 *
 * While there are such particles, their law and their density stay: each was made with its mass and with the law's memory of what it has been
 * through. `consolidation` is what new particles start with.
 * Errors: INVALID_ARGUMENT naming field, value and range; INVALID_HANDLE; IN_USE for another law or density, or while buffers are mapped. */
LOAM_API loam_status loam_material_set(loam_world *world, loam_material_id material, const loam_material_def *def);

/* Reads a material's definition back. `def->struct_size` is set by the caller. */
LOAM_API loam_status loam_material_get(const loam_world *world, loam_material_id material, loam_material_def *def);

/* ---------------------------------------------------------------------------------------- how materials meet --- */

enum {
  /* One continuum where they touch: they mix, and stick to each other as each sticks to itself. The default. */
  LOAM_MEETING_SHARED = 0,
  /* Bodies that stay apart: each takes its deformation from its own kind only, and their particles keep a distance of r, with Coulomb friction.
   * For sand on rubber, a snowball against a figure, a press on dough. */
  LOAM_MEETING_CONTACT = 1
};

/* How two materials of a world meet from the next step on, in either order of naming. `friction` is the coefficient of CONTACT, 0 to 100, and ignored otherwise. A
 * material always shares with itself, and a FLUID meets all others by its density, whatever is said here. Forgotten when either is destroyed.
 * Errors: INVALID_HANDLE; INVALID_ARGUMENT for the same material twice, an unknown meeting, a friction out of range; IN_USE while buffers are
 * mapped; OUT_OF_MEMORY. */
LOAM_API loam_status loam_material_set_meeting(loam_world *world, loam_material_id a, loam_material_id b, uint32_t meeting,
                                               float friction);

#ifdef __cplusplus
}
#endif

#endif
