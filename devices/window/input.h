// input: what a person does with mouse and keyboard, as a window (or a test) reports it.
#pragma once
#include <cstdint>

namespace pincer::devices {

enum class InputKind : std::uint8_t { kKey, kButton, kMove, kWheel };

// Keys are their character in upper case ('A', '1', ' ', '-'); the others have these numbers.
enum Key : int {
  kKeyEscape = 256,
  kKeyEnter = 257,
  kKeyTab = 258,
  kKeyBackspace = 259,
  kKeyRight = 262,
  kKeyLeft = 263,
  kKeyDown = 264,
  kKeyUp = 265,
  kKeyPageUp = 266,
  kKeyPageDown = 267,
  kKeyHome = 268,
  kKeyEnd = 269,
  kKeyF1 = 290,
  kKeyF2 = 291,
  kKeyF3 = 292,
  kKeyF4 = 293,
  kKeyF5 = 294,
  kKeyShift = 340,
  kKeyControl = 341,
};

enum Button : int { kButtonLeft = 0, kButtonRight = 1, kButtonMiddle = 2 };

struct Modifiers {
  bool shift = false, control = false;
};

struct InputEvent {
  InputKind kind = InputKind::kMove;
  int code = 0;       // a key or a button
  bool down = false;  // of a key or a button: pressed (a key that repeats is pressed again), else released
  // kMove and kButton: where, from the upper left corner, y down [pixels]; kWheel: notches, y away from the person
  double x = 0, y = 0;
  Modifiers modifiers = {};
};

}  // namespace pincer::devices
