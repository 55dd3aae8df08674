// The mathematics of trees of joints, against sums over links, differences in time and dense algebra.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "pincer/engine/tree/sparse_ldl.h"
#include "pincer/engine/tree/tree_bias.h"
#include "pincer/engine/tree/tree_course.h"
#include "pincer/engine/tree/tree_inertia.h"
#include "pincer/engine/tree/tree_kinematics.h"
#include "pincer/tests/support/random_tree.h"

namespace pincer::engine {
namespace {

using tests::RandomTree;
using tests::randomTree;

constexpr int kTrees = 400;

struct Looked {
  explicit Looked(const RandomTree& t, const std::vector<double>& q, const TreeBase& base) : place(t.tree) {
    placeLinks(t.tree, base, q, place);
    moveLinks(t.tree, base, q, t.u, place);
  }
  explicit Looked(const RandomTree& t) : Looked(t, t.q, t.base) {}
  TreePlace place;
};

std::vector<double> grown(const RandomTree& t, double h) {
  std::vector<double> q(t.q.size()), step = t.u;
  for (double& s : step) s *= h;
  growCoordinates(t.tree, t.q, step, q);
  return q;
}

// Where a base that goes on with its acceleration is `h` later.
TreeBase baseAfter(const TreeBase& b, double h) {
  const Vec3 turn = h * b.motion.w_W + 0.5 * h * h * b.alpha_W;
  return {{quatFromRotationVector(turn) * b.X_WB.q, b.X_WB.p + h * b.motion.v_W + 0.5 * h * h * b.a_W},
          {b.motion.v_W + h * b.a_W, b.motion.w_W + h * b.alpha_W},
          b.a_W,
          b.alpha_W};
}

Mat3 inertiaOf(const TreeLink& link, const LinkPlace& place) {
  const Mat3 R = place.q_WL.toRotationMatrix();
  return R * link.moments.asDiagonal() * R.transpose();
}

// Six rows: of the centre of mass's velocity and of the turn, by columns.
Eigen::MatrixXd jacobianOf(const RandomTree& t, const TreePlace& place, int link) {
  Eigen::MatrixXd J(6, t.tree.columnCount());
  for (int k = 0; k < 6; ++k) {
    std::vector<double> row(t.u.size(), 0);
    const Vec3 e = Vec3::Unit(k % 3), none = Vec3::Zero();
    addJacobian(t.tree, place, link, place.links[static_cast<std::size_t>(link)].p_OL, k < 3 ? e : none,
                k < 3 ? none : e, row);
    J.row(k) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), t.tree.columnCount());
  }
  return J;
}

Eigen::MatrixXd unpacked(const TreeModel& tree, std::span<const double> M) {
  const int n = tree.columnCount();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = i; j >= 0; j = tree.before[static_cast<std::size_t>(j)])
      dense(i, j) = dense(j, i) = M[entryOf(tree, i, j)];
  }
  return dense;
}

Eigen::MatrixXd massMatrix(const RandomTree& t, const TreePlace& place) {
  std::vector<CompositeInertia> composite(t.tree.links.size());
  std::vector<double> M(static_cast<std::size_t>(t.tree.entries));
  fillInertia(t.tree, place, composite, M);
  return unpacked(t.tree, M);
}

TEST(TreeMathematics, LinksMoveAsTheirPlacesChange) {
  std::mt19937_64 random(1);
  for (int n = 0; n < kTrees; ++n) {
    const RandomTree t = randomTree(random);
    constexpr double kStep = 1e-5;  // its square is what differences are off by, round-off over it likewise: 1e-10
    const Looked now(t), later(t, grown(t, kStep), baseAfter(t.base, kStep)),
        before(t, grown(t, -kStep), baseAfter(t.base, -kStep));
    for (std::size_t l = 0; l < t.tree.links.size(); ++l) {
      const int link = static_cast<int>(l);
      const Pose a = linkPose(before.place, link), b = linkPose(later.place, link);
      const Motion& motion = now.place.links[l].motion;
      EXPECT_LE(((b.p - a.p) / (2 * kStep) - motion.v_W).norm(), 1e-7) << n;
      const Quat turn = b.q * a.q.conjugate();
      EXPECT_LE((2 * signOf(turn.w()) * turn.vec() / (2 * kStep) - motion.w_W).norm(), 1e-6) << n;
    }
  }
}

