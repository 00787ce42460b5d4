// The list of all stages over neighbours, made from the list of laws. Executors instantiate their launches from it.
#pragma once

#include "kernels/cloth/bending.h"
#include "kernels/cloth/membrane.h"
#include "kernels/cloth/threads.h"
#include "kernels/fluid/prepare_fluid.h"
#include "kernels/fluid/solve_fluid_at_once.h"
#include "kernels/fluid/surface_tension.h"
#include "kernels/fluid/viscosity.h"
#include "kernels/fluid/vorticity_confinement.h"
#include "kernels/inelastic/measure_constraint.h"
#include "kernels/inelastic/projected_tensor.h"
#include "kernels/inelastic/scalar_multiplier.h"
#include "kernels/inelastic/solve_inelastic.h"
#include "kernels/inelastic/solve_jacobi.h"
#include "kernels/inelastic/update_strain.h"
#include "kernels/inelastic/warm_start.h"
#include "kernels/integration/position_correction.h"
#include "kernels/integration/sleep.h"
#include "kernels/integration/velocity_smoothing.h"
#include "kernels/materials/laws.h"
#include "kernels/neighbours/compute_gradients.h"
#include "kernels/neighbours/search_neighbours.h"

namespace loam {

template <class Law, class Multiplier>
using StagesOfForm =
    TypeList<SolveInelastic<Law, Multiplier>, JacobiImpulse<Law, Multiplier>, MeasureConstraint<Law, Multiplier>>;

// The tensor form for a law's matter.
template <class Law> using TensorOf = ProjectedTensor<Law::resists_zero_energy_modes>;

template <class Law, bool Resists = Law::resists_zero_energy_modes> struct StagesOfLaw {
  using Type = typename Concatenate<StagesOfForm<Law, ScalarMultiplier>, StagesOfForm<Law, TensorOf<Law>>,
                                    TypeList<StartInelastic<Law, TensorOf<Law>>, UpdateStrain<Law, false>>>::Type;
};
template <class Law> struct StagesOfLaw<Law, true> {
  using Type = typename Concatenate<typename StagesOfLaw<Law, false>::Type, TypeList<UpdateStrain<Law, true>>>::Type;
};

template <class List> struct StagesOfLaws;
template <class... L> struct StagesOfLaws<TypeList<L...>> {
  using Type = typename Concatenate<typename StagesOfLaw<L>::Type...>::Type;
};

#ifdef LOAM_WITHOUT_FLUID
using FluidStages = TypeList<>;
#else
using FluidStages =
    TypeList<PrepareFluid, StartFluid<FluidMotion::velocities>, SolveFluid<FluidMotion::velocities>,
             StartFluid<FluidMotion::displacements>, SolveFluid<FluidMotion::displacements>, FluidImpulse<FluidTurn::start>,
             FluidImpulse<FluidTurn::velocities>, FluidImpulse<FluidTurn::start_displacements>,
             FluidImpulse<FluidTurn::displacements>, KeepMultipliers, MeasureViscosity, DiffuseVelocities, FindSurface,
             PullSurface, MarkCompression, MeasureVorticity, WeighVorticity, ConfineVorticity>;
#endif

using TeamStages = Concatenate<
    TypeList<ComputeGradients<false>, ComputeGradients<true>, CorrectPositionsInTurn, CorrectPositionsAtOnce,
             SmoothVelocities, LookAround, JacobiApply<false>, JacobiApply<true>>,
    StagesOfForm<Elastic, ProjectedTensor<false>>, // semi-implicit plasticity of matter that resists no zero-energy modes
    StagesOfLaws<Laws>::Type, FluidStages>::Type;
using CandidateStages = TypeList<CountNeighbours, FillNeighbours>;
// Over a cloth's constraints.
#ifdef LOAM_WITHOUT_CLOTH
using ConstraintStages = TypeList<>;
#else
using ConstraintStages = TypeList<PrepareMembrane, SolveMembrane, PrepareHinges, SolveHinges, PrepareThreads, SolveThreads>;
#endif

} // namespace loam
