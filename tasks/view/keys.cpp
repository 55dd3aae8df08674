#include "pincer/tasks/view/keys.h"

#include <fmt/format.h>

#include <array>

namespace pincer::tasks {
namespace {

using devices::Key;

// Keys in groups, in the order in which the help shows them.
constexpr std::array kProgramKeys = {
    KeyBinding{Key::kKeyF1, "F1", ViewAction::kHelp, "this help"},
    KeyBinding{Key::kKeyF2, "F2", ViewAction::kTiming, "health: timing of the servo, state of the devices"},
    KeyBinding{Key::kKeyF5, "F5", ViewAction::kFullScreen, "full screen"},
    KeyBinding{Key::kKeyTab, "Tab", ViewAction::kOverlay, "panels and charts"},
    KeyBinding{'P', "P", ViewAction::kScreenshot, "screenshot: a PNG in the current folder"},
    KeyBinding{'V', "V", ViewAction::kSequence, "begin or end a sequence of PNGs, one per picture"},
    KeyBinding{Key::kKeyEscape, "Esc", ViewAction::kQuit, "close"},
};
constexpr std::array kTimeKeys = {
    KeyBinding{' ', "Space", ViewAction::kPause, "pause, go on"},
    KeyBinding{Key::kKeyRight, "Right", ViewAction::kTickForward, "while paused: one tick on"},
    KeyBinding{Key::kKeyLeft, "Left", ViewAction::kTickBack, "while paused: one picture back"},
    KeyBinding{Key::kKeyHome, "Home", ViewAction::kScrubBack, "while paused: a second back in what was seen"},
    KeyBinding{Key::kKeyEnd, "End", ViewAction::kScrubForward, "while paused: a second on"},
    KeyBinding{Key::kKeyBackspace, "Backspace", ViewAction::kLive, "to the present; to the end of a recording"},
    KeyBinding{'R', "R", ViewAction::kRestart, "again, from the beginning of what was seen"},
    KeyBinding{'L', "L", ViewAction::kLoop, "over and over, or no longer"},
    KeyBinding{'-', "-", ViewAction::kSlower, "half as fast, down to 1/256"},
    KeyBinding{'=', "=", ViewAction::kFaster, "twice as fast; up to 8 times, fingers that you move to real time"},
};
constexpr std::array kSceneKeys = {
    KeyBinding{'C', "C", ViewAction::kContacts, "contact points and normals"},
    KeyBinding{'F', "F", ViewAction::kForces, "contact forces"},
    KeyBinding{'K', "K", ViewAction::kCones, "friction cones"},
    KeyBinding{'J', "J", ViewAction::kJoints, "joints: axes, stops, drives' forces"},
    KeyBinding{'D', "D", ViewAction::kDevices, "where the devices are"},
    KeyBinding{'I', "I", ViewAction::kPads, "fingerpads"},
    KeyBinding{'W', "W", ViewAction::kEdges, "wireframe: the edges of a mesh's triangles"},
    KeyBinding{'M', "M", ViewAction::kFacets, "meshes as their flat triangles, or as the smooth surface"},
    KeyBinding{'T', "T", ViewAction::kTransparent, "transparent bodies"},
    KeyBinding{'S', "S", ViewAction::kShadows, "shadows"},
    KeyBinding{'B', "B", ViewAction::kBodies, "list of what moves: place, speed, contacts"},
    KeyBinding{'N', "N", ViewAction::kNextBody, "select the next body; a click selects what is under the pointer"},
    KeyBinding{'A', "A", ViewAction::kCamera, "look at everything again"},
};
constexpr std::array kChartKeys = {
    KeyBinding{'1', "1", ViewAction::kChart1, "force of each finger"},
    KeyBinding{'2', "2", ViewAction::kChart2, "height of the selected body"},
    KeyBinding{'3', "3", ViewAction::kChart3, "time that a tick took"},
    KeyBinding{'4', "4", ViewAction::kChart4, "the body's speed"},
    KeyBinding{'5', "5", ViewAction::kChart5, "its turn since the start"},
    KeyBinding{'6', "6", ViewAction::kChart6, "its place: x, y, z"},
    KeyBinding{'7', "7", ViewAction::kChart7, "forces of its contacts, added up"},
    KeyBinding{'8', "8", ViewAction::kChart8, "share of friction that each finger uses: 1 slips"},
};
constexpr std::array kHandKeys = {
    KeyBinding{'G', "G", ViewAction::kSqueeze, "squeeze, let go"},
    KeyBinding{Key::kKeyLeft, "Left", ViewAction::kHandLeft, "fingers to the left"},
    KeyBinding{Key::kKeyRight, "Right", ViewAction::kHandRight, "fingers to the right"},
    KeyBinding{Key::kKeyUp, "Up", ViewAction::kHandUp, "fingers up"},
    KeyBinding{Key::kKeyDown, "Down", ViewAction::kHandDown, "fingers down"},
    KeyBinding{Key::kKeyPageUp, "Page up", ViewAction::kHandAway, "fingers away from you"},
    KeyBinding{Key::kKeyPageDown, "Page down", ViewAction::kHandNear, "fingers towards you"},
    KeyBinding{'Q', "Q", ViewAction::kTurnLeft, "turn the hand to the left"},
    KeyBinding{'E', "E", ViewAction::kTurnRight, "turn it to the right"},
    KeyBinding{',', ",", ViewAction::kGripLess, "weaker grip"},
    KeyBinding{'.', ".", ViewAction::kGripMore, "stronger grip"},
};
// Groups of keys with their headings in the help.
constexpr std::array kGroups = {
    KeyGroup{"Program", kProgramKeys},
    KeyGroup{"Time", kTimeKeys},
    KeyGroup{"Scene", kSceneKeys},
    KeyGroup{"Charts, shown or no longer; the pointer on one reads it", kChartKeys},
    KeyGroup{"Fingers, with --devices mouse", kHandKeys},
};
// Gestures of the mouse, with no finger led by it and with one.
constexpr std::array kCameraGestures = {
    MouseGesture{"left button, drag", "turn the camera"},
    MouseGesture{"right button, drag", "move the camera"},
    MouseGesture{"wheel", "nearer, further"},
    MouseGesture{"left button, click", "select a body: the list tells of it, charts follow it"},
    MouseGesture{"Control, left button, drag", "pull a body of a scene by a spring"},
    MouseGesture{"bar below, drag", "to another time"},
};
constexpr std::array kHandGestures = {
    MouseGesture{"move", "fingers left, right, up, down"},
    MouseGesture{"Shift, move", "fingers left, right, away, near"},
    MouseGesture{"Control, move", "turn the hand"},
    MouseGesture{"left button", "squeeze as long as it is held"},
    MouseGesture{"wheel", "stronger or weaker grip"},
    MouseGesture{"right button, drag", "turn the camera"},
    MouseGesture{"Control, wheel", "nearer, further"},
};

std::optional<ViewAction> actionIn(std::span<const KeyBinding> keys, int code) {
  for (const KeyBinding& key : keys) {
    if (key.code == code) return key.action;
  }
  return {};
}

std::string gesturesMarkdown(const char* title, std::span<const MouseGesture> gestures) {
  std::string text = fmt::format("\n## {}\n\n| mouse | |\n|---|---|\n", title);
  for (const MouseGesture& gesture : gestures) text += fmt::format("| {} | {} |\n", gesture.name, gesture.effect);
  return text;
}

}  // namespace

std::span<const KeyGroup> keyGroups() { return kGroups; }
std::span<const MouseGesture> cameraGestures() { return kCameraGestures; }
std::span<const MouseGesture> handGestures() { return kHandGestures; }

std::optional<ViewAction> actionOf(int key, bool hands) {
  if (const auto action = actionIn(kHandKeys, key); hands && action) return action;
  for (const KeyGroup& group : std::span(kGroups).first(kGroups.size() - 1)) {
    if (const auto action = actionIn(group.keys, key)) return action;
  }
  return {};
}

bool toggle(ViewAction action, ViewChoice& choice) {
  struct Switch {
    ViewAction action;
    bool ViewChoice::*shown;
  };
  // Actions that turn a choice on and off.
  constexpr std::array kSwitches = {
      Switch{ViewAction::kHelp, &ViewChoice::help},       Switch{ViewAction::kTiming, &ViewChoice::timing},
      Switch{ViewAction::kOverlay, &ViewChoice::overlay}, Switch{ViewAction::kContacts, &ViewChoice::contacts},
      Switch{ViewAction::kForces, &ViewChoice::forces},   Switch{ViewAction::kCones, &ViewChoice::cones},
      Switch{ViewAction::kJoints, &ViewChoice::joints},   Switch{ViewAction::kDevices, &ViewChoice::devices},
      Switch{ViewAction::kPads, &ViewChoice::pads},       Switch{ViewAction::kBodies, &ViewChoice::bodies},
      Switch{ViewAction::kEdges, &ViewChoice::edges},     Switch{ViewAction::kFacets, &ViewChoice::facets},
      Switch{ViewAction::kShadows, &ViewChoice::shadows}, Switch{ViewAction::kTransparent, &ViewChoice::transparent},
  };
  for (const Switch& at : kSwitches) {
    if (at.action != action) continue;
    choice.*at.shown = !(choice.*at.shown);
    return true;
  }
  return false;
}

std::string keysMarkdown() {
  std::string text =
      "# Keys of the viewer\n\nWhat `pincer keys` prints: the table that the viewer itself reads "
      "(`tasks/view/keys.cpp`); F1 shows it "
      "there.\n"
      "`--no-keys` leaves Esc only.\n";
  for (const KeyGroup& group : kGroups) {
    text += fmt::format("\n## {}\n\n| key | |\n|---|---|\n", group.title);
    for (const KeyBinding& key : group.keys) text += fmt::format("| {} | {} |\n", key.name, key.effect);
  }
  text += gesturesMarkdown("Mouse: camera", kCameraGestures);
  return text + gesturesMarkdown("Mouse: fingers, with --devices mouse", kHandGestures);
}

}  // namespace pincer::tasks
