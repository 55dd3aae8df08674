#include "pincer/engine/solve/linear.h"

#include <cmath>
#include <type_traits>
#include <utility>

#include "pincer/contact/functions/invariants.h"

namespace pincer::engine {
namespace {

constexpr int kUsual = 6;

int pivotRow(const double* column, int k, int n) {
  int best = k;
  for (int i = k + 1; i < n; ++i)
    if (std::abs(column[i]) > std::abs(column[best])) best = i;
  return best;
}

// y -= a x over rows [from, to)
void subtractScaled(double* y, double a, const double* x, int from, int to) {
  for (int i = from; i < to; ++i) y[i] -= a * x[i];
}

// y -= L's columns [from, from + count) times y's own numbers there, over the rows below: number by number in the order
// of the columns.
constexpr int kColumnsAtOnce = 4;  // at once: each number of y is read and written once for so many
void subtractColumns(double* y, const double* L, int n, int from) {
  const double *const a = L + from * n, *const b = a + n, *const c = b + n, *const d = c + n;
  double* const u = y + from;
  u[1] -= u[0] * a[from + 1];
  u[2] = (u[2] - u[0] * a[from + 2]) - u[1] * b[from + 2];
  u[3] = ((u[3] - u[0] * a[from + 3]) - u[1] * b[from + 3]) - u[2] * c[from + 3];
  const double u0 = u[0], u1 = u[1], u2 = u[2], u3 = u[3];
  for (int i = from + kColumnsAtOnce; i < n; ++i) y[i] = (((y[i] - u0 * a[i]) - u1 * b[i]) - u2 * c[i]) - u3 * d[i];
}

// In line for the six freedoms of a body, the size that nearly all have.
template <class Size>
[[gnu::always_inline]] inline bool factorise(double* A, Size n) {
  for (int k = 0; k < n; ++k) {
    double* const column = A + k * n;
    const double pivot = column[k];
    if (!(pivot > 0) || !std::isfinite(pivot)) return false;
    const double inverse = 1 / pivot;
    for (int j = k + 1; j < n; ++j) subtractScaled(A + j * n, column[j] * inverse, column, j, n);
    for (int i = k + 1; i < n; ++i) column[i] *= inverse;
  }
  return true;
}

template <class Size>
[[gnu::always_inline]] inline void solve(const double* LDLT, Size n, double* b) {
  for (int k = 0; k < n; ++k) {
    subtractScaled(b, b[k], LDLT + k * n, k + 1, n);
    b[k] /= LDLT[k + k * n];
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int i = k + 1; i < n; ++i) b[k] -= LDLT[i + k * n] * b[i];
  }
}

}  // namespace

// Column after column, each by all before it at once.
bool factoriseLu(double* A, int n, int* pivots) {
  for (int j = 0; j < n; ++j) {
    double* const column = A + j * n;
    for (int k = 0; k < j; ++k) std::swap(column[k], column[pivots[k]]);
    int k = 0;
    for (; k + kColumnsAtOnce <= j; k += kColumnsAtOnce) subtractColumns(column, A, n, k);
    for (; k < j; ++k) subtractScaled(column, column[k], A + k * n, k + 1, n);
    pivots[j] = pivotRow(column, j, n);
    for (int i = 0; i <= j && pivots[j] != j; ++i) std::swap(A[j + i * n], A[pivots[j] + i * n]);
    const double pivot = column[j];
    if (!(std::abs(pivot) > 0) || !std::isfinite(pivot)) return false;
    const double inverse = 1 / pivot;
    for (int i = j + 1; i < n; ++i) column[i] *= inverse;
  }
  return true;
}

void solveLu(const double* LU, int n, const int* pivots, double* b) {
  for (int k = 0; k < n; ++k) {
    PINCER_ASSERT(k <= pivots[k] && pivots[k] < n);
    std::swap(b[k], b[pivots[k]]);
  }
  for (int k = 0; k < n; ++k) subtractScaled(b, b[k], LU + k * n, k + 1, n);
  for (int k = n - 1; k >= 0; --k) {
    b[k] /= LU[k + k * n];
    subtractScaled(b, b[k], LU + k * n, 0, k);
  }
}

bool factoriseLdlt(double* A, int n) {
  return n == kUsual ? factorise(A, std::integral_constant<int, kUsual>()) : factorise(A, n);
}

void solveLdlt(const double* LDLT, int n, double* b) {
  n == kUsual ? solve(LDLT, std::integral_constant<int, kUsual>(), b) : solve(LDLT, n, b);
}

}  // namespace pincer::engine
