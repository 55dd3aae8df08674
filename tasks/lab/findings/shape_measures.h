// shape_measures: the measures of shape identification (claim_measures.h), as the published tests take them.
//
//   right                       per person, of all trials [%];  right:SOLID  of one solid's
//   right:force, right:cld      per cell person x solid x shading [%];  right:facets, right:shaded
//                                                                       person x solid x display
//   cells:sphere, cells:rest    per cell person x solid x shading [%]
//   times:force, times:cld, times:sphere, times:rest     of every trial answered rightly, from the
//                                                        first touch on [s];  time:SOLID  per person
//   contact:facets, contact:shaded                       share of that time in contact, of every such trial [-]
//   A>B                         per person, of A's presentations those named B [%], B
//                               "others": any wrong name;  A>B:facets, A>B:shaded
//   confusions:first, confusions:next                    of the study: the first of the published
//                                                        ten, the largest of the others [%]
//   unevenness:force, unevenness:cld                     of the study: standard deviation of the ten [%]
#pragma once
#include <vector>

#include "pincer/tasks/lab/findings/claim_measures.h"

namespace pincer::tasks {

void addShapeMeasures(const std::vector<ResponseRecord>& responses, StudyMeasures& measures);

}  // namespace pincer::tasks
