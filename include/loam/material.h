/* Materials: what matter is made of.
 *
 * All laws share the Saint Venant-Kirchhoff energy in Hencky (logarithmic) strain e: psi = mu |e|^2 + lambda/2 tr(e)^2, with the
 * Lame parameters mu and lambda from Young's modulus and Poisson's ratio. They differ in their yield surface.
 *
 * Thread contract: as for the world.
 */
#ifndef LOAM_MATERIAL_H
#define LOAM_MATERIAL_H

#include <loam/base.h>
#include <loam/world.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  LOAM_LAW_ELASTIC = 0,       /* never yields: rubber, jelly */
  LOAM_LAW_VON_MISES = 1,     /* yields at a shear stress that pressure does not change: metal, plasticine */
  LOAM_LAW_DRUCKER_PRAGER = 2 /* yields at a shear stress that grows with pressure: sand, gravel, soil */
};

typedef struct loam_material_def {
  uint32_t struct_size;
  uint32_t law;         /* LOAM_LAW_* */
  float density;        /* kg/m^3 of the undeformed matter; 1e-3 to 1e6 */
  float youngs_modulus; /* Pa; 1 to 1e13 */
  float poissons_ratio; /* 0 to 0.49 */

  /* VON_MISES: the uniaxial yield stress in Pa, over 0: a bar under tension flows at it. The Frobenius norm of the deviatoric
   * Kirchhoff stress is bounded by sqrt(2/3) of it. Ignored by other laws. */
  float yield_stress;

  /* DRUCKER_PRAGER: the angle of internal friction in radians, 0 to 1.5 (sand about 0.5 to 0.7), as in triaxial compression, and
   * the cohesion in Pa, 0 or more (Mohr-Coulomb's c: the shear stress borne without pressure). The yield cone is that of Klar et
   * al. 2016 with the volume correction of Tampubolon et al. 2017. Ignored by other laws. */
  float friction_angle;
  float cohesion;

  char name[32]; /* appears in stage names and messages; need not be unique; always terminated */
} loam_material_def;

/* Defaults for a law: dry sand (1600 kg/m^3, 1 MPa, 0.3, 30 degrees, no cohesion), plasticine for VON_MISES (1500 kg/m^3, 1 MPa, 0.3,
 * 5 kPa), soft rubber for ELASTIC (1000 kg/m^3, 100 kPa, 0.3). Young's moduli are those that games can afford: piles of matter do not look
 * different with a larger one.
 * Errors: INVALID_ARGUMENT for null, an unknown law, or an unknown size. */
LOAM_API loam_status loam_material_def_default(uint32_t law, loam_material_def *def, size_t size);

/* Errors: INVALID_ARGUMENT naming field, value and range; CAPACITY beyond 4096 materials in a world. */
LOAM_API loam_status loam_material_create(loam_world *world, const loam_material_def *def, loam_material_id *material);

/* Errors: INVALID_HANDLE; IN_USE while particles are made of it. */
LOAM_API loam_status loam_material_destroy(loam_world *world, loam_material_id material);

/* Reads a material's definition back. `def->struct_size` is set by the caller. */
LOAM_API loam_status loam_material_get(const loam_world *world, loam_material_id material, loam_material_def *def);

#ifdef __cplusplus
}
#endif

#endif
