// block_lu: sparse linear equations in blocks of 6 x 6, for matrices with as many blocks above the diagonal as below it.
//
//   H x = b,   H_ij != 0 only where i and j were connected, or fill in
//
// Nodes are eliminated in the order of least degree, ties by number: a function of the structure alone, so the same bits every time. Chains
// and trees (stacks, fingers around an object) cost a time proportional to their length. Pivots are searched within blocks.
// Source: A. George, J. Liu, SIAM Review 31 (1989) 1-19 (minimum degree); G. Golub, C. Van Loan, Matrix Computations, 4th ed., section 4.5.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace pincer::engine {

class BlockLu {
 public:
  static constexpr int kBlock = 6;
  static constexpr int kMaxNodes = 128;

  // Memory for `max_nodes` (at most kMaxNodes are treated) and for `max_blocks` blocks.
  BlockLu(int max_nodes, int max_blocks);

  // Structure: begin, connect every pair, order. False if nodes or fill exceed the memory, or the factorisation would take too long.
  void begin(int nodes);
  void connect(int a, int b);
  bool order();
  int products() const { return products_; }  // of blocks, in a factorisation

  // Values: clear, add to the row-major blocks H_ab, factorise, solve as often as wanted. False if a block is singular or not finite.
  void clear();
  double* block(int a, int b) { return blocks_.data() + kBlock * kBlock * slots_[a * nodes_ + b]; }
  bool factorise();
  void solve(double* b) const;

 private:
  static constexpr int kWords = kMaxNodes / 64;
  using Set = std::array<std::uint64_t, kWords>;

  int nextNode(const std::array<bool, kMaxNodes>& done) const;
  bool eliminate(int node);
  bool take(int a, int b);
  const double* block(int a, int b) const { return blocks_.data() + kBlock * kBlock * slots_[a * nodes_ + b]; }

  int max_nodes_, max_blocks_, nodes_ = 0, used_ = 0, products_ = 0;
  std::vector<int> slots_;  // of block (a, b), -1 for none
  std::vector<double> blocks_;
  std::vector<Set> neighbours_;                   // not yet eliminated, while ordering
  std::vector<int> order_, first_later_, later_;  // nodes as eliminated; who each couples to then: later_[first_later_[k]] ..
};

}  // namespace pincer::engine
