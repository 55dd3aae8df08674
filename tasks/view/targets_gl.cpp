#include <glad/gl.h>

#include <algorithm>

#include "pincer/tasks/view/gl_parts.h"

namespace pincer::tasks {
namespace {

void requireComplete(const char* what) {
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return;
  throw devices::DisplayError(std::string("The graphics driver can't draw to ") + what +
                              ". Mesa's software driver can: set LIBGL_ALWAYS_SOFTWARE=1.");
}

unsigned sampledBuffer(GLenum format, GLenum attachment, int width, int height, int samples) {
  unsigned buffer = 0;
  GLint most = 0;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  glGenRenderbuffers(1, &buffer);
  glBindRenderbuffer(GL_RENDERBUFFER, buffer);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? std::min(samples, most) : 0, format, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
  return buffer;
}

}  // namespace

GlPicture::~GlPicture() { release(); }

void GlPicture::release() {
  glDeleteFramebuffers(1, &sampled_);
  glDeleteFramebuffers(1, &plain_);
  glDeleteRenderbuffers(1, &sampled_colour_);
  glDeleteRenderbuffers(1, &sampled_depth_);
  glDeleteRenderbuffers(1, &plain_colour_);
}

void GlPicture::resize(int width, int height, int samples) {
  if (width == width_ && height == height_ && samples == samples_) return;
  if (width_ > 0) release();
  width_ = width;
  height_ = height;
  samples_ = samples;
  glGenFramebuffers(1, &sampled_);
  glBindFramebuffer(GL_FRAMEBUFFER, sampled_);
  sampled_colour_ = sampledBuffer(GL_RGBA8, GL_COLOR_ATTACHMENT0, width, height, samples);
  sampled_depth_ = sampledBuffer(GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT, width, height, samples);
  requireComplete("a multisampled picture");
  glGenFramebuffers(1, &plain_);
  glBindFramebuffer(GL_FRAMEBUFFER, plain_);
  glGenRenderbuffers(1, &plain_colour_);
  glBindRenderbuffer(GL_RENDERBUFFER, plain_colour_);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, plain_colour_);
  requireComplete("a picture");
}

void GlPicture::begin() const {
  glBindFramebuffer(GL_FRAMEBUFFER, sampled_);
  glViewport(0, 0, width_, height_);
}

void GlPicture::resolve() const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, sampled_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, plain_);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, plain_);
}

GlShadowMap::GlShadowMap(int side) : side_(side) {
  glGenTextures(1, &depth_);
  glBindTexture(GL_TEXTURE_2D, depth_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, side, side, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glGenFramebuffers(1, &frame_);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_, 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  requireComplete("a shadow map");
  glGenSamplers(1, &reader_);
  glSamplerParameteri(reader_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glSamplerParameteri(reader_, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glSamplerParameteri(reader_, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(reader_, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(reader_, GL_TEXTURE_COMPARE_MODE, GL_NONE);
}
GlShadowMap::~GlShadowMap() {
  glDeleteFramebuffers(1, &frame_);
  glDeleteTextures(1, &depth_);
  glDeleteSamplers(1, &reader_);
}
void GlShadowMap::begin() const {
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glViewport(0, 0, side_, side_);
  glClear(GL_DEPTH_BUFFER_BIT);
}
void GlShadowMap::bind() const {
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, depth_);
  glBindSampler(1, reader_);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, depth_);
}

}  // namespace pincer::tasks
