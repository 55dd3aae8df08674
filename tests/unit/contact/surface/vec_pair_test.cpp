// Two vectors side by side have the bits that each has alone: patches don't depend
// on which of their edges share a register.
#include <gtest/gtest.h>

#include <random>

#include "pincer/contact/surface/edge_cubic.h"

namespace pincer::contact {
namespace {

struct EdgeEnds {
  Vec3 p0, p1, n0, n1;
};

class VecPairs : public testing::Test {
 protected:
  Vec3 vector() { return {uniform_(random_), uniform_(random_), uniform_(random_)}; }
  EdgeEnds edge() { return {vector(), vector(), vector().normalized(), vector().normalized()}; }

 private:
  std::mt19937_64 random_{1};
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

template <class Call>
auto sideBySide(const EdgeEnds& a, const EdgeEnds& b, Call&& call) {
  return call(VecPair(a.p0, b.p0), VecPair(a.p1, b.p1), VecPair(a.n0, b.n0), VecPair(a.n1, b.n1));
}

TEST_F(VecPairs, HaveTheHandlesOfEachEdgeAlone) {
  for (int i = 0; i < 1000; ++i) {
    const EdgeEnds a = edge(), b = edge();
    const auto pair = sideBySide(a, b, [](const auto&... v) { return smoothHandles(v...); });
    const EdgeHandles first = smoothHandles(a.p0, a.p1, a.n0, a.n1), second = smoothHandles(b.p0, b.p1, b.n0, b.n1);
    EXPECT_EQ(pair.first.first(), first.first);
    EXPECT_EQ(pair.second.first(), first.second);
    EXPECT_EQ(pair.first.second(), second.first);
    EXPECT_EQ(pair.second.second(), second.second);
  }
}

// So both of an edge's triangles compute one curve, whichever of its ends they begin at.
TEST_F(VecPairs, HaveTheSameHandlesFromBothEnds) {
  for (int i = 0; i < 1000; ++i) {
    const EdgeEnds e = edge();
    const EdgeHandles there = smoothHandles(e.p0, e.p1, e.n0, e.n1), back = smoothHandles(e.p1, e.p0, e.n1, e.n0);
    EXPECT_EQ(there.first, back.second);
    EXPECT_EQ(there.second, back.first);
  }
}

TEST_F(VecPairs, HaveTheMiddleNormalOfEachEdgeAloneAlsoWhereTheNormalsCancel) {
  for (int i = 0; i < 1000; ++i) {
    const EdgeEnds a = edge();
    EdgeEnds b = edge();
    if (i % 10 == 0) b.n1 = -b.n0;
    const VecPair pair = sideBySide(a, b, [](const auto&... v) { return middleNormal(v...); });
    EXPECT_EQ(pair.first(), middleNormal(a.p0, a.p1, a.n0, a.n1));
    EXPECT_EQ(pair.second(), middleNormal(b.p0, b.p1, b.n0, b.n1));
  }
}

}  // namespace
}  // namespace pincer::contact
