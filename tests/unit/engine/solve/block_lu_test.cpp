// The block-sparse factorisation against Eigen's dense one.
#include "pincer/engine/solve/block_lu.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <utility>
#include <vector>

namespace pincer::engine {
namespace {

constexpr int kB = BlockLu::kBlock;
constexpr int kManyProducts = 20000;
using Edges = std::vector<std::pair<int, int>>;
using Row = Eigen::Matrix<double, kB, kB, Eigen::RowMajor>;

// Random blocks on the edges, a dominant diagonal: conditions of 10 or so.
Eigen::MatrixXd fill(BlockLu& lu, int nodes, const Edges& edges, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::MatrixXd H = Eigen::MatrixXd::Identity(kB * nodes, kB * nodes);
  const auto add = [&](int a, int b, double diagonal) {
    Row block;
    for (int k = 0; k < kB * kB; ++k) block.data()[k] = uniform(generator);
    block += diagonal * Row::Identity();
    H.block(kB * a, kB * b, kB, kB) += block;
    for (int k = 0; k < kB * kB; ++k) lu.block(lu.place(a, b))[k] += block.data()[k];
  };
  for (int a = 0; a < nodes; ++a) add(a, a, 8.0 * kB);
  for (const auto& [a, b] : edges) {
    add(a, b, 0);
    add(b, a, 0);
  }
  return H;
}

void expectSolves(int nodes, const Edges& edges, int max_blocks) {
  BlockLu lu(nodes, max_blocks, kManyProducts);
  lu.begin(nodes);
  for (const auto& [a, b] : edges) lu.connect(a, b);
  ASSERT_TRUE(lu.order(kManyProducts));
  lu.clear();
  const Eigen::MatrixXd H = fill(lu, nodes, edges, 7);
  ASSERT_TRUE(lu.factorise());
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(kB * nodes, -1, 1), b = x;
  lu.solve(x.data());
  EXPECT_LE((H * x - b).norm(), 1e-13 * H.norm() * x.norm());  // some hundred ulp for matrices of this condition
}

TEST(BlockLu, SolvesOneNode) { expectSolves(1, {}, 1); }

TEST(BlockLu, SolvesAChainWithoutFill) {
  Edges chain;
  for (int k = 0; k + 1 < 60; ++k) chain.emplace_back(k, k + 1);
  expectSolves(60, chain, 60 + 2 * 59);  // exactly as many blocks as the matrix has
}

TEST(BlockLu, SolvesAStarWithoutFill) {
  Edges star;
  for (int k = 1; k < 20; ++k) star.emplace_back(0, k);
  expectSolves(20, star, 20 + 2 * 19);
}

TEST(BlockLu, SolvesARing) {
  Edges ring;
  for (int k = 0; k < 30; ++k) ring.emplace_back(k, (k + 1) % 30);
  expectSolves(30, ring, 30 + 4 * 30);
}

TEST(BlockLu, SolvesRandomGraphs) {
  std::mt19937 generator(3);
  for (int n = 0; n < 20; ++n) {
    Edges edges;
    const int nodes = 2 + static_cast<int>(generator() % 15);
    for (int e = 0; e < 2 * nodes; ++e) {
      const int a = static_cast<int>(generator() % static_cast<unsigned>(nodes)),
                b = static_cast<int>(generator() % static_cast<unsigned>(nodes));
      if (a != b) edges.emplace_back(a, b);
    }
    expectSolves(nodes, edges, nodes * nodes);
  }
}

TEST(BlockLu, SaysSoWhenTheMemoryDoesNotSuffice) {
  BlockLu small(10, 12, kManyProducts);
  small.begin(10);
  for (int k = 0; k + 1 < 10; ++k) small.connect(k, k + 1);
  EXPECT_FALSE(small.order(kManyProducts));
  BlockLu few(BlockLu::kMaxNodes + 1, 1, kManyProducts);
  few.begin(BlockLu::kMaxNodes + 1);
  EXPECT_FALSE(few.order(kManyProducts));
}

TEST(BlockLu, SaysSoWhenAllAreConnectedToAll) {
  BlockLu lu(40, 1600, 2000);
  lu.begin(40);
  for (int a = 0; a < 40; ++a) {
    for (int b = 0; b < a; ++b) lu.connect(a, b);
  }
  EXPECT_FALSE(lu.order(kManyProducts));
}

// The order that follows from the structure is kept as long as the structure is the same, and no longer.
TEST(BlockLu, SolvesOneStructureAfterAnother) {
  BlockLu lu(12, 144, kManyProducts);
  for (int n = 0; n < 8; ++n) {
    Edges edges;
    for (int k = 0; k + 1 < 12; ++k) edges.emplace_back(k, k + 1);
    if (n % 3 > 0) edges.emplace_back(0, 4 + n);
    lu.begin(12);
    for (const auto& [a, b] : edges) lu.connect(a, b);
    ASSERT_TRUE(lu.order(kManyProducts));
    lu.clear();
    const Eigen::MatrixXd H = fill(lu, 12, edges, 7);
    ASSERT_TRUE(lu.factorise());
    Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(kB * 12, -1, 1), b = x;
    lu.solve(x.data());
    EXPECT_LE((H * x - b).norm(), 1e-13 * H.norm() * x.norm()) << n;
  }
}

TEST(BlockLu, SaysSoWhenABlockIsSingular) {
  BlockLu lu(1, 1, 1);
  lu.begin(1);
  ASSERT_TRUE(lu.order(kManyProducts));
  lu.clear();
  for (int k = 0; k < kB; ++k) lu.block(lu.place(0, 0))[(kB + 1) * k] = 0;
  EXPECT_FALSE(lu.factorise());
}

}  // namespace
}  // namespace pincer::engine
