#include "pincer/engine/solve/linear.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/solve/wide.h"

namespace pincer::engine {
namespace {

constexpr int kUsual = 6;
constexpr int kFour = 4;  // columns at a time

// The first of the largest numbers from row k on.
int pivotRow(const double* column, int k, int n) {
  double best = std::abs(column[k]);
  int row = k;
  for (int i = k + 1; i < n; ++i) {
    const double size = std::abs(column[i]);
    row = size > best ? i : row;
    best = size > best ? size : best;
  }
  return row;
}

// y -= a x over rows [from, to)
template <class Lanes>
[[gnu::always_inline]] inline void subtractScaled(double* y, double a, const double* x, int from, int to) {
  int i = from;
  for (; i < to && i % Lanes::count != 0; ++i) y[i] -= a * x[i];  // ends with `to` where that is such a multiple
  for (; i + Lanes::count <= to; i += Lanes::count) Lanes::at(y + i) -= a * Lanes::at(x + i);
  for (; i < to; ++i) y[i] -= a * x[i];
}

// Four columns of L from `from` on.
struct FourColumns {
  const double *a, *b, *c, *d;
  FourColumns(const double* A, int n, int from) : a(A + from * n), b(a + n), c(b + n), d(c + n) {}

  // y -= the columns times y's own numbers there, over the rows below: number by number in the order of the columns, of
  // which each sees all four at once.
  template <class Lanes>
  [[gnu::always_inline]] void subtractFrom(double* y, int n, int from) const {
    const double u0 = y[from], u1 = y[from + 1] - u0 * a[from + 1],
                 u2 = (y[from + 2] - u0 * a[from + 2]) - u1 * b[from + 2],
                 u3 = ((y[from + 3] - u0 * a[from + 3]) - u1 * b[from + 3]) - u2 * c[from + 3];
    y[from + 1] = u1;
    y[from + 2] = u2;
    y[from + 3] = u3;
    int i = from + kFour;
    for (; i + Lanes::count <= n; i += Lanes::count)
      Lanes::at(y + i) =
          (((Lanes::at(y + i) - u0 * Lanes::at(a + i)) - u1 * Lanes::at(b + i)) - u2 * Lanes::at(c + i)) -
          u3 * Lanes::at(d + i);
    for (; i < n; ++i) y[i] = (((y[i] - u0 * a[i]) - u1 * b[i]) - u2 * c[i]) - u3 * d[i];
  }
};

// In line for the six freedoms of a body, the size that nearly all have.
template <class Size>
[[gnu::always_inline]] inline bool factorise(double* A, Size n) {
  for (int k = 0; k < n; ++k) {
    double* const column = A + k * n;
    const double pivot = column[k];
    if (!(pivot > 0) || !std::isfinite(pivot)) return false;
    const double inverse = 1 / pivot;
    for (int j = k + 1; j < n; ++j) subtractScaled<NarrowLanes>(A + j * n, column[j] * inverse, column, j, n);
    for (int i = k + 1; i < n; ++i) column[i] *= inverse;
  }
  return true;
}

template <class Size>
[[gnu::always_inline]] inline void solve(const double* LDLT, Size n, double* b) {
  for (int k = 0; k < n; ++k) {
    subtractScaled<NarrowLanes>(b, b[k], LDLT + k * n, k + 1, n);
    b[k] /= LDLT[k + k * n];
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int i = k + 1; i < n; ++i) b[k] -= LDLT[i + k * n] * b[i];
  }
}

// Columns [from, to) by themselves, their rows above `from` done. False if a pivot is 0 or not finite.
template <class Lanes>
[[gnu::always_inline]] inline bool factorisePanel(double* A, int n, int from, int to, int* pivots) {
  for (int j = from; j < to; ++j) {
    double* const column = A + j * n;
    for (int k = from; k < j; ++k) std::swap(column[k], column[pivots[k]]);
    for (int k = from; k < j; ++k) subtractScaled<Lanes>(column, column[k], A + k * n, k + 1, n);
    pivots[j] = pivotRow(column, j, n);
    for (int i = 0; i <= j && pivots[j] != j; ++i) std::swap(A[j + i * n], A[pivots[j] + i * n]);
    const double pivot = column[j];
    if (!(std::abs(pivot) > 0) || !std::isfinite(pivot)) return false;
    const double inverse = 1 / pivot;
    for (int i = j + 1; i < n; ++i) column[i] *= inverse;
  }
  return true;
}

// Four columns at a time, and then all to the right of them, which don't wait for each other.
template <class Lanes>
[[gnu::always_inline]] inline bool factoriseColumns(double* A, int n, int* pivots) {
  int from = 0;
  for (; from + kFour < n; from += kFour) {
    if (!factorisePanel<Lanes>(A, n, from, from + kFour, pivots)) return false;
    const FourColumns panel(A, n, from);
    const int p0 = pivots[from], p1 = pivots[from + 1], p2 = pivots[from + 2], p3 = pivots[from + 3];
    for (double* column = A + (from + kFour) * n; column < A + n * n; column += n) {
      std::swap(column[from], column[p0]);
      std::swap(column[from + 1], column[p1]);
      std::swap(column[from + 2], column[p2]);
      std::swap(column[from + 3], column[p3]);
      panel.subtractFrom<Lanes>(column, n, from);
    }
  }
  return factorisePanel<Lanes>(A, n, from, n, pivots);
}

template <class Lanes>
[[gnu::always_inline]] inline void solveColumns(const double* LU, int n, const int* pivots, double* b) {
  for (int k = 0; k < n; ++k) {
    PINCER_ASSERT(k <= pivots[k] && pivots[k] < n);
    std::swap(b[k], b[pivots[k]]);
  }
  int from = 0;
  for (; from + kFour <= n; from += kFour) FourColumns(LU, n, from).subtractFrom<Lanes>(b, n, from);
  for (int k = from; k < n; ++k) subtractScaled<Lanes>(b, b[k], LU + k * n, k + 1, n);
  for (int k = n - 1; k >= 0; --k) {
    b[k] /= LU[k + k * n];
    subtractScaled<Lanes>(b, b[k], LU + k * n, 0, k);
  }
}

}  // namespace

bool factoriseLu(double* A, int n, int* pivots) {
  return wide([=](auto lanes)
                  __attribute__((always_inline)) { return factoriseColumns<decltype(lanes)>(A, n, pivots); });
}

void solveLu(const double* LU, int n, const int* pivots, double* b) {
  wide([=](auto lanes) __attribute__((always_inline)) { solveColumns<decltype(lanes)>(LU, n, pivots, b); });
}

bool factoriseLdlt(double* A, int n) {
  return n == kUsual ? factorise(A, std::integral_constant<int, kUsual>()) : factorise(A, n);
}

void solveLdlt(const double* LDLT, int n, double* b) {
  n == kUsual ? solve(LDLT, std::integral_constant<int, kUsual>(), b) : solve(LDLT, n, b);
}

}  // namespace pincer::engine
