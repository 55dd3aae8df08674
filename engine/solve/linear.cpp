#include "engine/solve/linear.h"

#include <cmath>
#include <utility>

namespace pincer::engine {
namespace {

int pivotRow(const double* column, int k, int n) {
  int best = k;
  for (int i = k + 1; i < n; ++i)
    if (std::abs(column[i]) > std::abs(column[best])) best = i;
  return best;
}

void swapRows(double* A, int n, double* b, int i, int k) {
  if (i == k) return;
  for (int j = 0; j < n; ++j) std::swap(A[i + j * n], A[k + j * n]);
  std::swap(b[i], b[k]);
}

// y -= a x over rows [from, n)
void subtractScaled(double* y, double a, const double* x, int from, int n) {
  for (int i = from; i < n; ++i) y[i] -= a * x[i];
}

void substituteBack(const double* U, int n, double* b) {
  for (int k = n - 1; k >= 0; --k) {
    b[k] /= U[k + k * n];
    subtractScaled(b, b[k], U + k * n, 0, k);
  }
}

}  // namespace

bool solveByLu(double* A, int n, double* b) {
  for (int k = 0; k < n; ++k) {
    double* const column = A + k * n;
    swapRows(A, n, b, pivotRow(column, k, n), k);
    const double pivot = column[k];
    if (!(std::abs(pivot) > 0) || !std::isfinite(pivot)) return false;
    const double inverse = 1 / pivot;
    for (int i = k + 1; i < n; ++i) column[i] *= inverse;
    for (int j = k + 1; j < n; ++j) subtractScaled(A + j * n, A[k + j * n], column, k + 1, n);
    subtractScaled(b, b[k], column, k + 1, n);
  }
  substituteBack(A, n, b);
  return true;
}

bool solveByLdlt(double* A, int n, double* b) {
  for (int k = 0; k < n; ++k) {
    double* const column = A + k * n;
    const double pivot = column[k];
    if (!(pivot > 0) || !std::isfinite(pivot)) return false;
    const double inverse = 1 / pivot;
    for (int j = k + 1; j < n; ++j) subtractScaled(A + j * n, column[j] * inverse, column, j, n);
    for (int i = k + 1; i < n; ++i) column[i] *= inverse;
    subtractScaled(b, b[k], column, k + 1, n);
  }
  for (int k = n - 1; k >= 0; --k) {
    double sum = b[k] / A[k + k * n];
    for (int i = k + 1; i < n; ++i) sum -= A[i + k * n] * b[i];
    b[k] = sum;
  }
  return true;
}

}  // namespace pincer::engine
