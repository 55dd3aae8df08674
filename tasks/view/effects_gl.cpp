#include "pincer/tasks/view/effects_gl.h"

#include <glad/gl.h>

#include <cstdint>

#include "pincer/contact/elementary.h"
#include "pincer/tasks/view/shaders.h"
#include "pincer/tasks/view/shaders_occlusion.h"

namespace pincer::tasks {
namespace {

// A picture of one number per pixel, and the frame that draws to it.
void makeTexture(unsigned& frame, unsigned& texture, GLint format, GLenum kind, GLenum attachment, int width,
                 int height) {
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  const GLenum parts = kind == GL_UNSIGNED_BYTE ? GL_RED : GL_DEPTH_COMPONENT;
  glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, parts, kind, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glGenFramebuffers(1, &frame);
  glBindFramebuffer(GL_FRAMEBUFFER, frame);
  glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
}

void drawOverAll(const GlMesh& nothing) {
  nothing.draw();
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace

GlOcclusion::GlOcclusion()
    : occlusion_(kSkyVertexShader, kOcclusionFragmentShader), blur_(kSkyVertexShader, kOcclusionBlurShader) {}
GlOcclusion::~GlOcclusion() { release(); }

void GlOcclusion::release() {
  glDeleteFramebuffers(1, &depth_frame_);
  glDeleteFramebuffers(1, &light_frame_);
  glDeleteTextures(1, &depth_);
  glDeleteTextures(1, &light_);
}

void GlOcclusion::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  release();
  width_ = width;
  height_ = height;
  makeTexture(depth_frame_, depth_, GL_DEPTH_COMPONENT24, GL_UNSIGNED_INT, GL_DEPTH_ATTACHMENT, width, height);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  makeTexture(light_frame_, light_, GL_R8, GL_UNSIGNED_BYTE, GL_COLOR_ATTACHMENT0, width, height);
}

void GlOcclusion::darken(const GlPicture& picture, const Camera& camera, double reach, const GlMesh& nothing) {
  const int width = picture.width(), height = picture.height();
  glActiveTexture(GL_TEXTURE2);
  resize(width, height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, picture.sampled());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, depth_frame_);
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glBindTexture(GL_TEXTURE_2D, depth_);
  glBindFramebuffer(GL_FRAMEBUFFER, light_frame_);
  glViewport(0, 0, width, height);
  occlusion_.use();
  occlusion_.set("depths", 2);
  occlusion_.set("clip_to_view", Mat4f(camera.projection(static_cast<double>(width) / height).inverse()));
  occlusion_.set("reach", static_cast<float>(reach));
  occlusion_.set("pixels", static_cast<float>(0.5 * height / math::tan(camera.opening / 2)));
  drawOverAll(nothing);
  picture.begin();
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_ZERO, GL_SRC_COLOR, GL_ZERO, GL_ONE);
  glActiveTexture(GL_TEXTURE3);
  glBindTexture(GL_TEXTURE_2D, light_);
  blur_.use();
  blur_.set("depths", 2);
  blur_.set("light", 3);
  drawOverAll(nothing);
  glActiveTexture(GL_TEXTURE0);
  glEnable(GL_DEPTH_TEST);
}

GlThings::GlThings() : program_(kShadowVertexShader, kThingFragmentShader) {}

std::vector<int> GlThings::draw(const DrawList& list, const Camera& camera, int width, int height,
                                const std::vector<std::unique_ptr<GlMesh>>& meshes) {
  picture_.resize(width, height, 1);
  picture_.begin();
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  program_.use();
  program_.set("world_to_sun", camera.world_to_clip(static_cast<double>(width) / height));
  for (const DrawItem& item : list) {
    if (item.layer != Layer::kSolid) continue;
    program_.set("X_WM", item.X_WM);
    program_.set("thing", item.thing);
    meshes[static_cast<std::size_t>(item.mesh)]->draw();
  }
  picture_.resolve();
  std::vector<std::uint8_t> bytes(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
  std::vector<int> things;
  things.reserve(bytes.size() / 4);
  for (int y = height - 1; y >= 0; --y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t at =
          4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
      things.push_back(bytes[at] + 256 * bytes[at + 1]);
    }
  }
  return things;
}

}  // namespace pincer::tasks
