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

// A row of a block in registers: three pairs, or one of four and a pair. Numbers are set there, for one that is written
// to memory holds up who reads its neighbours with it.
template <class Lanes>
struct Row {
  static constexpr int kParts = kB / Lanes::count;
  typename Lanes::Numbers part[kParts];

  [[gnu::always_inline]] explicit Row(const double* row) {
    for (int p = 0; p < kParts; ++p) part[p] = Lanes::at(row + Lanes::count * p);
  }
  [[gnu::always_inline]] void store(double* row) const {
    for (int p = 0; p < kParts; ++p) Lanes::at(row + Lanes::count * p) = part[p];
  }
  [[gnu::always_inline]] void scale(double factor) {
    for (int p = 0; p < kParts; ++p) part[p] *= factor;
  }
  [[gnu::always_inline]] void subtract(double factor, const Row& other) {
    for (int p = 0; p < kParts; ++p) part[p] -= factor * other.part[p];
  }
  template <int k>
  [[gnu::always_inline]] void set(double value) {
    if constexpr (Lanes::count == 1)
      part[k] = value;
    else
      part[k / Lanes::count][k % Lanes::count] = value;
  }
};
#if defined(__x86_64__) && !defined(__clang__)
template <>
struct Row<FourLanes> {
  FourLanes::Numbers front;
  DoublePair end;

  [[gnu::always_inline]] explicit Row(const double* row)
      : front(FourLanes::at(row)), end(pairAt(row + FourLanes::count)) {}
  [[gnu::always_inline]] void store(double* row) const {
    FourLanes::at(row) = front;
    pairAt(row + FourLanes::count) = end;
  }
  [[gnu::always_inline]] void scale(double factor) {
    front *= factor;
    end *= factor;
  }
  [[gnu::always_inline]] void subtract(double factor, const Row& other) {
    front -= factor * other.front;
    end -= factor * other.end;
  }
  template <int k>
  [[gnu::always_inline]] void set(double value) {
    if constexpr (k < FourLanes::count)
      front[k] = value;
    else
      end[k - FourLanes::count] = value;
  }
};
#endif

// C -= A B, row-major.
template <class Lanes>
[[gnu::always_inline]] inline void subtractProduct(Lanes, const double* A, const double* B, double* C) {
  for (int i = 0; i < kB; ++i, A += kB, C += kB) {
    Row<Lanes> c(C);
    for (int k = 0; k < kB; ++k) c.subtract(A[k], Row<Lanes>(B + kB * k));
    c.store(C);
  }
}

// A = A B
template <class Lanes>
[[gnu::always_inline]] inline void multiplyBy(Lanes, double* A, const double* B) {
  for (int i = 0; i < kB; ++i, A += kB) {
    Row<Lanes> product(B);
    product.scale(A[0]);
    for (int k = 1; k < kB; ++k) product.subtract(-A[k], Row<Lanes>(B + kB * k));
    product.store(A);
  }
}

// y -= A x
void subtractProduct6(const double* A, const double* x, double* y) {
  for (int i = 0; i < kB; ++i, A += kB) {
    y[i] -= A[0] * x[0] + A[1] * x[1] + A[2] * x[2] + A[3] * x[3] + A[4] * x[4] + A[5] * x[5];
  }
}

// Step k of Gauss and Jordan's: row k and that of the largest pivot change places, then the others lose column k.
template <int k, class Lanes>
[[gnu::always_inline]] inline bool eliminate(Lanes, double* A, int& pivot) {
  pivot = k;
  for (int i = k + 1; i < kB; ++i) {
    if (std::abs(A[kB * i + k]) > std::abs(A[kB * pivot + k])) pivot = i;
  }
  if (pivot != k) std::swap_ranges(A + kB * k, A + kB * (k + 1), A + kB * pivot);
  const double value = A[kB * k + k];
  if (!(std::abs(value) > 0) || !std::isfinite(value)) return false;
  Row<Lanes> row(A + kB * k);
  row.template set<k>(1);
  row.scale(1 / value);
  row.store(A + kB * k);
  for (int i = 0; i < kB; ++i) {
    if (i == k) continue;
    Row<Lanes> other(A + kB * i);
    const double factor = A[kB * i + k];
    other.template set<k>(0);
    other.subtract(factor, row);
    other.store(A + kB * i);
  }
  return true;
}

// A becomes its inverse, by Gauss and Jordan with row pivots.
template <class Lanes>
[[gnu::always_inline]] inline bool invert(Lanes lanes, double* A) {
  int swapped[kB];
  const bool is_regular = eliminate<0>(lanes, A, swapped[0]) && eliminate<1>(lanes, A, swapped[1]) &&
                          eliminate<2>(lanes, A, swapped[2]) && eliminate<3>(lanes, A, swapped[3]) &&
                          eliminate<4>(lanes, A, swapped[4]) && eliminate<5>(lanes, A, swapped[5]);
  if (!is_regular) return false;
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
      if (!invert(lanes, pivot)) return false;
      for (int i = first_later_[k]; i < first_later_[k + 1]; ++i) {
        double* const L = block(lower_[i]);
        multiplyBy(lanes, L, pivot);
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
