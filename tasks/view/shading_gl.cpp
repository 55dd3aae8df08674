#include "pincer/tasks/view/shading_gl.h"

#include <fmt/format.h>

#include <string>

#include "pincer/tasks/view/shaders.h"

namespace pincer::tasks {
namespace {

std::string solidShader(bool soft, bool grid, bool sheer) {
  return fmt::format("#version 330 core\n#define SOFT {:d}\n#define GRID {:d}\n#define SHEER {:d}\n", soft, grid,
                     sheer) +
         kSolidFragmentShader;
}

void setFrameOf(const FrameLight& frame, GlProgram& program) {
  program.set("world_to_clip", frame.world_to_clip);
  program.set("world_to_sun", frame.world_to_sun);
  program.set("eye_W", frame.eye_W);
  program.set("target_W", frame.target_W);
  program.set("sun_W", frame.sun_W);
  program.set("shadow_strength", frame.shadow_strength);
  program.set("shadow_texel", frame.shadow_texel);
  program.set("shadow_map", 0);
  program.set("sun_depths", 1);
}

}  // namespace

void GlShading::setFrame(const FrameLight& frame) {
  frame_ = frame;
  ++frames_;
  used_ = nullptr;
}

GlShading::Program& GlShading::programOf(Kind kind) {
  std::unique_ptr<Program>& program = programs_[2 * static_cast<std::size_t>(kind) + (frame_.soft ? 1 : 0)];
  if (!program) {
    const std::string shader = solidShader(frame_.soft, kind != Kind::kPlain, kind == Kind::kSheer);
    program.reset(new Program{{kSolidVertexShader, shader.c_str()}});
  }
  return *program;
}

void GlShading::begin(const DrawItem& item, float alpha) {
  const Paint& paint = item.paint;
  Program& program = programOf(paint.sheer ? Kind::kSheer : paint.grid > 0 ? Kind::kGrid : Kind::kPlain);
  if (&program != used_) program.gl.use();
  used_ = &program;
  if (program.frame != frames_) setFrameOf(frame_, program.gl);
  program.frame = frames_;
  const Eigen::Matrix3f linear = item.X_WM.topLeftCorner<3, 3>();
  program.gl.set("X_WM", item.X_WM);
  program.gl.set("N_WM", Eigen::Matrix3f(linear.inverse().transpose()));
  program.gl.set("paint", Eigen::Vector4f(paint.colour.x(), paint.colour.y(), paint.colour.z(), alpha * paint.alpha));
  program.gl.set("gloss", paint.gloss);
  program.gl.set("edges", paint.edges);
  program.gl.set("octants", paint.octants);
  program.gl.set("glow", paint.glow);
  program.gl.set("fade", paint.fade);
  program.gl.set("grid", paint.grid);
}

}  // namespace pincer::tasks
