#include <glad/gl.h>

#include <algorithm>

#include "pincer/tasks/view/effects_gl.h"
#include "pincer/tasks/view/gl_parts.h"
#include "pincer/tasks/view/renderer.h"
#include "pincer/tasks/view/shaders.h"
#include "pincer/tasks/view/shading_gl.h"

namespace pincer::tasks {
namespace {

constexpr int kSamples = 4;            // per pixel, along borders
constexpr int kShadowSide = 2048;      // texels
constexpr double kCornerReach = 0.12;  // of what takes light from corners, in radii of what has shadows
constexpr float kHiddenMarks = 0.5f;   // share of a mark that shows through what hides it
const Vec3 kSun_W = Vec3(-0.45, -0.55, 1.1).normalized();  // towards the sun

// Everything within `radius` of the centre, seen from the sun.
Mat4f worldToSun(const RenderOptions& options) {
  const Mat3 R_WS = frameFromNormal(kSun_W);
  Mat4f m = Mat4f::Identity();
  m.topLeftCorner<3, 3>() = (R_WS.transpose() / options.radius).cast<float>();
  m.row(2) *= -0.5f;  // depth grows away from the sun; things twice as far away still throw a shadow
  m.topRightCorner<3, 1>() = -m.topLeftCorner<3, 3>() * options.centre_W.cast<float>();
  return m;
}

bool isOpaque(const DrawItem& item) { return item.paint.alpha >= 1 && item.paint.fade <= 0 && !item.paint.sheer; }

}  // namespace

struct Renderer::Gl {
  explicit Gl(devices::Surface& s) : surface(s) {}

  void drawShadows(const DrawList& list, const RenderOptions& options);
  void drawSky();
  void drawItem(const DrawItem& item, float alpha = 1);
  void drawOpaque(const DrawList& list, Layer layer);
  void drawHiddenMarks(const DrawList& list);
  void drawGround(const DrawList& list);
  void darkenCorners(const Camera& camera, double reach);
  void drawTransparent(const DrawList& list, const Vec3& eye_W);

  devices::Surface& surface;
  GlProgram shadow{kShadowVertexShader, kShadowFragmentShader}, sky{kSkyVertexShader, kSkyFragmentShader};
  GlShading shading;
  GlShadowMap shadow_map{kShadowSide};
  GlPicture picture;
  GlOcclusion occlusion;
  GlThings things;
  GlMesh nothing{{}};  // drawn where a shader makes its own corners
  std::vector<std::unique_ptr<GlMesh>> meshes;
};

Renderer::Renderer(devices::Surface& surface) {
  loadOpenGl(surface);
  gl_ = std::make_unique<Gl>(surface);
}
Renderer::~Renderer() = default;

int Renderer::add(const ViewMesh& mesh) {
  gl_->meshes.push_back(std::make_unique<GlMesh>(mesh));
  return static_cast<int>(gl_->meshes.size()) - 1;
}

std::string Renderer::graphics() const { return reinterpret_cast<const char*>(glGetString(GL_RENDERER)); }

bool Renderer::isSoftware() const {
  const std::string name = graphics();
  return name.find("llvmpipe") != std::string::npos || name.find("softpipe") != std::string::npos ||
         name.find("swr") != std::string::npos;
}

void Renderer::Gl::drawShadows(const DrawList& list, const RenderOptions& options) {
  shadow_map.begin();
  shadow.use();
  shadow.set("world_to_sun", worldToSun(options));
  for (const DrawItem& item : list) {
    if (item.layer != Layer::kSolid || !isOpaque(item)) continue;
    shadow.set("X_WM", item.X_WM);
    meshes[static_cast<std::size_t>(item.mesh)]->draw();
  }
}

void Renderer::Gl::drawSky() {
  sky.use();
  glDisable(GL_DEPTH_TEST);
  nothing.draw();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
}

void Renderer::Gl::drawItem(const DrawItem& item, float alpha) {
  shading.begin(item, alpha);
  meshes[static_cast<std::size_t>(item.mesh)]->draw();
}

void Renderer::Gl::drawOpaque(const DrawList& list, Layer layer) {
  for (const DrawItem& item : list) {
    if (item.layer == layer && isOpaque(item)) drawItem(item);
  }
}

void Renderer::Gl::drawHiddenMarks(const DrawList& list) {
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_FALSE);
  for (const DrawItem& item : list) {
    if (item.layer == Layer::kMark && isOpaque(item)) drawItem(item, kHiddenMarks);
  }
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
}

