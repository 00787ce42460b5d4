/* Loam: sand, snow, clay and other inelastic matter for games, in one particle solver.
 *
 * The whole public interface. The order of the parts is the order in which a host meets them:
 *
 *   base.h       status codes, ids, hooks (allocator, job system, log), version
 *   world.h      create a world, step it, ask what it cost
 *   accuracy.h   what its steps keep to: substeps and iterations, a tolerance, or a budget of time
 *   material.h   what matter is made of
 *   material_design.h   materials by name, and by what can be seen of them
 *   collider.h   what matter runs into: planes, simple solids, distance grids, triangle meshes
 *   cloth.h      sheets that hang, drape and blow in the wind
 *   emitter.h    matter that streams in
 *   killer.h     volumes and ages that take it out
 *   field.h      winds, attractors, blasts
 *   particles.h  fill volumes with particles, read the particles back
 *   snapshot.h   save the state of a world, and go back to it
 *
 * Units are SI throughout: metres, kilograms, seconds, pascals, radians. Coordinates are right-handed; which axis
 * is up is the host's choice, made through gravity. See samples/hello_sand.c for a complete host in under 100 lines.
 */
#ifndef LOAM_LOAM_H
#define LOAM_LOAM_H

#include <loam/accuracy.h>
#include <loam/base.h>
#include <loam/cloth.h>
#include <loam/collider.h>
#include <loam/emitter.h>
#include <loam/field.h>
#include <loam/killer.h>
#include <loam/material.h>
#include <loam/material_design.h>
#include <loam/particles.h>
#include <loam/snapshot.h>
#include <loam/world.h>

#endif