TEST(TreeMathematics, InertiaIsTheSumOverLinks) {
  std::mt19937_64 random(2);
  for (int n = 0; n < kTrees; ++n) {
    const RandomTree t = randomTree(random);
    const Looked now(t);
    const Eigen::MatrixXd M = massMatrix(t, now.place);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(M.rows(), M.cols());
    for (std::size_t l = 0; l < t.tree.links.size(); ++l) {
      const Eigen::MatrixXd J = jacobianOf(t, now.place, static_cast<int>(l));
      sum += t.tree.links[l].mass * J.topRows(3).transpose() * J.topRows(3);
      sum += J.bottomRows(3).transpose() * inertiaOf(t.tree.links[l], now.place.links[l]) * J.bottomRows(3);
    }
    for (std::size_t i = 0; i < t.tree.coordinates.size(); ++i) {
      const double share = now.place.coordinates[i].share;
      sum(t.tree.coordinates[i].column, t.tree.coordinates[i].column) +=
          share * share * t.tree.coordinates[i].traits.armature;
    }
    for (int i = 0; i < M.rows(); ++i) {
      for (int j = 0; j < M.cols(); ++j)
        EXPECT_NEAR(M(i, j), sum(i, j), 1e-13 * std::sqrt(sum(i, i) * sum(j, j))) << n;  // round-off of eight links
    }
  }
}

// d'Alembert: C is what the links' momenta change by, seen through J, where the columns' rates stay.
TEST(TreeMathematics, BiasIsTheChangeOfMomentumWithoutAcceleration) {
  std::mt19937_64 random(3);
  const Vec3 gravity_W(0.3, -0.2, -9.81);
  for (int n = 0; n < kTrees; ++n) {
    const RandomTree t = randomTree(random);
    constexpr double kStep = 1e-5;
    const Looked now(t), later(t, grown(t, kStep), baseAfter(t.base, kStep)),
        before(t, grown(t, -kStep), baseAfter(t.base, -kStep));
    std::vector<LinkForce> forces(t.tree.links.size());
    for (std::size_t l = 0; l < forces.size(); ++l)
      forces[l] = {Vec3(0.1, 0.2 * double(l), -0.3), Vec3(0.01, -0.02, 0.03)};
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(t.tree.columnCount());
    double scale = 1e-3;
    for (std::size_t l = 0; l < t.tree.links.size(); ++l) {
      const TreeLink& link = t.tree.links[l];
      const LinkPlace &a = before.place.links[l], &b = later.place.links[l];
      Eigen::VectorXd change(6);
      change << link.mass * ((b.motion.v_W - a.motion.v_W) / (2 * kStep) - gravity_W) - forces[l].f_W,
          (inertiaOf(link, b) * b.motion.w_W - inertiaOf(link, a) * a.motion.w_W) / (2 * kStep) - forces[l].tau_W;
      sum += jacobianOf(t, now.place, static_cast<int>(l)).transpose() * change;
      scale += change.norm();
    }
    for (std::size_t i = 0; i < t.tree.coordinates.size(); ++i) {
      const CoordinatePlace &a = before.place.coordinates[i], &b = later.place.coordinates[i];
      const int column = t.tree.coordinates[i].column;
      sum[column] += now.place.coordinates[i].share * t.tree.coordinates[i].traits.armature * (b.share - a.share) /
                     (2 * kStep) * t.u[static_cast<std::size_t>(column)];
    }
    std::vector<LinkBias> links(t.tree.links.size());
    std::vector<double> C(t.u.size());
    fillBias(t.tree, now.place, t.base, gravity_W, forces, t.u, links, C);
    // differences
    for (int c = 0; c < t.tree.columnCount(); ++c)
      EXPECT_NEAR(C[static_cast<std::size_t>(c)], sum[c], 1e-7 * scale) << n;
  }
}

