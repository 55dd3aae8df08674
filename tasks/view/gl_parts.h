// gl_parts: what the renderer owns on the graphics card; each gives it back when it
// goes. Numbers are OpenGL's names of things.
#pragma once
#include <map>
#include <string>

#include "pincer/devices/window/surface.h"
#include "pincer/tasks/view/draw_list.h"

namespace pincer::tasks {

// Finds OpenGL's functions for the surface, which must be current. Throws devices::DisplayError when it can't do 3.3.
void loadOpenGl(const devices::Surface& surface);

class GlProgram {
 public:
  GlProgram(const char* vertex_shader, const char* fragment_shader);
  ~GlProgram();
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;

  void use() const;
  // Of the program in use.
  void set(const char* name, float value);
  void set(const char* name, int value);
  void set(const char* name, const Vec3f& value);
  void set(const char* name, const Eigen::Vector4f& value);
  void set(const char* name, const Eigen::Matrix3f& value);
  void set(const char* name, const Mat4f& value);

 private:
  int place(const char* name);
  unsigned program_ = 0;
  std::map<std::string, int, std::less<>> places_;
};

class GlMesh {
 public:
  explicit GlMesh(const ViewMesh& mesh);
  ~GlMesh();
  GlMesh(const GlMesh&) = delete;
  GlMesh& operator=(const GlMesh&) = delete;
  void draw() const;

 private:
  unsigned array_ = 0, vertices_ = 0, triangles_ = 0;
  int count_ = 0;
  bool closed_ = false;
};

// A multisampled picture, and the plain one that it ends in.
class GlPicture {
 public:
  GlPicture() = default;
  ~GlPicture();
  GlPicture(const GlPicture&) = delete;
  GlPicture& operator=(const GlPicture&) = delete;

  // `samples` per pixel, along the borders of things; 1: none are smoothed.
  void resize(int width, int height, int samples);
  void begin() const;    // what is drawn goes to the multisampled one
  void resolve() const;  // to the plain one, which from now on is drawn to
  int width() const { return width_; }
  int height() const { return height_; }
  unsigned plain() const { return plain_; }
  unsigned sampled() const { return sampled_; }

 private:
  void release();
  int width_ = 0, height_ = 0, samples_ = 0;
  unsigned sampled_ = 0, sampled_colour_ = 0, sampled_depth_ = 0, plain_ = 0, plain_colour_ = 0;
};

// Depths as the sun sees them.
class GlShadowMap {
 public:
  explicit GlShadowMap(int side);
  ~GlShadowMap();
  GlShadowMap(const GlShadowMap&) = delete;
  GlShadowMap& operator=(const GlShadowMap&) = delete;

  void begin() const;
  void bind() const;  // to be compared with, as texture 0; to be read, as texture 1
  int side() const { return side_; }

 private:
  int side_;
  unsigned frame_ = 0, depth_ = 0, reader_ = 0;
};

}  // namespace pincer::tasks
