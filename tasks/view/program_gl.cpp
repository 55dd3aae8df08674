#include <glad/gl.h>

#include <array>

#include "pincer/tasks/view/gl_parts.h"

namespace pincer::tasks {
namespace {

unsigned compiled(GLenum kind, const char* text) {
  const unsigned shader = glCreateShader(kind);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint ok = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == GL_TRUE) return shader;
  std::array<char, 512> log{};
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  throw devices::DisplayError(std::string("The graphics driver refuses a shader: ") + log.data());
}

}  // namespace

GlProgram::GlProgram(const char* vertex_shader, const char* fragment_shader) : program_(glCreateProgram()) {
  const unsigned vertex = compiled(GL_VERTEX_SHADER, vertex_shader),
                 fragment = compiled(GL_FRAGMENT_SHADER, fragment_shader);
  glAttachShader(program_, vertex);
  glAttachShader(program_, fragment);
  glLinkProgram(program_);
  glDeleteShader(vertex);
  glDeleteShader(fragment);
}
GlProgram::~GlProgram() { glDeleteProgram(program_); }

void GlProgram::use() const { glUseProgram(program_); }

int GlProgram::place(const char* name) {
  const auto found = places_.find(std::string_view(name));
  if (found != places_.end()) return found->second;
  return places_[name] = glGetUniformLocation(program_, name);
}
void GlProgram::set(const char* name, float value) { glUniform1f(place(name), value); }
void GlProgram::set(const char* name, int value) { glUniform1i(place(name), value); }
void GlProgram::set(const char* name, const Vec3f& value) { glUniform3fv(place(name), 1, value.data()); }
void GlProgram::set(const char* name, const Eigen::Vector4f& value) { glUniform4fv(place(name), 1, value.data()); }
void GlProgram::set(const char* name, const Eigen::Matrix3f& value) {
  glUniformMatrix3fv(place(name), 1, GL_FALSE, value.data());
}
void GlProgram::set(const char* name, const Mat4f& value) {
  glUniformMatrix4fv(place(name), 1, GL_FALSE, value.data());
}

GlMesh::GlMesh(const ViewMesh& mesh) : count_(static_cast<int>(mesh.triangles.size())), closed_(mesh.closed) {
  glGenVertexArrays(1, &array_);
  glGenBuffers(1, &vertices_);
  glGenBuffers(1, &triangles_);
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(ViewVertex)),
               mesh.vertices.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, triangles_);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(std::uint32_t)),
               mesh.triangles.data(), GL_STATIC_DRAW);
  static_assert(sizeof(ViewVertex) == 9 * sizeof(float), "three attributes of three floats each, without gaps");
  for (unsigned i = 0; i < 3; ++i) {
    glEnableVertexAttribArray(i);
    glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, sizeof(ViewVertex),
                          reinterpret_cast<const void*>(i * sizeof(Vec3f)));
  }
  glBindVertexArray(0);
}
GlMesh::~GlMesh() {
  glDeleteVertexArrays(1, &array_);
  glDeleteBuffers(1, &vertices_);
  glDeleteBuffers(1, &triangles_);
}
void GlMesh::draw() const {
  closed_ ? glEnable(GL_CULL_FACE) : glDisable(GL_CULL_FACE);
  glBindVertexArray(array_);
  glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace pincer::tasks
