// keys: what the viewer's keys and mouse do: one table, from which the viewer reads them, the help overlay and
// docs/keys.md are made (`pincer keys`). Keys are those of MuJoCo's viewer wherever it has one for the purpose.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "pincer/tasks/view/scene_drawing.h"

namespace pincer::tasks {

enum class ViewAction : std::uint8_t {
  kHelp,
  kTiming,
  kFullScreen,
  kPause,
  kTickForward,
  kTickBack,
  kSlower,
  kFaster,
  kScrubBack,
  kScrubForward,
  kLive,
  kRestart,
  kLoop,
  kContacts,
  kForces,
  kCones,
  kJoints,
  kDevices,
  kEdges,
  kFacets,
  kTransparent,
  kShadows,
  kOverlay,
  kPads,
  kBodies,
  kNextBody,
  kChart1,  // and the next seven, in their order
  kChart2,
  kChart3,
  kChart4,
  kChart5,
  kChart6,
  kChart7,
  kChart8,
  kCamera,
  kScreenshot,
  kSequence,
  kSqueeze,
  kHandLeft,
  kHandRight,
  kHandUp,
  kHandDown,
  kHandAway,
  kHandNear,
  kTurnLeft,
  kTurnRight,
  kGripLess,
  kGripMore,
  kQuit,
};

struct KeyBinding {
  int code;          // devices::Key or the character
  const char* name;  // as a person calls it
  ViewAction action;
  const char* effect;  // "pause, go on"
};
struct KeyGroup {
  const char* title;
  std::span<const KeyBinding> keys;
};
struct MouseGesture {
  const char* name;
  const char* effect;
};

std::span<const KeyGroup> keyGroups();
std::span<const MouseGesture> cameraGestures();  // of a scene that plays by itself
std::span<const MouseGesture> handGestures();    // while the mouse moves the fingers

// With fingers that follow the keyboard (`hands`) some keys mean them.
std::optional<ViewAction> actionOf(int key, bool hands);

// Switches what `action` switches; returns whether it is one of those.
bool toggle(ViewAction action, ViewChoice& choice);

std::string keysMarkdown();

}  // namespace pincer::tasks
