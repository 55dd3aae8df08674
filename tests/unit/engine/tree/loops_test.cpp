// Loops in trees: what their factor answers, how they bend and close, against dense algebra and differences.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "pincer/engine/tree/loop_closure.h"
#include "pincer/engine/tree/tree_inertia.h"
#include "pincer/engine/tree/tree_pattern.h"
#include "pincer/tests/support/random_tree.h"

namespace pincer::engine {
namespace {

using tests::RandomTree;
using tests::randomTree;

constexpr int kLoopTrees = 300;

// A random tree with one to three joints that close loops where it stands.
struct LoopedTree : RandomTree {
  explicit LoopedTree(std::mt19937_64& random) : RandomTree(randomTree(random, {.mass_ratio = 100})) {
    TreePlace place(tree);
    placeLinks(tree, base, q, place);
    std::uniform_real_distribution<double> near(-0.2, 0.2);
    const int count = std::uniform_int_distribution<int>(1, 3)(random);
    for (int k = 0; k < count; ++k) {
      TreeLoop loop;
      std::uniform_int_distribution<int> links(-1, static_cast<int>(tree.links.size()) - 1);
      loop.kind = static_cast<JointKind>(std::uniform_int_distribution<int>(0, 3)(random));
      loop.a = std::max(links(random), 0);
      loop.b = links(random);
      if (loop.b == loop.a) loop.b = -1;
      const Pose X_WJ{quatFromRotationVector({near(random), near(random), near(random)}),
                      linkPose(place, loop.a).p + Vec3(near(random), near(random), near(random))};
      loop.X_AJ = linkPose(place, loop.a).inverse() * X_WJ;
      loop.X_BJ = (loop.b < 0 ? base.X_WB : linkPose(place, loop.b)).inverse() * X_WJ;
      tree.loops.push_back(loop);
    }
    finishTree(tree);
    std::uniform_real_distribution<double> rate(-1, 1);
    u.resize(tree.before.size());
    for (double& x : u) x = rate(random);
  }
};

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// M with its factor, G, and the inverse of the closed tree's mass by a singular value decomposition.
struct Dense {
  explicit Dense(const LoopedTree& t) : factor(t.tree), rows(t.tree), place(t.tree) {
    placeLinks(t.tree, t.base, t.q, place);
    moveLinks(t.tree, t.base, t.q, t.u, place);
    std::vector<CompositeInertia> composite(t.tree.links.size());
    fillInertia(t.tree, place, composite, factor.entries);
    const int n = t.tree.columnCount();
    M = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = i; j >= 0; j = t.tree.before[static_cast<std::size_t>(j)])
        M(i, j) = M(j, i) = factor.entries[entryOf(t.tree, i, j)];
    }
    fillLoops(t.tree, t.base, place, rows);
    G = Eigen::Map<const Rows>(rows.G.data(), static_cast<Eigen::Index>(rows.miss.size()), n);
    factoriseClosed(t.tree, rows, factor);
    const Eigen::MatrixXd root = Eigen::LLT<Eigen::MatrixXd>(M).matrixL();  // M = L L^T
    const Eigen::MatrixXd inverse_root = root.inverse();
    const Eigen::MatrixXd B = G * inverse_root.transpose();
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(B, Eigen::ComputeFullV);
    const auto rank = (svd.singularValues().array() > 1e-7 * svd.singularValues()[0]).count();
    const Eigen::MatrixXd N = svd.matrixV().rightCols(n - rank);
    answer = inverse_root.transpose() * N * N.transpose() * inverse_root;
    is_clear = (svd.singularValues().array() > 1e-4 * svd.singularValues()[0]).count() == rank;
  }
  TreeFactor factor;
  LoopRows rows;
  TreePlace place;
  Eigen::MatrixXd M, G, answer;
  bool is_clear = true;  // no loop is nearly at a dead centre
};

