// weart_messages: the texts between a client and WEART's Middleware (or WEART-App)
// over TCP, as its SDK for C++ 2.0.1 has them:
//
//   out   StartFromClient:SdkLLCPP:2.0.0:TrackType1~   force:0.350000:0.000000:0.000000:RIGHT:INDEX~
//                                                      stopForce:RIGHT:INDEX~   StopFromClient~
//   in    {"type":"MW_STATUS","ts":1,"data":{"status":"RUNNING","actuationsEnabled":true,"connectedDevices":[..]}}~
//         Tracking:..~   and others
//
// A message ends with '~'. The first of a force's three numbers is the level, 0 to 1, at which the plate presses:
// no newtons. Commands aren't answered. Nobody here has met the program or the device: of what comes in only
// MW_STATUS is understood, all else is left alone.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace pincer::devices::weart {

enum class HandSide : std::uint8_t { kRight, kLeft };
enum class Thimble : std::uint8_t { kThumb, kIndex, kMiddle };

// The first and the last message, as the SDK sends them.
inline constexpr std::string_view kStart = "StartFromClient:SdkLLCPP:2.0.0:TrackType1~";
inline constexpr std::string_view kStop = "StopFromClient~";

inline constexpr std::size_t kMostText = 80;  // of a command
using TextBuffer = std::array<char, kMostText>;
// The command in `buffer`. A level outside of 0 .. 1 is the nearer end; one that isn't a number is 0.
std::string_view writeForce(TextBuffer& buffer, double level, HandSide hand, Thimble thimble);
std::string_view writeStopForce(TextBuffer& buffer, HandSide hand, Thimble thimble);

struct MiddlewareStatus {
  bool running = false;
  bool actuates = true;  // false: it says that it passes nothing on to the devices
};
// Absent: the message isn't a status.
std::optional<MiddlewareStatus> readStatus(std::string_view message);

// Cuts what arrives into messages, however it is split or glued. One that is longer
// than kMostMessage is left out, and counted.
class MessageCutter {
 public:
  static constexpr std::size_t kMostMessage = 16384;  // [bytes], chosen; bounds what is kept of a stream without "~"
  // take(message) for each that has ended, without its '~'.
  template <class Take>
  void add(std::string_view bytes, const Take& take) {
    for (const char c : bytes) {
      if (c != '~') {
        if (begun_.size() < kMostMessage)
          begun_ += c;
        else
          is_long_ = true;
        continue;
      }
      if (is_long_)
        ++left_out_;
      else
        take(std::string_view(begun_));
      begun_.clear();
      is_long_ = false;
    }
  }
  std::int64_t leftOut() const { return left_out_; }

 private:
  std::string begun_;
  bool is_long_ = false;
  std::int64_t left_out_ = 0;
};

}  // namespace pincer::devices::weart
