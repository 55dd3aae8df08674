// exponential: e^x of a number of 106 bits, for the functions that need it.
#pragma once
#include "pincer/contact/functions/double_double.h"

namespace pincer::math {

// e^(x.hi + x.lo) for any x.hi that is a number.
double exponential(const DoubleDouble& x);

}  // namespace pincer::math
