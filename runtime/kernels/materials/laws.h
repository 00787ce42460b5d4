// The list of laws: the one place to name a new one. Kernels for all of them are instantiated from this list.
#pragma once

#include "kernels/materials/drucker_prager.h"
#include "kernels/materials/elastic.h"
#include "kernels/materials/fluid.h"
#include "kernels/materials/herschel_bulkley.h"
#include "kernels/materials/nacc.h"
#include "kernels/materials/stomakhin_snow.h"
#include "kernels/materials/von_mises.h"

namespace loam {

template <class... Types> struct TypeList {};

using Laws = TypeList<Elastic, VonMises, DruckerPrager, VonMisesHardening, Nacc, HerschelBulkley, StomakhinSnow>;

} // namespace loam
