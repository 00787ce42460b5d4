/* What the quick form of the study has to come to. */
#pragma once

#include "study.h"

namespace loam::accuracy {

/* Says on the standard error what lies outside of its band, and how many there were. Times are compared within the run only. */
int count_outside_bands(const Study &study);

} // namespace loam::accuracy
