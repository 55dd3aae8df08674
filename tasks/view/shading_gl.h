// shading_gl: the programs that shade things, of which each item needs one; made when first needed.
#pragma once
#include <array>
#include <memory>

#include "pincer/tasks/view/gl_parts.h"

namespace pincer::tasks {

// All that items of one picture have in common.
struct FrameLight {
  Mat4f world_to_clip = Mat4f::Identity(), world_to_sun = Mat4f::Identity();
  Vec3f eye_W = Vec3f::Zero(), target_W = Vec3f::Zero();  // of the camera [m]
  Vec3f sun_W = Vec3f::UnitZ();                           // towards it, unit
  float shadow_strength = 0;                              // 0 none .. 1 black
  float shadow_texel = 0;                                 // in shares of the shadow map
  bool soft = false;                                      // half shadows
};

class GlShading {
 public:
  void setFrame(const FrameLight& frame);
  // Things drawn next look like `item`, `alpha` times as opaque.
  void begin(const DrawItem& item, float alpha);
  // Another program was in use meanwhile.
  void forget() { used_ = nullptr; }

 private:
  enum class Kind : std::uint8_t { kPlain, kGrid, kSheer };
  struct Program {
    GlProgram gl;
    int frame = 0;  // whose numbers it has
  };
  Program& programOf(Kind kind);

  FrameLight frame_;
  int frames_ = 0;
  Program* used_ = nullptr;
  std::array<std::unique_ptr<Program>, 6> programs_;
};

}  // namespace pincer::tasks
