#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "pincer/tasks/lab/experiments/pickup_object.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

// A cube of edge 30 in the file's units, its corner at the origin; `without_top`: open.
std::string cubeObj(bool without_top = false) {
  std::string obj;
  for (const char* corner : {"0 0 0", "30 0 0", "30 30 0", "0 30 0", "0 0 30", "30 0 30", "30 30 30", "0 30 30"}) {
    obj += "v " + std::string(corner) + "\n";
  }
  obj += "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  return without_top ? obj : obj + "f 5 6 7 8\n";
}

struct PickupObjectFile : ::testing::Test {
  tests::TemporaryDirectory directory;
  SpherePickupOptions options;

  void write(const std::string& text, const std::string& units) {
    options.object = ObjectFile{directory / "object.obj", units};
    std::ofstream(options.object->path) << text;
  }
  std::string refusal() const {
    try {
      makePickupObject(options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
};

TEST(PickupObject, IsASphereAtTheBottomOfTheDishByDefault) {
  const PickupObject object = makePickupObject({});
  EXPECT_EQ(object.place_W, Vec3(0, 0, 0.02));
  EXPECT_EQ(object.half_width, 0.02);
  EXPECT_EQ(object.asymmetry, 0);
}

// A cube of edge a rests on its four lower corners, a/sqrt 2 from the axis: its
// centre is at a/2 + D - sqrt(D^2 - a^2/2).
TEST_F(PickupObjectFile, SettlesInTheDishAndIsMeasuredOnThePinchLine) {
  write(cubeObj(), "mm");
  const PickupObject object = makePickupObject(options);
  const double a = 0.030, dish = options.dish_radius;
  // rests within the solver's capped correction
  EXPECT_NEAR(object.place_W.z(), a / 2 + dish - std::sqrt(dish * dish - a * a / 2), 1e-5);
  EXPECT_NEAR(object.half_width, a / 2, 1e-4);
  EXPECT_LT(object.asymmetry, 1e-4);
  EXPECT_LT(object.antipodal_angle, 0.01);
}

TEST_F(PickupObjectFile, MustBeClosed) {
  write(cubeObj(true), "mm");
  EXPECT_NE(refusal().find("object.obj"), std::string::npos) << refusal();
}

TEST_F(PickupObjectFile, MustFitAHand) {
  write(cubeObj(), "cm");
  EXPECT_NE(refusal().find("0.3 m long"), std::string::npos) << refusal();
  EXPECT_NE(refusal().find("--size 0.06"), std::string::npos) << refusal();
}

// Whatever the file's unit, its largest dimension becomes the size: the same object as in millimetres.
TEST_F(PickupObjectFile, IsScaledToItsSize) {
  write(cubeObj(), "mm");
  const PickupObject in_mm = makePickupObject(options);
  options.object->units = "in";
  options.object->size = 0.030;
  const PickupObject sized = makePickupObject(options);
  // settling amplifies the round-off of the scale, by far less than this
  EXPECT_NEAR(sized.half_width, in_mm.half_width, 1e-9);
  EXPECT_NEAR(sized.place_W.z(), in_mm.place_W.z(), 1e-9);
}

TEST_F(PickupObjectFile, MustHaveASizeInRange) {
  write(cubeObj(), "mm");
  for (const double size : {0.0, 0.004, 0.21, -1.0, std::nan("")}) {
    options.object->size = size;
    EXPECT_NE(refusal().find("size"), std::string::npos) << refusal();
    EXPECT_NE(refusal().find("[0.005, 0.2]"), std::string::npos) << refusal();
  }
}

TEST_F(PickupObjectFile, MustNotBeTooWideForTheGrip) {
  write(cubeObj(), "mm");
  options.object->size = 0.12;  // an edge of the cube, along the pinch line
  EXPECT_NE(refusal().find("0.12 m wide"), std::string::npos) << refusal();
}

TEST_F(PickupObjectFile, MustExistInAKnownUnit) {
  options.object = ObjectFile{directory / "missing.obj", "mm"};
  EXPECT_NE(refusal().find("missing.obj"), std::string::npos) << refusal();
  write(cubeObj(), "furlong");
  EXPECT_NE(refusal().find("furlong"), std::string::npos) << refusal();
}

}  // namespace
}  // namespace pincer::tasks
