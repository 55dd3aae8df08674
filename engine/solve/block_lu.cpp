#include "pincer/engine/solve/block_lu.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "pincer/contact/functions/invariants.h"
#include "pincer/engine/solve/wide.h"

namespace pincer::engine {
namespace {

// Numbers of a row, and of a block.
constexpr int kB = BlockLu::kBlock;
constexpr int kBB = kB * kB;

// C -= A B, row-major, a row at a time in registers: in three pairs, or in one of four and one of two.
void subtractProduct(NarrowLanes, const double* A, const double* B, double* C) {
  for (int i = 0; i < kB; ++i, A += kB, C += kB) {
    DoublePair* const c = &pairAt(C);
    DoublePair c0 = c[0], c1 = c[1], c2 = c[2];
    for (int k = 0; k < kB; ++k) {
      const DoublePair* const b = &pairAt(B + kB * k);
      const DoublePair a = {A[k], A[k]};
      c0 -= a * b[0];
      c1 -= a * b[1];
      c2 -= a * b[2];
    }
    c[0] = c0;
    c[1] = c1;
    c[2] = c2;
  }
}
#if defined(__x86_64__) && !defined(__clang__)
// All of B stays in registers: less than half the time of pairs.
[[gnu::target("avx2")]] void subtractProduct(FourLanes, const double* A, const double* B, double* C) {
  FourLanes::Numbers b[kB];
  DoublePair b_end[kB];
#pragma GCC unroll 6
  for (int k = 0; k < kB; ++k) {
    b[k] = FourLanes::at(B + kB * k);
    b_end[k] = pairAt(B + kB * k + FourLanes::count);
  }
  for (int i = 0; i < kB; ++i, A += kB, C += kB) {
    FourLanes::Numbers c = FourLanes::at(C);
    DoublePair c_end = pairAt(C + FourLanes::count);
#pragma GCC unroll 6
    for (int k = 0; k < kB; ++k) {
      c -= A[k] * b[k];
      c_end -= A[k] * b_end[k];
    }
    FourLanes::at(C) = c;
    pairAt(C + FourLanes::count) = c_end;
  }
}
#endif

// C = A B; C may be A.
template <class Lanes>
void multiply(Lanes lanes, const double* A, const double* B, double* C) {
  double product[kBB] = {};
  subtractProduct(lanes, A, B, product);
  for (int k = 0; k < kBB; ++k) C[k] = -product[k];
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

BlockLu::BlockLu(int max_nodes, int max_blocks, int max_products)
    : max_nodes_(std::min(max_nodes, kMaxNodes)), max_blocks_(max_blocks), max_products_(max_products) {
  const auto n = static_cast<std::size_t>(max_nodes_), blocks = static_cast<std::size_t>(max_blocks);
  slots_.resize(n * n);
  blocks_.resize(kBB * blocks);
  neighbours_.resize(n * ((n + 63) / 64));
  degree_.resize(n);
  order_.resize(n);
  first_later_.resize(n + 1);
  for (std::vector<int>* per_block : {&later_, &lower_, &upper_}) per_block->resize(blocks);
  targets_.resize(static_cast<std::size_t>(max_products));
  for (std::vector<std::uint64_t>* edges : {&edges_, &kept_edges_}) edges->reserve(4 * blocks);
}

void BlockLu::begin(int nodes) {
  nodes_ = nodes;
  edges_.clear();
}

void BlockLu::connect(int a, int b) {
  PINCER_ASSERT(0 <= a && a < nodes_ && 0 <= b && b < nodes_);
  if (a == b) return;
  const std::uint64_t edge = static_cast<std::uint64_t>(std::min(a, b)) * static_cast<std::uint64_t>(nodes_) +
                             static_cast<std::uint64_t>(std::max(a, b));
  if (!edges_.empty() && edges_.back() == edge) return;  // contacts of one pair follow each other
  if (edges_.size() == edges_.capacity()) sortEdges();
  if (edges_.size() < edges_.capacity()) edges_.push_back(edge);
}

void BlockLu::sortEdges() {
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
}

bool BlockLu::order(int most) {
  sortEdges();
  if (nodes_ > max_nodes_ || edges_.size() == edges_.capacity()) return false;
  if (isKept(most)) return kept_fits_;
  kept_nodes_ = nodes_;
  kept_most_ = most;
  kept_edges_.assign(edges_.begin(), edges_.end());
  return kept_fits_ = analyse(std::min(most, max_products_)) && listProducts();
}

bool BlockLu::isKept(int most) { return kept_nodes_ == nodes_ && kept_most_ == most && kept_edges_ == edges_; }

bool BlockLu::analyse(int most) {
  words_ = (nodes_ + 63) / 64;
  std::fill(slots_.begin(), slots_.begin() + nodes_ * nodes_, -1);
  std::fill(neighbours_.begin(), neighbours_.begin() + nodes_ * words_, 0);
  std::fill(degree_.begin(), degree_.begin() + nodes_, 0);
  for (const std::uint64_t edge : edges_) {
    link(static_cast<int>(edge / static_cast<std::uint64_t>(nodes_)),
         static_cast<int>(edge % static_cast<std::uint64_t>(nodes_)));
  }
  used_ = 0;
  products_ = nodes_;
  first_later_[0] = 0;
  for (int k = 0; k < nodes_; ++k) {
    const int node = order_[k] = nextNode();
    const int degree = degree_[node];
    products_ += degree * (degree + 1);
    first_later_[k + 1] = first_later_[k];
    if (products_ > most || !eliminate(k)) return false;
    degree_[node] = -1;
  }
  return true;
}

void BlockLu::link(int a, int b) {
  for (int side = 0; side < 2; ++side, std::swap(a, b)) {
    neighbours_[a * words_ + b / 64] |= std::uint64_t{1} << (b % 64);
    ++degree_[a];
  }
}

int BlockLu::nextNode() const {
  int best = -1, least = kMaxNodes;
  for (int a = 0; a < nodes_; ++a) {
    if (degree_[a] < 0 || degree_[a] >= least) continue;
    least = degree_[a];
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

// Lists the neighbours of the k-th node, which become neighbours of each other.
bool BlockLu::eliminate(int k) {
  const int node = order_[k];
  const std::uint64_t* const set = neighbours_.data() + node * words_;
  if (!take(node, node)) return false;
  for (int w = 0; w < words_; ++w) {
    for (std::uint64_t bits = set[w]; bits; bits &= bits - 1) {
      const int other = 64 * w + std::countr_zero(bits);
      if (!take(node, other) || !take(other, node)) return false;
      later_[first_later_[k + 1]++] = other;
      std::uint64_t* const others = neighbours_.data() + other * words_;
      int degree = 0;
      for (int v = 0; v < words_; ++v) others[v] |= set[v];
      others[other / 64] &= ~(std::uint64_t{1} << (other % 64));
      others[node / 64] &= ~(std::uint64_t{1} << (node % 64));
      for (int v = 0; v < words_; ++v) degree += std::popcount(others[v]);
      degree_[other] = degree;
    }
  }
  return true;
}

bool BlockLu::listProducts() {
  int* target = targets_.data();
  for (int k = 0; k < nodes_; ++k) {
    const int node = order_[k];
    for (int i = first_later_[k]; i < first_later_[k + 1]; ++i) {
      lower_[i] = place(later_[i], node);
      upper_[i] = place(node, later_[i]);
      for (int j = first_later_[k]; j < first_later_[k + 1]; ++j) *target++ = place(later_[i], later_[j]);
    }
  }
  PINCER_ASSERT(target - targets_.data() <= max_products_);
  return true;
}

void BlockLu::clear() {
  std::fill(blocks_.begin(), blocks_.begin() + kBB * used_, 0.0);
  for (int node = 0; node < nodes_; ++node) {
    for (int k = 0; k < kB; ++k) block(place(node, node))[(kB + 1) * k] = 1;
  }
}

bool BlockLu::factorise() {
  return wide([this](auto lanes) __attribute__((always_inline)) {
    const int* target = targets_.data();
    for (int k = 0; k < nodes_; ++k) {
      double* const pivot = block(place(order_[k], order_[k]));
      if (!invert(pivot)) return false;
      for (int i = first_later_[k]; i < first_later_[k + 1]; ++i) {
        double* const L = block(lower_[i]);
        multiply(lanes, L, pivot, L);
        for (int j = first_later_[k]; j < first_later_[k + 1]; ++j)
          subtractProduct(lanes, L, block(upper_[j]), block(*target++));
      }
    }
    return true;
  });
}

void BlockLu::solve(double* b) const {
  const auto at = [&](int slot) { return blocks_.data() + kBB * slot; };
  for (int k = 0; k < nodes_; ++k) {
    const double* const b_k = b + kB * order_[k];
    for (int i = first_later_[k]; i < first_later_[k + 1]; ++i)
      subtractProduct6(at(lower_[i]), b_k, b + kB * later_[i]);
  }
  for (int k = nodes_ - 1; k >= 0; --k) {
    double* const b_k = b + kB * order_[k];
    for (int j = first_later_[k]; j < first_later_[k + 1]; ++j)
      subtractProduct6(at(upper_[j]), b + kB * later_[j], b_k);
    double x[kB] = {};
    const double* const inverse = at(place(order_[k], order_[k]));
    for (int i = 0; i < kB; ++i) {
      for (int j = 0; j < kB; ++j) x[i] += inverse[kB * i + j] * b_k[j];
    }
    std::copy(x, x + kB, b_k);
  }
}

}  // namespace pincer::engine
