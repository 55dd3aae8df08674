#include "pincer/contact/curve/polyline.h"

#include <gtest/gtest.h>

#include <limits>

#include "pincer/contact/error.h"

namespace pincer::contact {
namespace {

std::string refusal(const Polyline& polyline, double largest_turn = 1.5) {
  try {
    requireSound(polyline, largest_turn, 3.1);
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

TEST(Polyline, IsRefusedWithTheVertexAndTheRemedy) {
  EXPECT_EQ(refusal({{{0, 0}}, false}), "polyline: 1 vertices, needed are at least 2.");
  EXPECT_EQ(refusal({{{0, 0}, {1, 0}}, true}), "polyline: 2 vertices, needed are at least 3.");
  EXPECT_EQ(refusal({{{0, 0}, {1, 0}, {1, 0}}, false}),
            "polyline: vertex 1 is an end of an open path, which has no corner there. Name it once.");
  EXPECT_EQ(refusal({{{0, 0}, {1, 0}, {1, 0}, {1, 0}, {1, 1}}, false}),
            "polyline: vertices 1 and 3 are at the same place. Name it once, or twice in a row for a sharp corner.");
  EXPECT_EQ(refusal({{{0, 0}, {1, 0}, {1, 1}, {0, 0}}, true}, 3.1),
            "polyline: vertices 3 and 0 are at the same place. Name it once, or twice in a row for a sharp corner.");
  EXPECT_EQ(refusal({{{0, 0}, {std::numeric_limits<double>::quiet_NaN(), 0}}, false}),
            "polyline: vertex 1 isn't finite.");
  EXPECT_EQ(refusal({{{0, 0}, {1, 0}, {1, 1}}, false}),
            "polyline: the path turns by 90.0 degrees at vertex 1, allowed is less than 86. Add vertices there, name "
            "it twice (a sharp corner), "
            "or use the variant facet.");
  EXPECT_EQ(refusal({{{0, 0}, {1, 0}, {1, 1}}, false}, 1.6), "");
}

// Two degrees on 52 degrees of a 100 mm circle: 26 segments, each 2 R sin(1 degree) long.
TEST(ArcPolygon, LiesOnItsCircleWithEqualTurns) {
  const double turn = 2 * M_PI / 180;
  const Polyline arc = arcPolygon(0.1, turn, 26 * turn);
  ASSERT_EQ(arc.vertices.size(), 27u);
  EXPECT_FALSE(arc.is_closed);
  for (std::size_t i = 0; i + 1 < arc.vertices.size(); ++i) {
    EXPECT_NEAR(arc.vertices[i].norm(), 0.1, 1e-16);
    EXPECT_NEAR((arc.vertices[i + 1] - arc.vertices[i]).norm(), 0.2 * std::sin(turn / 2), 1e-16);
    EXPECT_LT(arc.vertices[i + 1].x(), arc.vertices[i].x()) << "counter-clockwise over the top";
  }
  EXPECT_NEAR(arc.vertices.front().x(), -arc.vertices.back().x(), 1e-16) << "symmetric about +y";
  EXPECT_EQ(arcPolygon(0.1, turn, 26.5 * turn).vertices.size(), 28u) << "covers the sweep";
}

TEST(ArcPolygon, NamesTheRangeOfWhatItRefuses) {
  EXPECT_THROW(arcPolygon(0, 0.1, 1), InputError);
  EXPECT_THROW(arcPolygon(1, 0, 1), InputError);
  EXPECT_THROW(arcPolygon(1, 0.1, 7), InputError);
  EXPECT_THROW(arcPolygon(1, 0.1, 0.05), InputError);
  EXPECT_THROW(arcPolygon(1, 1e-9, 1), InputError);
}

}  // namespace
}  // namespace pincer::contact
