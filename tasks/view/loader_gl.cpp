#define GLAD_GL_IMPLEMENTATION
#include <glad/gl.h>

#include "pincer/tasks/view/gl_parts.h"

namespace pincer::tasks {

void loadOpenGl(const devices::Surface& surface) {
  const int version = gladLoadGL(surface.loader());
  if (GLAD_VERSION_MAJOR(version) * 10 + GLAD_VERSION_MINOR(version) >= 33) return;
  throw devices::DisplayError(
      "The graphics driver can't do OpenGL 3.3. Mesa's software driver can: set LIBGL_ALWAYS_SOFTWARE=1.");
}

}  // namespace pincer::tasks
