/* Materials by name, and from what can be seen of them to the numbers that a law wants.
 *
 * The functions below are formulas; they need no world. Results are what a loam_material_def takes; each function says how it comes about.
 * `density` is in kg/m^3, `gravity` in m/s^2 (its size: 9.81 on earth). Every argument must be finite and over 0 unless another range is given;
 * errors are INVALID_ARGUMENT, name argument, value and range, and write nothing.
 *
 * Any thread, any time.
 */
#ifndef LOAM_MATERIAL_DESIGN_H
#define LOAM_MATERIAL_DESIGN_H

#include <loam/material.h>

#ifdef __cplusplus
extern "C" {
#endif

/* -------------------------------------------------------------------------------------------------- presets --- */

/* Fills a definition, its name included, with a material known by name: "dry sand", "wet sand", "packed snow", "powder snow", "plasticine",
 * "aluminium", "candy", "shaving foam", "paint", "toothpaste", "dough", "mud", "water". SI values of the real matter where they are known, but for
 * Young's moduli, which are such as games can afford; aluminium is scaled as a whole, stiffness and strength, to a ten-thousandth.
 * Errors: INVALID_ARGUMENT for null, an unknown size, or a name that is none of these; the text then lists them. */
LOAM_API loam_status loam_material_def_preset(const char *name, loam_material_def *def, size_t size);

/* The names of the presets, from index 0 on; null past the last. */
LOAM_API const char *loam_material_preset_name(uint32_t index);

/* ------------------------------------------------------------------------------------------- how steep it stays --- */

/* friction_angle, in radians, of matter whose slopes start to flow at this angle (radians, 0 to 1.04). A long slope shears in plane strain:
 * tan(angle) = 2 sqrt(3) sin(phi) / (3 - sin(phi)) for the triaxial friction angle phi that the Drucker-Prager cone is drawn through.
 * 30 degrees of slope ask for phi = 25.4. */
LOAM_API loam_status loam_design_friction_angle(float angle_of_repose, float *friction_angle);

/* ------------------------------------------------------------------------------------------------ how stiff --- */

/* youngs_modulus of matter of which a free-standing column of this height, in metres, becomes shorter by `sinking` metres (less than a tenth of
 * the height) under its own weight: E = density gravity height^2 / (2 sinking). */
LOAM_API loam_status loam_design_youngs_modulus(float density, float gravity, float height, float sinking,
                                                float *youngs_modulus);

/* ------------------------------------------------------------------------------- when it starts to flow, and how fast --- */

/* yield_stress, uniaxial, of matter of which a column of this height, in metres, just stands: density gravity height, at its foot. */
LOAM_API loam_status loam_design_yield_stress(float density, float gravity, float height, float *yield_stress);

/* shear_yield_stress of the same: the uniaxial one over sqrt(3). */
LOAM_API loam_status loam_design_shear_yield_stress(float density, float gravity, float height, float *shear_yield_stress);

/* shear_yield_stress of a fluid of which this volume, in m^3, poured on a level floor spreads to a round puddle of this radius, in metres, much
 * wider than high: 225 density gravity volume^2 / (128 pi^2 radius^5) (Roussel and Coussot 2005). */
LOAM_API loam_status loam_design_puddle_yield_stress(float density, float gravity, float volume, float radius,
                                                     float *shear_yield_stress);

/* consistency of a fluid of which a film of this thickness, in metres, runs down a plane (slope in radians, over 0, to pi / 2: a wall) with this speed
 * at its surface, in m/s. It shears up to the depth hs = thickness - shear_yield_stress / (density gravity sin(slope)) below the plug at its surface:
 *   speed = n / (n + 1) (density gravity sin(slope) / consistency)^(1/n) hs^((n+1)/n),   n = flow_exponent, 0.1 to 10.
 * shear_yield_stress may be 0. A film that would not flow at all is an error that names the thickness needed. */
LOAM_API loam_status loam_design_consistency(float density, float gravity, float shear_yield_stress, float flow_exponent,
                                             float thickness, float slope, float speed, float *consistency);

/* ---------------------------------------------------------------------------------------------- how brittle --- */

/* The four numbers of LOAM_LAW_NACC, into a definition whose law is that and whose moduli are set: matter that gives way at these pressures, in Pa, from
 * all sides and these tensions from all sides, with this friction angle (radians, over 0, to 1.5), and that has lost its hold when its volume has
 * plastically grown by the share `opening` (0.0001 to 0.5): small for candy, that breaks at once, large for clay, that tears.
 *   hardening_factor = asinh(compressive / K - 1e-5) / log(1 + opening),  consolidation = -log(1 + opening),
 *   cohesion_ratio = tensile / compressive, tensile may be 0,             critical_state_slope = 6 sin(phi) / (3 - sin(phi)).
 * `compressive` is at most 3.6 times the bulk modulus. */
LOAM_API loam_status loam_design_strengths(loam_material_def *def, float compressive, float tensile, float friction_angle,
                                           float opening);

#ifdef __cplusplus
}
#endif

#endif
