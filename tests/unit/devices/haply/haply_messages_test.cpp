// Texts of Haply's service: the documented ones are read and written as they are; no other bytes do harm.
#include "pincer/devices/haply/haply_messages.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "pincer/tests/unit/devices/haply/haply_texts.h"

namespace pincer::devices::haply {
namespace {

using tests::kHaplyInventory;

std::string with(std::string text, const std::string& old, const std::string& replacement) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), replacement);
}

ReadError errorIn(const std::string& text) {
  ServiceMessage message;
  const ReadError error = readService(text, message);
  EXPECT_TRUE(error == ReadError::kNone || message.count == 0);
  return error;
}

ForceCommand commandOf(const char* id, const Vec3& f_H) { return {.id = *Label::of(id), .f_H = f_H}; }

TEST(HaplyMessages, ReadTheDocumentedInventory) {
  ServiceMessage message;
  ASSERT_EQ(readService(kHaplyInventory, message), ReadError::kNone);
  EXPECT_EQ(message.session, 7);
  ASSERT_EQ(message.count, 2u);
  const DeviceReport& arm = *message.find("049D");
  EXPECT_EQ(arm.family, DeviceFamily::kInverse3);
  EXPECT_EQ(*arm.p_H, Vec3(0, -0.12, 0.15));
  EXPECT_EQ(arm.mode.view(), "idle");
  EXPECT_EQ(arm.in_use, false);
  EXPECT_EQ(arm.power, true);
  EXPECT_FALSE(arm.transformed || arm.config->mounted || arm.q_H);
  EXPECT_EQ(arm.config->preset.view(), "defaults");
  EXPECT_EQ(arm.config->basis.view(), "XYZ");
  EXPECT_EQ(arm.config->damping, 0.0);
  EXPECT_EQ(arm.config->gate_gain, 0.3);
  const DeviceReport& grip = *message.find("1605");
  EXPECT_EQ(grip.family, DeviceFamily::kWirelessGrip);
  EXPECT_TRUE(grip.q_H && grip.awake && !grip.p_H);
  EXPECT_EQ(message.find("1606"), nullptr);
}

TEST(HaplyMessages, WriteTheDocumentedCommands) {
  std::array<char, kMostCommand> buffer{};
  const ForceCommand first{.id = *Label::of("049D"), .configure = true};
  EXPECT_EQ(writeForces(buffer, std::span(&first, 1), ForceSpelling::kVector, "org.pincer:5f3a09c1", true),
            tests::kHaplyFirstMessage);
  const std::array both{commandOf("049D", {0, 0, 1.5}), commandOf("04BA", {-0.2, 0, 0})};
  EXPECT_EQ(writeForces(buffer, both, ForceSpelling::kVector), tests::kHaplyForces);
  EXPECT_NE(writeForces(buffer, both, ForceSpelling::kValues).find(R"("values":{"x":0.0)"), std::string_view::npos);
  EXPECT_EQ(writeForces(buffer, both, ForceSpelling::kValues).find("vector"), std::string_view::npos)
      << "forces of both would add";
}

TEST(HaplyMessages, OfLongIdsAndStrangeForcesFitAndAreSound) {
  std::array<char, kMostCommand> buffer{};
  const std::string long_id(31, 'X');
  ForceCommand worst{
      .id = *Label::of(long_id), .f_H = Vec3(-99.999999, 1e300, NAN), .configure = true, .gate_gain = 0.123456};
  const std::array both{worst, worst};
  const auto text = writeForces(buffer, both, ForceSpelling::kVector, long_id, true);
  const auto tree = nlohmann::json::parse(text);
  const auto& force = tree["inverse3"][1]["commands"]["set_cursor_force"]["vector"];
  EXPECT_EQ(force["x"], -99.999999);
  EXPECT_EQ(force["y"], 0.0) << "beyond what any arm has: zero, never a limit";
  EXPECT_EQ(force["z"], 0.0);
}