TEST(TreeMathematics, FactorIsThatOfDenseAlgebra) {
  std::mt19937_64 random(4);
  for (int n = 0; n < kTrees; ++n) {
    const RandomTree t = randomTree(random);
    const Looked now(t);
    const int columns = t.tree.columnCount();
    TreeFactor factor(t.tree);
    std::vector<CompositeInertia> composite(t.tree.links.size());
    fillInertia(t.tree, now.place, composite, factor.entries);
    std::vector<ColumnShare> shares;
    for (const TreeDrive& drive : t.tree.drives) {
      columnShares(t.tree, now.place, drive, shares);
      addSquare(t.tree, shares, 0.7, factor.entries);
    }
    const Eigen::MatrixXd M = unpacked(t.tree, factor.entries),
                          inverse = M.llt().solve(Eigen::MatrixXd::Identity(columns, columns));
    ASSERT_TRUE(factorise(t.tree, factor));
    for (std::size_t l = 0; l < t.tree.links.size(); ++l) {
      const int tip = t.tree.links[l].tip;
      const Eigen::MatrixXd J = jacobianOf(t, now.place, static_cast<int>(l));
      Eigen::MatrixXd A = J;
      for (int k = 0; k < 6; ++k) {
        std::vector<double> row(t.u.size());
        Eigen::Map<Eigen::RowVectorXd>(row.data(), columns) = J.row(k);
        if (tip >= 0) scaleRow(t.tree, factor, tip, row);
        A.row(k) = Eigen::Map<Eigen::RowVectorXd>(row.data(), columns);
      }
      const Eigen::MatrixXd W = J * inverse * J.transpose();
      EXPECT_LE((A * A.transpose() - W).norm(), 1e-11 * W.norm() + 1e-300)
          << n;  // masses of 1e4 to 1 cost four digits of the dense inverse
      // Rates of an impulse: J^T r through the inverse, and through the scaled velocities.
      const Eigen::VectorXd r = Eigen::VectorXd::LinSpaced(6, -1, 2), wanted = inverse * J.transpose() * r;
      std::vector<double> y(t.u.size()), x(t.u.size());
      Eigen::Map<Eigen::VectorXd>(y.data(), columns) = A.transpose() * r;
      unscale(t.tree, factor, y);
      Eigen::Map<Eigen::VectorXd>(x.data(), columns) = J.transpose() * r;
      solve(t.tree, factor, x);
      EXPECT_LE((Eigen::Map<Eigen::VectorXd>(y.data(), columns) - wanted).norm(), 1e-10 * wanted.norm() + 1e-300) << n;
      EXPECT_LE((Eigen::Map<Eigen::VectorXd>(x.data(), columns) - wanted).norm(), 1e-10 * wanted.norm() + 1e-300) << n;
    }
  }
}

// Without ties a column's path is its branch, so that nothing is stored that can't be.
TEST(TreeMathematics, BlocksAreRunsOfAtMostSixWithoutABranch) {
  std::mt19937_64 random(5);
  for (int n = 0; n < kTrees; ++n) {
    const TreeModel tree = randomTree(random, {.most_links = 20}).tree;
    std::vector<int> count(tree.blocks.size(), 0);
    for (int c = 0; c < tree.columnCount(); ++c) {
      const auto i = static_cast<std::size_t>(c);
      const auto block = static_cast<std::size_t>(tree.block_of[i]);
      EXPECT_EQ(tree.column_in_block[i], count[block]++);
      EXPECT_LT(tree.before[i], c);
      const int before = tree.before[i];
      if (tree.column_in_block[i] > 0)
        EXPECT_EQ(tree.block_of[static_cast<std::size_t>(before)], tree.block_of[i]);
      else
        EXPECT_EQ(tree.blocks[block].parent, before < 0 ? -1 : tree.block_of[static_cast<std::size_t>(before)]);
    }
    for (std::size_t b = 0; b < count.size(); ++b) {
      EXPECT_EQ(count[b], tree.blocks[b].count);
      EXPECT_LE(count[b], 6);
    }
  }
}

}  // namespace
}  // namespace pincer::engine
