// The list of laws: the one place to name a new one. Kernels for all of them are instantiated from this list.
#pragma once

#include "kernels/materials/drucker_prager.h"
#include "kernels/materials/elastic.h"
#include "kernels/materials/fluid.h"
#include "kernels/materials/herschel_bulkley.h"
#include "kernels/materials/nacc.h"
#include "kernels/materials/stomakhin_snow.h"
#include "kernels/materials/von_mises.h"
#include "math/type_list.h"

namespace loam {

// A build may leave laws out (LOAM_LAWS in CMake); elastic matter is always there.
template <class Law> struct IsBuilt { static constexpr bool value = true; };
#ifdef LOAM_WITHOUT_VON_MISES
template <> struct IsBuilt<VonMises> { static constexpr bool value = false; };
template <> struct IsBuilt<VonMisesHardening> { static constexpr bool value = false; };
#endif
#ifdef LOAM_WITHOUT_DRUCKER_PRAGER
template <> struct IsBuilt<DruckerPrager> { static constexpr bool value = false; };
#endif
#ifdef LOAM_WITHOUT_NACC
template <> struct IsBuilt<Nacc> { static constexpr bool value = false; };
#endif
#ifdef LOAM_WITHOUT_HERSCHEL_BULKLEY
template <> struct IsBuilt<HerschelBulkley> { static constexpr bool value = false; };
#endif
#ifdef LOAM_WITHOUT_STOMAKHIN_SNOW
template <> struct IsBuilt<StomakhinSnow> { static constexpr bool value = false; };
#endif

#ifdef LOAM_WITHOUT_FLUID
template <> struct IsBuilt<Fluid> { static constexpr bool value = false; };
#endif
constexpr bool fluid_is_built = IsBuilt<Fluid>::value;

template <class Law, bool Built = IsBuilt<Law>::value> struct IfBuilt { using Type = TypeList<Law>; };
template <class Law> struct IfBuilt<Law, false> { using Type = TypeList<>; };
template <class... AllLaws> using Built = typename Concatenate<typename IfBuilt<AllLaws>::Type...>::Type;

using Laws = Built<Elastic, VonMises, DruckerPrager, VonMisesHardening, Nacc, HerschelBulkley, StomakhinSnow>;

} // namespace loam
