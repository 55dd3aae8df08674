// random_tree: trees of joints that nobody drew, for what must hold of all of them.
#pragma once
#include <random>

#include "pincer/engine/tree.h"
#include "pincer/engine/tree/tree_kinematics.h"

namespace pincer::tests {

struct RandomTree {
  engine::TreeModel tree;
  engine::TreeBase base;
  std::vector<double> q, u;  // u by columns
};

struct RandomTreeOptions {
  int most_links = 8;
  bool balls = true, couplings = true, drives = true, driven_base = true;
  double mass_ratio = 1e4;  // of the heaviest to the lightest link
};

// Repeats itself for the same `random`.
RandomTree randomTree(std::mt19937_64& random, const RandomTreeOptions& options = {});

}  // namespace pincer::tests