TEST(TreeLoops, FactorAnswersAsTheClosedTree) {
  std::mt19937_64 random(11);
  int seen = 0;
  for (int n = 0; n < kLoopTrees; ++n) {
    const LoopedTree t(random);
    const Dense dense(t);
    if (!dense.is_clear) continue;
    ++seen;
    const double scale = dense.M.inverse().norm();
    const int columns = t.tree.columnCount();
    Eigen::MatrixXd W(columns, columns), A(columns, columns);
    for (int k = 0; k < columns; ++k) {
      std::vector<double> x(static_cast<std::size_t>(columns), 0), row = x;
      x[static_cast<std::size_t>(k)] = row[static_cast<std::size_t>(k)] = 1;
      solve(t.tree, dense.factor, x);
      scaleRow(t.tree, dense.factor, columns - 1, row);
      W.col(k) = Eigen::Map<const Eigen::VectorXd>(x.data(), columns);
      A.row(k) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), columns);
    }
    // Singular values down to 1e-4 of the largest: their directions are known to 1e4
    // times round-off, squared by the root of M.
    EXPECT_LT((W - dense.answer).norm(), 1e-9 * scale) << n;
    EXPECT_LT((A * A.transpose() - dense.answer).norm(), 1e-9 * scale) << n;
    EXPECT_LE((dense.G * W).norm(), 1e-9 * scale * dense.G.norm()) << n;
  }
  EXPECT_GT(seen, kLoopTrees / 2);
}

TEST(TreeLoops, RowsAreTheRatesAtWhichLoopsOpenAndBend) {
  std::mt19937_64 random(12);
  constexpr double kStep = 1e-5;
  int seen = 0;
  for (int n = 0; n < kLoopTrees; ++n) {
    LoopedTree t(random);
    t.base = {t.base.X_WB, {}};  // it stands still
    Dense dense(t);
    if (!dense.is_clear) continue;
    ++seen;
    LoopBasis basis(t.tree);
    TreePlace place = dense.place;
    closeLoops(t.tree, t.base, dense.factor, 0, dense.rows, basis, t.q, t.u, place);  // rates that open nothing
    const auto after = [&](double h) {
      std::vector<double> q = t.q, step = t.u;
      for (double& s : step) s *= h;
      growCoordinates(t.tree, t.q, step, q);
      TreePlace then(t.tree);
      placeLinks(t.tree, t.base, q, then);
      LoopRows rows(t.tree);
      fillLoops(t.tree, t.base, then, rows);
      return Eigen::VectorXd(
          Eigen::Map<const Rows>(rows.G.data(), static_cast<Eigen::Index>(rows.miss.size()), t.tree.columnCount()) *
          Eigen::Map<const Eigen::VectorXd>(t.u.data(), t.tree.columnCount()));
    };
    const Eigen::VectorXd slope = (after(kStep) - after(-kStep)) / (2 * kStep);
    std::vector<LinkBias> biases(t.tree.links.size());
    std::vector<double> C(t.u.size());
    const Vec3 gravity_W(0, 0, -9.81);
    fillBias(t.tree, place, t.base, gravity_W, {}, t.u, biases, C);
    std::fill(dense.rows.want.begin(), dense.rows.want.end(), 0.0);
    wantBend(t.tree, t.base, gravity_W, place, biases, 1, dense.rows);
    double speed = 1;
    for (const double x : t.u) speed += x * x;
    for (std::size_t k = 0; k < dense.rows.want.size(); ++k)
      // differences
      EXPECT_NEAR(-dense.rows.want[k], slope[static_cast<Eigen::Index>(k)], 1e-7 * speed) << n << " row " << k;
  }
  EXPECT_GT(seen, kLoopTrees / 2);
}

TEST(TreeLoops, WhatIsOpenCloses) {
  std::mt19937_64 random(13);
  int seen = 0;
  for (int n = 0; n < kLoopTrees; ++n) {
    LoopedTree t(random);
    const Dense dense(t);
    if (!dense.is_clear || dense.answer.norm() < 1e-9) continue;
    for (double& x : t.u) x *= 1e-4;
    const std::vector<double> q = t.q;
    growCoordinates(t.tree, q, t.u, t.q);
    TreePlace place(t.tree);
    placeLinks(t.tree, t.base, t.q, place);
    LoopRows rows(t.tree);
    LoopBasis basis(t.tree);
    const double miss = closeLoops(t.tree, t.base, dense.factor, 6, rows, basis, t.q, t.u, place);
    // A loop that is only just possible where it was drawn (a pivot over axes that don't agree) stays open
    // elsewhere: Newton's steps find the nearest.
    seen += miss < 1e-12;
  }
  EXPECT_GT(seen, kLoopTrees / 2);
}

}  // namespace
}  // namespace pincer::engine
