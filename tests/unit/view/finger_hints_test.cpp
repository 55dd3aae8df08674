#include <gtest/gtest.h>

#include <string>

#include "pincer/tasks/view/finger_view.h"

namespace pincer::tasks {
namespace {

struct Told {
  FingerTrialSetup asked{.target = 2e-3, .tolerance = 0.25e-3, .texts = {.feel = "Feel", .question = ""}};
  FingerTold told{.instruction = "", .stage = "first", .shows_pad = true, .target = 2e-3};
  FingerSnapshot finger;

  Told() {
    finger.touching = true;
    finger.tactor_L = Vec2(2e-3, 0);
  }

  std::string hint() {
    if (feels) told.instruction = asked.texts.feel.c_str();
    return fingerHint(asked, told, finger);
  }
  bool feels = true;
};

TEST(FingerHint, TellsWhereTheRingIsFromTheDot) {
  Told told;
  EXPECT_EQ(told.hint(), "There: hold still and press Enter");
  told.finger.tactor_L = Vec2(2.3e-3, 0);
  EXPECT_EQ(told.hint().substr(0, 26), "The dot is above the ring:");
  told.finger.tactor_L = Vec2(-3e-3, 0);
  EXPECT_EQ(told.hint().substr(0, 26), "The dot is below the ring:");
  told.told.target.reset();  // in the second interval nothing tells the place
  EXPECT_EQ(told.hint(), "");
}

// "Raise the finger" had "In the air: lower the finger until it touches" below it, and a finger that touched, too.
TEST(FingerHint, NeverContradictsTheInstruction) {
  Told told;
  told.finger.touching = false;
  EXPECT_EQ(told.hint(), "In the air: lower the finger until it touches");
  told.feels = false;
  told.told.instruction = "Raise the finger";
  EXPECT_EQ(told.hint(), "");
  told.feels = true;
  told.told.stage = "answer";
  EXPECT_EQ(told.hint(), "");
}

}  // namespace
}  // namespace pincer::tasks
