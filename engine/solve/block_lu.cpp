#include "pincer/engine/solve/block_lu.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "pincer/contact/functions/invariants.h"

namespace pincer::engine {
namespace {

constexpr int kB = BlockLu::kBlock;
constexpr int kBB = kB * kB;
constexpr int kMostProducts = 2000;  // of blocks in a factorisation, some 0.1 ms: sweeps over the contacts cost less

// C = A B and C -= A B, row-major.
void multiply(const double* A, const double* B, double* C) {
  for (int i = 0; i < kB; ++i, A += kB, C += kB) {
    double row[kB] = {};
    for (int k = 0; k < kB; ++k) {
      for (int j = 0; j < kB; ++j) row[j] += A[k] * B[kB * k + j];
    }
    std::copy(row, row + kB, C);
  }
}

void subtractProduct(const double* A, const double* B, double* C) {
  for (int i = 0; i < kB; ++i, A += kB, C += kB) {
    for (int k = 0; k < kB; ++k) {
      for (int j = 0; j < kB; ++j) C[j] -= A[k] * B[kB * k + j];
    }
  }
}

// y -= A x
void subtractProduct6(const double* A, const double* x, double* y) {
  for (int i = 0; i < kB; ++i, A += kB) {
    y[i] -= A[0] * x[0] + A[1] * x[1] + A[2] * x[2] + A[3] * x[3] + A[4] * x[4] + A[5] * x[5];
  }
}

// A becomes its inverse, by Gauss and Jordan with row pivots.
bool invert(double* A) {
  int swapped[kB];
  for (int k = 0; k < kB; ++k) {
    int pivot = k;
    for (int i = k + 1; i < kB; ++i) {
      if (std::abs(A[kB * i + k]) > std::abs(A[kB * pivot + k])) pivot = i;
    }
    swapped[k] = pivot;
    if (pivot != k) std::swap_ranges(A + kB * k, A + kB * (k + 1), A + kB * pivot);
    const double value = A[kB * k + k];
    if (!(std::abs(value) > 0) || !std::isfinite(value)) return false;
    const double inverse = 1 / value;
    A[kB * k + k] = 1;
    for (int j = 0; j < kB; ++j) A[kB * k + j] *= inverse;
    double row[kB];
    std::copy(A + kB * k, A + kB * (k + 1), row);
    for (int i = 0; i < kB; ++i) {
      if (i == k) continue;
      const double factor = A[kB * i + k];
      A[kB * i + k] = 0;
      for (int j = 0; j < kB; ++j) A[kB * i + j] -= factor * row[j];
    }
  }
  for (int k = kB - 1; k >= 0; --k) {
    if (swapped[k] == k) continue;
    for (int i = 0; i < kB; ++i) std::swap(A[kB * i + k], A[kB * i + swapped[k]]);
  }
  return true;
}

}  // namespace

BlockLu::BlockLu(int max_nodes, int max_blocks) : max_nodes_(std::min(max_nodes, kMaxNodes)), max_blocks_(max_blocks) {
  const auto n = static_cast<std::size_t>(max_nodes_), blocks = static_cast<std::size_t>(max_blocks);
  slots_.resize(n * n);
  blocks_.resize(kBB * blocks);
  neighbours_.resize(n);
  order_.resize(n);
  first_later_.resize(n + 1);
  later_.resize(blocks);
}

void BlockLu::begin(int nodes) {
  nodes_ = nodes;
  if (nodes > max_nodes_) return;
  for (int a = 0; a < nodes; ++a) neighbours_[a] = {};
}

void BlockLu::connect(int a, int b) {
  PINCER_ASSERT(0 <= a && a < nodes_ && 0 <= b && b < nodes_);
  if (nodes_ > max_nodes_ || a == b) return;
  neighbours_[a][b / 64] |= std::uint64_t{1} << (b % 64);
  neighbours_[b][a / 64] |= std::uint64_t{1} << (a % 64);
}

int BlockLu::nextNode(const std::array<bool, kMaxNodes>& done) const {
  int best = -1, least = kMaxNodes;
  for (int a = 0; a < nodes_; ++a) {
    if (done[a]) continue;
    int degree = 0;
    for (const std::uint64_t word : neighbours_[a]) degree += std::popcount(word);
    if (degree >= least) continue;
    least = degree;
    best = a;
  }
  return best;
}

bool BlockLu::take(int a, int b) {
  int& slot = slots_[a * nodes_ + b];
  if (slot >= 0) return true;
  if (used_ == max_blocks_) return false;
  slot = used_++;
  return true;
}

// Lists the node's neighbours, which become neighbours of each other.
bool BlockLu::eliminate(int node) {
  const Set set = neighbours_[node];
  if (!take(node, node)) return false;
  for (int w = 0; w < kWords; ++w) {
    for (std::uint64_t bits = set[w]; bits; bits &= bits - 1) {
      const int other = 64 * w + std::countr_zero(bits);
      if (!take(node, other) || !take(other, node)) return false;
      later_[first_later_[0]++] = other;
      for (int v = 0; v < kWords; ++v) neighbours_[other][v] |= set[v];
      neighbours_[other][other / 64] &= ~(std::uint64_t{1} << (other % 64));
      neighbours_[other][node / 64] &= ~(std::uint64_t{1} << (node % 64));
    }
  }
  return true;
}

bool BlockLu::order() {
  if (nodes_ > max_nodes_) return false;
  if (nodes_ == 1) {  // one body on many contacts
    slots_[0] = order_[0] = first_later_[0] = first_later_[1] = 0;
    used_ = products_ = 1;
    return max_blocks_ > 0;
  }
  std::fill(slots_.begin(), slots_.begin() + nodes_ * nodes_, -1);
  used_ = 0;
  std::array<bool, kMaxNodes> done{};
  first_later_[0] = 0;  // while ordering: how many are listed
  products_ = nodes_;
  for (int k = 0; k < nodes_; ++k) {
    order_[k] = nextNode(done);
    if (!eliminate(order_[k])) return false;
    done[order_[k]] = true;
    first_later_[k + 1] = first_later_[0];
    const int degree = first_later_[0] - (k == 0 ? 0 : first_later_[k]);
    products_ += degree * (degree + 1);
    if (products_ > kMostProducts) return false;
  }
  first_later_[0] = 0;
  return true;
}

void BlockLu::clear() { std::fill(blocks_.begin(), blocks_.begin() + kBB * used_, 0.0); }

bool BlockLu::factorise() {
  for (int k = 0; k < nodes_; ++k) {
    const int node = order_[k];
    double* const pivot = block(node, node);
    if (!invert(pivot)) return false;
    for (int i = first_later_[k]; i < first_later_[k + 1]; ++i) {
      double* const L = block(later_[i], node);
      multiply(L, pivot, L);
      for (int j = first_later_[k]; j < first_later_[k + 1]; ++j) subtractProduct(L, block(node, later_[j]), block(later_[i], later_[j]));
    }
  }
  return true;
}

void BlockLu::solve(double* b) const {
  for (int k = 0; k < nodes_; ++k) {
    for (int i = first_later_[k]; i < first_later_[k + 1]; ++i) {
      subtractProduct6(block(later_[i], order_[k]), b + kB * order_[k], b + kB * later_[i]);
    }
  }
  for (int k = nodes_ - 1; k >= 0; --k) {
    double* const b_k = b + kB * order_[k];
    for (int j = first_later_[k]; j < first_later_[k + 1]; ++j) subtractProduct6(block(order_[k], later_[j]), b + kB * later_[j], b_k);
    double x[kB] = {};
    const double* const inverse = block(order_[k], order_[k]);
    for (int i = 0; i < kB; ++i) {
      for (int j = 0; j < kB; ++j) x[i] += inverse[kB * i + j] * b_k[j];
    }
    std::copy(x, x + kB, b_k);
  }
}

}  // namespace pincer::engine
