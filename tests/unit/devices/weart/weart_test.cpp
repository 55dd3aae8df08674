// WEART's TouchDIVER over the emulated Middleware: texts as its SDK has them;
// pressure comes, and ends whatever happens.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "pincer/devices/emulate/weart_middleware.h"
#include "pincer/devices/weart/weart_host.h"
#include "pincer/devices/weart/weart_messages.h"

namespace pincer::devices::weart {
namespace {

using emulate::WeartFault;
using emulate::WeartMiddleware;

// Until it is true, a time that no busy machine needs.
bool comesTrue(const std::function<bool()>& condition) {
  for (int i = 0; i < 10000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return condition();
}

WeartOptions handAt(const WeartMiddleware& middleware) {
  WeartOptions options;
  options.port = middleware.port();
  return options;
}

// Presses as a tick does, until `condition`.
bool pressUntil(WeartHost& host, double force, const std::function<bool()>& condition) {
  return comesTrue([&] {
    host.display(0).press(force);
    return condition();
  });
}

TEST(WeartMessages, AreThoseOfTheSdk) {
  TextBuffer buffer;
  EXPECT_EQ(writeForce(buffer, 0.35, HandSide::kRight, Thimble::kIndex),
            "force:0.350000:0.000000:0.000000:RIGHT:INDEX~");
  EXPECT_EQ(writeStopForce(buffer, HandSide::kRight, Thimble::kIndex), "stopForce:RIGHT:INDEX~");
  EXPECT_EQ(writeForce(buffer, 7, HandSide::kLeft, Thimble::kMiddle), "force:1.000000:0.000000:0.000000:LEFT:MIDDLE~");
  for (const double none : {-1.0, 0.0, std::nan(""), -HUGE_VAL})
    EXPECT_EQ(writeForce(buffer, none, HandSide::kLeft, Thimble::kThumb),
              "force:0.000000:0.000000:0.000000:LEFT:THUMB~");
}

TEST(WeartMessages, TellOfTheMiddlewareOnlyByItsStatus) {
  const auto status = readStatus(
      R"({"type":"MW_STATUS","ts":1,"data":{"status":"RUNNING","actuationsEnabled":false,"connectedDevices":[]}})");
  ASSERT_TRUE(status);
  EXPECT_TRUE(status->running);
  EXPECT_FALSE(status->actuates);
  EXPECT_FALSE(readStatus(R"({"type":"MW_STATUS","ts":1,"data":{"status":"IDLE"}})")->running);
  for (const char* other : {"", "Tracking:1:2", R"({"type":"DEVICES_STATUS","data":{"status":"RUNNING"}})",
                            R"({"type":"MW_STATUS")", "[]", "\xff"})
    EXPECT_FALSE(readStatus(other)) << other;
}

TEST(WeartMessages, AreCutHoweverTheyArrive) {
  const std::string all = "a~~bc~" + std::string(MessageCutter::kMostMessage + 1, 'x') + "~d~e";
  for (const std::size_t piece : {std::size_t{1}, std::size_t{3}, all.size()}) {
    MessageCutter cutter;
    std::vector<std::string> messages;
    for (std::size_t at = 0; at < all.size(); at += piece)
      cutter.add(std::string_view(all).substr(at, piece), [&](std::string_view m) { messages.emplace_back(m); });
    EXPECT_EQ(messages, (std::vector<std::string>{"a", "", "bc", "d"})) << piece;
    EXPECT_EQ(cutter.leftOut(), 1);
  }
}

TEST(WeartHost, PressesAsTheForceSaysAndStopsWhenItEnds) {
  WeartMiddleware middleware;
  {
    WeartHost host(handAt(middleware));
    EXPECT_TRUE(middleware.started());
    EXPECT_TRUE(pressUntil(host, 2.5, [&] { return middleware.level("RIGHT:INDEX") == 0.5; }));
    EXPECT_TRUE(pressUntil(host, 50, [&] { return middleware.level("RIGHT:INDEX") == 1; }));
    EXPECT_EQ(middleware.level("RIGHT:THUMB"), 0);
    EXPECT_TRUE(comesTrue([&] { return middleware.level("RIGHT:INDEX") == 0; })) << "nobody ticks any more";
    EXPECT_TRUE(pressUntil(host, 2.5, [&] { return middleware.level("RIGHT:INDEX") == 0.5; }));
    EXPECT_TRUE(pressUntil(host, std::nan(""), [&] { return middleware.level("RIGHT:INDEX") == 0; }));
    EXPECT_TRUE(pressUntil(host, 2.5, [&] { return middleware.level("RIGHT:INDEX") == 0.5; }));
  }
  EXPECT_TRUE(comesTrue([&] { return middleware.level("RIGHT:INDEX") == 0 && !middleware.started(); }));
  EXPECT_EQ(middleware.unknown(), 0);
}

TEST(WeartHost, UnderstandsWhatComesSplitGluedOverlongOrUnknown) {
  for (const WeartFault fault : {WeartFault::kPieces, WeartFault::kGlued, WeartFault::kOverlong}) {
    WeartMiddleware middleware;
    middleware.setFault(fault);
    WeartHost host(handAt(middleware));
    EXPECT_TRUE(pressUntil(host, 2.5, [&] { return middleware.level("RIGHT:INDEX") == 0.5; }))
        << static_cast<int>(fault) << host.complaint();
    EXPECT_EQ(host.complaint(), "");
  }
}

TEST(WeartHost, PressesNothingOnceTheMiddlewareStopsAndNeverAgain) {
  for (const WeartFault fault : {WeartFault::kStops, WeartFault::kPassesNothingOn, WeartFault::kHangsUp}) {
    WeartMiddleware middleware;
    WeartHost host(handAt(middleware));
    ASSERT_TRUE(pressUntil(host, 2.5, [&] { return middleware.level("RIGHT:INDEX") == 0.5; }));
    middleware.setFault(fault);
    EXPECT_TRUE(pressUntil(host, 2.5, [&] {
      return middleware.level("RIGHT:INDEX") == 0 && !host.complaint().empty();
    })) << static_cast<int>(fault);
    EXPECT_EQ(host.display(0).state(), DeviceState::kFaulted);
    middleware.setFault(WeartFault::kNone);
    const std::int64_t commands = middleware.commands();
    for (int i = 0; i < 200; ++i) host.display(0).press(2.5), std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(middleware.level("RIGHT:INDEX"), 0) << "only a new session presses again";
    EXPECT_LE(middleware.commands() - commands, 2);
  }
}

TEST(WeartHost, NamesWhyItDoesNotBegin) {
  const auto refusal = [](const WeartOptions& options) -> std::string {
    try {
      const WeartHost host(options);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  WeartOptions options;
  options.timeout = 0.3;
  {
    WeartMiddleware middleware;
    middleware.setFault(WeartFault::kNotRunning);
    options.port = middleware.port();
    EXPECT_NE(refusal(options).find("connected and calibrated"), std::string::npos) << refusal(options);
  }
  EXPECT_NE(refusal(options).find("--pressure"), std::string::npos) << "nobody is there: " << refusal(options);
  options.host = "no.such.host.invalid";
  EXPECT_NE(refusal(options).find("no.such.host.invalid"), std::string::npos);
  options.full_force = 0;
  EXPECT_NE(refusal(options).find("above 0"), std::string::npos);
}

}  // namespace
}  // namespace pincer::devices::weart
