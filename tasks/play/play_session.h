// play_session: two fingers and a ball in a web page, stepped there (docs/play.md). It knows contact/, engine/ and
// grasp/ alone; the same source runs in WebAssembly and natively, and prints the same hash.
//
//   pickup   the pointer leads a hand of two stiff fingers over a dish with a ball; they close while it squeezes
//   pinch    S4: two driven points press on a ball with the grip; the pointer pulls the ball by a spring
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "pincer/grasp/step.h"

namespace pincer::tasks {

// The wish of a person in front of the page.
struct PlayWish {
  Vec3 p_W = Vec3::Zero();  // of the pointer: the middle of the hand, or where the ball is pulled to [m]
  bool squeezes = false;    // pickup: the fingers close; pinch: the spring pulls
  double grip = 2;          // of each finger [N], 0.1 .. 10
};

class PlaySession {
 public:
  static constexpr double kTick = 1e-3;  // [s]

  // "pickup" or "pinch". Throws InputError for another name.
  explicit PlaySession(const std::string& scene);

  void tick(const PlayWish& wish);

  int bodies() const { return static_cast<int>(model_.world.bodies.size()); }
  int fingers() const { return static_cast<int>(model_.fingers.size()); }
  Pose bodyPose(int body) const;     // X_WB
  Vec3 fingertip(int finger) const;  // centre of the proxy, in W [m]
  std::span<const grasp::FingerReport> reports() const { return grasp::fingersOf(*scratch_); }
  // Of the pull on the ball, as of now; zero where nobody pulls. [N]
  const Vec3& pull_W() const { return pull_W_; }
  int flagged() const { return flagged_; }  // ticks that weren't solved to the tolerance
  std::uint64_t hash() const { return engine::hashOf(state_.world); }

 private:
  void closeFingers(const PlayWish& wish);
  void pullBall(const PlayWish& wish);

  bool is_pickup_;
  grasp::GraspModel model_;
  grasp::GraspState state_;
  grasp::ScratchHandle scratch_;
  std::vector<grasp::FingerInput> inputs_;
  std::vector<engine::BodyForce> forces_;
  Vec3 pull_W_ = Vec3::Zero();
  Vec3 middle_W_ = Vec3::Zero();  // of the hand, on its way to the pointer
  Vec3 v_middle_W_ = Vec3::Zero();
  double gap_ = 0;  // that the hand wants between the fingertips' centres [m]
  int flagged_ = 0;
};

// The hash after `ticks` ticks of a hand that grips, lifts and shakes by itself: what two builds compare.
inline constexpr int kScriptTicks = 4000;
std::uint64_t hashOfScript(const std::string& scene, int ticks);

}  // namespace pincer::tasks