// Fades out into the sky; of a sheer one nothing hides what lies behind.
void Renderer::Gl::drawGround(const DrawList& list) {
  for (const DrawItem& item : list) {
    if (item.layer != Layer::kGround || isOpaque(item)) continue;
    glDepthMask(item.paint.sheer ? GL_FALSE : GL_TRUE);
    drawItem(item);
  }
  glDepthMask(GL_TRUE);
}

void Renderer::Gl::darkenCorners(const Camera& camera, double reach) {
  occlusion.darken(picture, camera, reach, nothing);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  shading.forget();
}

// From far to near.
void Renderer::Gl::drawTransparent(const DrawList& list, const Vec3& eye_W) {
  std::vector<const DrawItem*> items;
  for (const DrawItem& item : list) {
    if (!isOpaque(item) && item.layer != Layer::kGround) items.push_back(&item);
  }
  const auto distance = [&](const DrawItem* item) {
    return (item->X_WM.topRightCorner<3, 1>() - eye_W.cast<float>()).norm();
  };
  std::stable_sort(items.begin(), items.end(),
                   [&](const DrawItem* a, const DrawItem* b) { return distance(a) > distance(b); });
  glDepthMask(GL_FALSE);
  for (const DrawItem* item : items) drawItem(*item);
  glDepthMask(GL_TRUE);
}

void Renderer::draw(const DrawList& list, const Camera& camera, const RenderOptions& options) {
  const devices::SurfaceSize size = gl_->surface.size();
  gl_->picture.resize(size.width, size.height, options.smooth_borders ? kSamples : 1);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  if (options.shadows) gl_->drawShadows(list, options);
  gl_->picture.begin();
  glEnable(GL_MULTISAMPLE);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl_->drawSky();
  gl_->shadow_map.bind();
  gl_->shading.setFrame({.world_to_clip = camera.world_to_clip(static_cast<double>(size.width) / size.height),
                         .world_to_sun = worldToSun(options),
                         .eye_W = camera.eye_W().cast<float>(),
                         .target_W = camera.target_W.cast<float>(),
                         .sun_W = kSun_W.cast<float>(),
                         .shadow_strength = options.shadows ? 0.85f : 0.0f,
                         .shadow_texel = 1.0f / kShadowSide,
                         .soft = options.soft});
  gl_->drawOpaque(list, Layer::kSolid);
  gl_->drawOpaque(list, Layer::kGround);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl_->drawGround(list);
  if (options.shadows && options.soft) gl_->darkenCorners(camera, kCornerReach * options.radius);
  gl_->drawTransparent(list, camera.eye_W());
  gl_->drawHiddenMarks(list);
  gl_->drawOpaque(list, Layer::kMark);
  gl_->picture.resolve();
}

std::vector<int> Renderer::things(const DrawList& list, const Camera& camera, devices::SurfaceSize size) {
  return gl_->things.draw(list, camera, size.width, size.height, gl_->meshes);
}

Image Renderer::picture() {
  const GlPicture& picture = gl_->picture;
  Image image{picture.width(), picture.height(), {}};
  const std::size_t row = 3 * static_cast<std::size_t>(image.width);
  std::vector<std::uint8_t> upside_down(row * static_cast<std::size_t>(image.height));
  glBindFramebuffer(GL_FRAMEBUFFER, picture.plain());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, image.width, image.height, GL_RGB, GL_UNSIGNED_BYTE, upside_down.data());
  for (int y = image.height - 1; y >= 0; --y) {
    const auto* from = upside_down.data() + row * static_cast<std::size_t>(y);
    image.bytes.insert(image.bytes.end(), from, from + row);
  }
  return image;
}

void Renderer::show() {
  if (!gl_->surface.isWindow()) return;
  const GlPicture& picture = gl_->picture;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, picture.plain());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, picture.width(), picture.height(), 0, 0, picture.width(), picture.height(),
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
  gl_->surface.present();
}

}  // namespace pincer::tasks