TEST(HaplyMessages, ThatAreUnsoundAreRefusedByName) {
  const std::string place = R"("cursor_position":{"x":0.0,"y":-0.12,"z":0.15})";
  EXPECT_EQ(errorIn(with(kHaplyInventory, place, R"("cursor_position":{"x":0.0,"y":-0.12})")),
            ReadError::kMissingComponent);
  EXPECT_EQ(errorIn(with(kHaplyInventory, place, R"("cursor_position":{"x":0.0,"y":"-0.12","z":0.15})")),
            ReadError::kWrongType);
  EXPECT_EQ(errorIn(with(kHaplyInventory, place, R"("cursor_position":{"x":0.0,"y":-0.12,"z":null})")),
            ReadError::kWrongType);
  EXPECT_EQ(errorIn(with(kHaplyInventory, place, R"("cursor_position":[0,0,0])")), ReadError::kWrongType);
  EXPECT_EQ(errorIn(with(kHaplyInventory, place, R"("cursor_position":5)")), ReadError::kWrongType);
  EXPECT_EQ(errorIn(with(kHaplyInventory, place, R"("cursor_position":{"x":0.0,"x":0.0,"y":-0.12,"z":0.15})")),
            ReadError::kTwice);
  EXPECT_EQ(errorIn(with(kHaplyInventory, place, R"("cursor_position":{"x":2.01,"y":-0.12,"z":0.15})")),
            ReadError::kOutOfRange);
  for (const char* number : {"NaN", "Infinity", "1e999", "-1e999", "01", "0x1", "+1"}) {
    EXPECT_EQ(errorIn(with(kHaplyInventory, "-0.12", number)), ReadError::kNotJson) << number;
  }
  EXPECT_EQ(errorIn(with(kHaplyInventory, R"("cursor_velocity":{"x":0)", R"("cursor_velocity":{"x":20.1)")),
            ReadError::kOutOfRange);
  EXPECT_EQ(errorIn(with(kHaplyInventory, R"("orientation":{"w":1)", R"("orientation":{"w":0.98)")),
            ReadError::kOutOfRange);
  EXPECT_EQ(errorIn(with(kHaplyInventory, "1605", "049D")), ReadError::kTwice) << "an id of two devices";
  EXPECT_EQ(errorIn(with(kHaplyInventory, R"("verse_grip":[])", R"("inverse3":[])")), ReadError::kTwice);
  EXPECT_EQ(errorIn(with(kHaplyInventory, R"("device_id":"049D",)", "")), ReadError::kNoId);
  EXPECT_EQ(errorIn(with(kHaplyInventory, R"("device_id":"049D")", R"("device_id":"04\"9D")")), ReadError::kWrongType);
  EXPECT_EQ(errorIn(with(kHaplyInventory, "COM12", "COM\xff")), ReadError::kNotJson) << "not UTF-8";
  EXPECT_EQ(errorIn(with(kHaplyInventory, "true}", "true")), ReadError::kNotJson);
  EXPECT_EQ(errorIn(kHaplyInventory + "{}"), ReadError::kNotJson) << "something behind it";
  EXPECT_EQ(errorIn(R"({"inverse3":{"049D":{}}})"), ReadError::kWrongType) << "devices by id: the service before 3.1";
  EXPECT_EQ(errorIn(R"({"inverse3":[[{}]]})"), ReadError::kWrongType);
  EXPECT_EQ(errorIn(R"({"inverse3":[5]})"), ReadError::kWrongType);
  EXPECT_EQ(errorIn(R"({"ok":true})"), ReadError::kNotJson) << "no state at all";
  EXPECT_EQ(errorIn(R"({"inverse3":[{"device_id":"1","a":{"a":{"a":{"a":{"a":{"a":{}}}}}}}]})"), ReadError::kNotJson)
      << "too deep";
  EXPECT_EQ(errorIn(std::string(kMostMessage + 1, ' ')), ReadError::kTooLong);
  std::string many = R"({"inverse3":[{"device_id":"0"})";
  for (int i = 1; i <= 16; ++i) many += R"(,{"device_id":")" + std::to_string(i) + "\"}";
  EXPECT_EQ(errorIn(many + "]}"), ReadError::kTooManyDevices);
}

TEST(HaplyMessages, LeaveUnknownKeysAloneAndTellAbsentFromZero) {
  ServiceMessage message;
  ASSERT_EQ(readService(R"({"new":[[1],{"x":[2]}],"inverse3":[{"device_id":"A","state":{"new":[{"cursor_position":3}],)"
                        R"("state.cursor_position.x":9,"":{"x":1}},"status":{}}],"other":null})",
                        message),
            ReadError::kNone);
  EXPECT_FALSE(message.devices[0].p_H || message.devices[0].v_H || message.devices[0].calibrated ||
               message.devices[0].config);
}

TEST(HaplyMessages, KnowAMountAndATransformThatAreNotTheIdentity) {
  ServiceMessage message;
  ASSERT_EQ(
      readService(with(kHaplyInventory, R"("transform":{})", R"("transform":{"scale":{"x":1,"y":1,"z":2}})"), message),
      ReadError::kNone);
  EXPECT_TRUE(message.devices[0].transformed);
  ASSERT_EQ(
      readService(with(kHaplyInventory, R"("transform":{})", R"("transform":{"rotation":{"w":1,"x":0,"y":0,"z":0}})"),
                  message),
      ReadError::kNone);
  EXPECT_FALSE(message.devices[0].transformed);
  ASSERT_EQ(
      readService(with(kHaplyInventory, R"("mount":{"position":{"x":0)", R"("mount":{"position":{"x":0.1)"), message),
      ReadError::kNone);
  EXPECT_TRUE(message.devices[0].config->mounted);
}

TEST(HaplyMessages, TakeAGripOfFourZerosAsOneWithoutOrientation) {
  ServiceMessage message;
  ASSERT_EQ(readService(with(kHaplyInventory, R"("orientation":{"w":1)", R"("orientation":{"w":0)"), message),
            ReadError::kNone);
  EXPECT_FALSE(message.find("1605")->q_H);
}

TEST(HaplyEvents, AreRead) {
  ServiceEvent event;
  ASSERT_EQ(readEvent(tests::kHaplySafetyEvent, event), ReadError::kNone);
  EXPECT_EQ(event.name.view(), "device-safety-triggered");
  EXPECT_EQ(event.level, EventLevel::kWarning);
  EXPECT_EQ(event.device->view(), "049D");
  EXPECT_EQ(event.safety.view(), "fod_stage_changed");
  EXPECT_STREQ(event.words.data(), "FOD stage changed: guard -> hard");
  ASSERT_EQ(readEvent(R"({"name":"x","level":"unheard-of"})", event), ReadError::kNone);
  EXPECT_EQ(event.level, EventLevel::kError) << "a level that isn't known counts as an error's";
  EXPECT_NE(readEvent(R"({"name":"x"})", event), ReadError::kNone);
  EXPECT_NE(readEvent(R"({"name":5,"level":"info"})", event), ReadError::kNone);
  EXPECT_NE(readEvent("", event), ReadError::kNone);
}

TEST(HaplyHttp, AnswersAreTakenBareAndInData) {
  for (const char* body : {R"("3.5.1")", "3.5.1\n", R"({"ok":true,"data":"3.5.1"})",
                           R"({"ok":true,"data":{"version":"v3.5.1","ok":1}})", R"({"version":"3.5.1"})"}) {
    const auto version = readVersion(body);
    ASSERT_TRUE(version) << body;
    EXPECT_TRUE(version->major == 3 && version->minor == 5) << body;
  }
  for (const char* body :
       {"", "{}", R"({"ok":false,"error":"3.5"})", R"({"ok":false,"data":"3.5"})", "<html>", "99999999999.5"}) {
    EXPECT_FALSE(readVersion(body)) << body;
  }
  EXPECT_EQ(readNumber("1"), 1.0);
  EXPECT_EQ(readNumber(R"({"ok":true,"data":0.5})"), 0.5);
  EXPECT_EQ(readNumber(R"({"ok":true,"data":{"force_scale":1.0}})"), 1.0);
  EXPECT_FALSE(readNumber(R"({"a":1,"b":2})")) << "which of the two is it?";
  EXPECT_FALSE(readNumber(R"({"ok":false,"error":"no"})"));
}

TEST(HaplyHttp, TellsTheDevicesThatAreThere) {
  const DeviceIds ids = readDeviceIds(
      R"({"ok":true,"data":[{"device_id":"049D","type":"inverse3"},{"device_id":5},{"device_id":"1605"}]})");
  ASSERT_EQ(ids.count, 2u);
  EXPECT_EQ(ids.ids[1].view(), "1605");
  EXPECT_EQ(readDeviceIds("[").count, 0u);
}

// The tree of the same library is the oracle: whatever is accepted is JSON, and its numbers are finite.
RC_GTEST_PROP(HaplyMessages, OfMutatedBytesAreRefusedOrSound, ()) {
  std::string text = kHaplyInventory;
  const int changes = *rc::gen::inRange(1, 8);
  for (int i = 0; i < changes; ++i) {
    const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
    switch (*rc::gen::inRange(0, 3)) {
      case 0:
        text[at] = *rc::gen::arbitrary<char>();
        break;
      case 1:
        text.insert(
            at, *rc::gen::elementOf(std::vector<std::string>{"{", "}", "[", "]", "\"", ",", "9", "e9", "null", ":1,"}));
        break;
      default:
        text.erase(at, *rc::gen::inRange<std::size_t>(1, 40));
    }
    if (text.empty()) text = "x";
  }
  ServiceMessage message;
  const ReadError error = readService(text, message);
  RC_ASSERT(error == ReadError::kNone || message.count == 0u);
  if (error == ReadError::kNone) RC_ASSERT(nlohmann::json::accept(text));
  for (std::size_t i = 0; i < message.count; ++i) {
    const DeviceReport& device = message.devices[i];
    RC_ASSERT(!device.p_H || device.p_H->allFinite());
    RC_ASSERT(!device.q_H || std::abs(device.q_H->norm() - 1) < 1e-9);
  }
  ServiceEvent event;
  readEvent(text, event);
  readVersion(text);
  readNumber(text);
}

}  // namespace
}  // namespace pincer::devices::haply
