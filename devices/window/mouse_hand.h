// mouse_hand: index finger and thumb (or one finger) that follow mouse, wheel and keys.
//
//   p_1,2 = c -+ (g/2) e,   e = (cos a, sin a, 0),   g -> g - v dt while squeezing, but not under d - 2 f/k
//
//   a  turn of the hand about z [rad], which the fingers' orientations follow;  c  middle of the two [m], the mouse's;
//      g  how far apart the hand wants them [m]; d  how far they are; v  how fast they close [m/s];
//   f  the grip [N], the wheel's; k  stiffness of the arms' springs [N/m]. Frame H: x right, y away, z up.
//
// So the fingers never press harder than the grip, and the hand that holds something is as stiff
// sideways as one that doesn't. Two threads: the window's calls the gestures, the servo's advance()
// and the arms; they meet in a triple buffer.
#pragma once
#include <vector>

#include "pincer/devices/triple_buffer.h"
#include "pincer/devices/window/mouse_arm.h"

namespace pincer::devices {

// Where an arm's base stands in the hand's frame.
struct MouseMount {
  Quat q_HD = Quat::Identity();
  Vec3 p_HD = Vec3::Zero();     // [m]
  Vec3 start_H = Vec3::Zero();  // of the fingertip [m]
  std::optional<Quat> q_DF;
};

struct MouseHandSettings {
  double close_speed = 0.10;                // v [m/s]
  double top_speed = 0.4;                   // of the middle [m/s]; the mouse may be faster
  double turn_speed = 1.5;                  // [rad/s]
  double most_turn = 1.2;                   // of a, either way: a wrist's [rad]
  double grip = 2.0;                        // f at first [N]
  double least_grip = 0.25, most_grip = 6;  // [N]
};

class MouseHand {
 public:
  // One or two mounts. Throws std::invalid_argument for another number.
  explicit MouseHand(const std::vector<MouseMount>& mounts, const MouseHandSettings& settings = {});

  // The window's side.
  void move(const Vec3& by_H);  // the middle [m]
  void turn(double by);         // [rad]
  void squeeze(bool on);
  void toggleSqueeze() { squeeze(!wanted_.squeezes); }
  void changeGrip(double factor);
  double grip() const { return wanted_.grip; }
  bool squeezes() const { return wanted_.squeezes; }

  // The servo's side.
  void advance(double dt);  // [s], > 0
  bool squeezing() const { return !going_home_ && wishes_.current().squeezes; }
  void goHome() { going_home_ = true; }  // opens, goes where it began and stays there, whatever the person does
  int fingers() const { return static_cast<int>(arms_.size()); }
  MouseArm& arm(int finger) { return arms_[static_cast<std::size_t>(finger)]; }
  Vec3 place_H(int finger) const;  // of the fingertip [m]
  Vec3 velocity_H(int finger);
  void commandForce_H(int finger, const Vec3& f_H);

 private:
  struct Wish {
    Vec3 middle_H = Vec3::Zero();
    bool squeezes = false;
    double grip = 0;
    double turn = 0;
  };
  void publish();
  double wantedGap(double dt, bool squeezes, double grip) const;
  Vec3 across_H() const { return {math::cos(turn_), math::sin(turn_), 0}; }

  MouseHandSettings settings_;
  std::vector<MouseMount> mounts_;
  std::vector<MouseArm> arms_;
  Wish wanted_;  // the window's
  TripleBuffer<Wish> wishes_;
  bool going_home_ = false;
  Vec3 home_H_ = Vec3::Zero();
  Vec3 middle_H_ = Vec3::Zero();  // the servo's, on its way to the wish
  double turn_ = 0;               // likewise
  double gap_ = 0, open_gap_ = 0;
};

}  // namespace pincer::devices
