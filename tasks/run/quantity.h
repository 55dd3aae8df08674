// quantity: what a scene can record and expect, by name: "energy", "sphere.p_z",
// "left.normal_force", "hinge.position", "cube|left.f_x".
//
// Every name, its unit and its meaning: docs/scenes.md. What a finger feels is that of the
// last tick; before the first tick it is zero.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pincer/grasp/step.h"

namespace pincer::tasks {

// A place on a body that is of interest: the middle of a gripper, a tool's tip.
struct BodyFrame {
  std::string name;
  int body = 0;
  Pose X_BF;
};

// The world at one moment.
struct Moment {
  const grasp::GraspModel& model;
  const grasp::GraspState& state;
  std::span<const grasp::FingerReport> fingers;
  const std::vector<engine::BodyStart>& starts;
  const grasp::GraspScratch& scratch;  // of the last tick
  std::span<const BodyFrame> frames{};
};

// One name of a family of quantities, and how it is measured on the body, finger, joint .. `index`.
struct QuantityKind {
  std::string_view name;
  std::string_view unit;
  double (*measure)(const Moment& moment, std::size_t index);
};

struct Quantity {
  std::string name;                    // as in the file
  const QuantityKind* kind = nullptr;  // never null in a scene that was read
  std::size_t index = 0;               // of the body, finger, joint ..; of two bodies pairIndex
  int taxel = -1;                      // of a finger's pressure map, row by row; -1: the quantity isn't one of these

  double measure(const Moment& moment) const {
    if (taxel < 0) return kind->measure(moment, index);
    const std::span<const grasp::Taxel> map = moment.fingers[index].pressure;
    return map.empty() ? 0 : map[static_cast<std::size_t>(taxel)].normal;  // empty before the first tick
  }
};

// 16 hexadecimal digits of engine::hashOf: equal states, equal text, on every machine.
std::string hashText(const engine::WorldState& state);

std::span<const QuantityKind> worldQuantities();
std::span<const QuantityKind> bodyQuantities();
std::span<const QuantityKind> fingerQuantities();
std::span<const QuantityKind> jointQuantities();
std::span<const QuantityKind> driveQuantities();
std::span<const QuantityKind> frameQuantities();
std::span<const QuantityKind> pairQuantities();  // of what touches between two bodies

// The index of two bodies of a world of `bodies`.
constexpr std::size_t pairIndex(std::size_t a, std::size_t b, std::size_t bodies) { return a * bodies + b; }

}  // namespace pincer::tasks
