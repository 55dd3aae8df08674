// effects_gl: parts of the renderer that draw to pictures of their own: less light in corners, and whose each pixel is.
#pragma once
#include <memory>
#include <vector>

#include "pincer/tasks/view/camera.h"
#include "pincer/tasks/view/gl_parts.h"

namespace pincer::tasks {

// Darkens what is drawn so far where little of the sky is seen (shaders_occlusion.h).
class GlOcclusion {
 public:
  GlOcclusion();
  ~GlOcclusion();
  GlOcclusion(const GlOcclusion&) = delete;
  GlOcclusion& operator=(const GlOcclusion&) = delete;

  // `reach`: how far away a thing still takes light [m]. `nothing` is any mesh.
  // Leaves `picture` drawn to, and blending on.
  void darken(const GlPicture& picture, const Camera& camera, double reach, const GlMesh& nothing);

 private:
  void resize(int width, int height);
  void release();
  GlProgram occlusion_, blur_;
  int width_ = 0, height_ = 0;
  unsigned depth_frame_ = 0, depth_ = 0, light_frame_ = 0, light_ = 0;
};

// Whose each pixel is (Renderer::things).
class GlThings {
 public:
  GlThings();
  std::vector<int> draw(const DrawList& list, const Camera& camera, int width, int height,
                        const std::vector<std::unique_ptr<GlMesh>>& meshes);

 private:
  GlProgram program_;
  GlPicture picture_;
};

}  // namespace pincer::tasks
