// hand_condition: one condition of a manipulation study: what differs from the study's own values while it lasts.
//
// The published study has two, of which one is the default here: force only, the tactors parked (A. J. Doxon,
// dissertation, University of Utah, 2014). A study file names its own.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pincer/contact/surface_contact.h"

namespace pincer::tasks {

struct CylinderAlignmentOptions;
struct SpherePickupOptions;

// How fingers feel the objects: as the task says, as one of contact::SurfaceVariant, in its order, or by closed form.
enum class HandShading : std::uint8_t { kTask, kSmooth, kFacet, kForce, kSmoothPublished, kExactly };

struct HandCondition {
  std::string name = "force", label = "force only";  // in tables, for people
  bool display_tactile = false;                      // false: the tactors stay parked
  HandShading shading = HandShading::kTask;
  double mass_ratio = 1;  // mass of the objects over the task's [-], 0.01 .. 100

  bool operator==(const HandCondition&) const = default;
};

// "force" and "cld+force".
std::vector<HandCondition> publishedHandConditions();

// Of the seed of all that varies in the condition: its trials are the same whichever others the study has.
std::uint64_t seedPartOf(const HandCondition& condition);

// The task's options while the condition lasts. Throws InputError: no closed form of an object from a file.
SpherePickupOptions inCondition(SpherePickupOptions options, const HandCondition& condition);
CylinderAlignmentOptions inCondition(CylinderAlignmentOptions options, const HandCondition& condition);

}  // namespace pincer::tasks
