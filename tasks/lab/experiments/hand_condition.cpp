#include "pincer/tasks/lab/experiments/hand_condition.h"

#include <fmt/format.h>

#include <algorithm>

#include "pincer/tasks/lab/experiments/cylinder_alignment.h"
#include "pincer/tasks/lab/experiments/sphere_pickup.h"
#include "pincer/tasks/run/files/fingerprint.h"

namespace pincer::tasks {
namespace {

void shadeAs(HandShading shading, std::optional<contact::SurfaceVariant>& felt) {
  if (shading == HandShading::kTask) return;
  felt.reset();
  if (shading != HandShading::kExactly)
    felt = static_cast<contact::SurfaceVariant>(static_cast<int>(shading) - static_cast<int>(HandShading::kSmooth));
}

}  // namespace

std::vector<HandCondition> publishedHandConditions() { return {{}, {"cld+force", "CLD + force", true}}; }

std::uint64_t seedPartOf(const HandCondition& condition) {
  const std::vector<HandCondition> published = publishedHandConditions();
  for (std::size_t k = 0; k < published.size(); ++k)
    if (published[k].name == condition.name) return k;
  Fingerprint hash;
  hash.add(condition.name);
  return hash.bits();
}

SpherePickupOptions inCondition(SpherePickupOptions options, const HandCondition& condition) {
  options.mass *= condition.mass_ratio;
  std::optional<contact::SurfaceVariant> felt = options.object ? options.object->shading : options.shading;
  shadeAs(condition.shading, felt);
  if (!options.object) {
    options.shading = felt;
  } else if (felt) {
    options.object->shading = *felt;
  } else {
    throw InputError(fmt::format("condition \"{}\": shading = \"exactly\", but {} has no closed form. Take another.",
                                 condition.name, options.object->path));
  }
  return options;
}

CylinderAlignmentOptions inCondition(CylinderAlignmentOptions options, const HandCondition& condition) {
  options.mass *= condition.mass_ratio;
  shadeAs(condition.shading, options.shading);
  return options;
}

}  // namespace pincer::tasks
