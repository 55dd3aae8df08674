// counterbalance: in which order whom is shown what.
//
// Latin square balanced for first-order carry-over: n conditions, each once per row and equally often in each place,
// and each directly after each other one equally often. Row k is row 0 plus k, modulo n, and row 0 is
//
//   0, 1, n-1, 2, n-2, ...
//
// n rows suffice for even n; for odd n the mirrored rows follow (2 n rows). Participant p takes row p modulo the number
// of rows. Source: E. J. Williams, "Experimental designs balanced for the estimation of residual effects of
// treatments", Aust. J. Sci. Res. A 2(2), 1949, 149-168.
#pragma once
#include <utility>
#include <vector>

#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {

using Order = std::vector<int>;  // of 0 .. n-1

// n >= 1.
std::vector<Order> carryOverSquare(int n);

// The cyclic reduced Latin square, n >= 1: row k is k, k+1, ... modulo n, so that first row
// and first column are in the natural order.
std::vector<Order> reducedLatinSquare(int n);

// Each value once, every order equally likely (R. Durstenfeld, Comm. ACM 7(7), 1964, algorithm 235).
template <class T>
void shuffle(std::vector<T>& values, Random& random) {
  for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[random.below(i)]);
}

}  // namespace pincer::tasks
