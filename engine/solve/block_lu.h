// block_lu: sparse linear equations in blocks of 6 x 6, for matrices with as
// many blocks above the diagonal as below it.
//
//   H x = b,   H_ij != 0 only where i and j were connected, or fill in
//
// Nodes are eliminated in the order of least degree, ties by number: a function of the structure alone, so the
// same bits every time. Chains and trees (stacks, fingers around an object) cost a time proportional to their
// length. Pivots are searched within blocks. Results of the structure are kept for as long as the structure
// stays the same. Source: A. George, J. Liu, SIAM Review 31 (1989) 1-19 (minimum degree); G. Golub, C. Van Loan,
// Matrix Computations, 4th ed., section 4.5.
#pragma once
#include <cstdint>
#include <vector>

namespace pincer::engine {

class BlockLu {
 public:
  static constexpr int kBlock = 6;        // freedoms of a mover
  static constexpr int kMaxNodes = 1024;  // chosen: the table of places takes 4 MB then

  // Memory for `max_nodes` (at most kMaxNodes are treated), `max_blocks` blocks and
  // `max_products` of blocks in a factorisation.
  BlockLu(int max_nodes, int max_blocks, int max_products);

  // Structure: begin, connect every pair (as often as wanted), order. False if nodes, fill or products
  // exceed the memory, or the products `most`.
  void begin(int nodes);
  void connect(int a, int b);
  bool order(int most);
  int nodes() const { return nodes_; }
  int products() const { return products_; }  // of blocks, in a factorisation
  std::int64_t cost() const { return std::int64_t{kBlock * kBlock * kBlock} * products_; }  // of it: multiplications

  // Where the row-major block H_ab lies, for connected a and b; the same as long as the structure is.
  int place(int a, int b) const {
    return slots_[static_cast<std::size_t>(a) * static_cast<std::size_t>(nodes_) + static_cast<std::size_t>(b)];
  }
  double* block(int place) { return blocks_.data() + kBlock * kBlock * place; }

  // Values: clear (to the identity), add to blocks, factorise, solve as often as wanted.
  // False if a block is singular or not finite.
  void clear();
  bool factorise();
  void solve(double* b) const;

 private:
  void sortEdges();
  bool isKept(int most);
  bool analyse(int most);
  void link(int a, int b);
  int nextNode() const;
  bool eliminate(int node);
  bool take(int a, int b);
  bool listProducts();

  int max_nodes_, max_blocks_, max_products_;
  int nodes_ = 0, used_ = 0, products_ = 0, words_ = 0;
  std::vector<std::uint64_t> edges_, kept_edges_;  // a nodes + b, a < b; of the structure that is analysed
  int kept_nodes_ = -1, kept_most_ = 0;
  bool kept_fits_ = false;
  std::vector<int> slots_;  // of block (a, b), -1 for none
  std::vector<double> blocks_;
  std::vector<std::uint64_t> neighbours_;  // per node a set of those not yet eliminated, while ordering
  std::vector<int> degree_;                // of them; -1: eliminated
  // nodes as eliminated; who each couples to then: entries first_later_[k] .. of
  std::vector<int> order_, first_later_;
  std::vector<int> later_, lower_, upper_;  // the node, and the places of H_later,node and H_node,later
  std::vector<int> targets_;                // of a factorisation's products, in its order
};

}  // namespace pincer::engine
