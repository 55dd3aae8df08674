// mesh_table: the meshes of a page, each once, whoever draws with it.
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/view/draw_list.h"

namespace pincer::tasks {

class MeshTable final : public MeshSink {
 public:
  int add(const ViewMesh& mesh) override;  // the place of an equal one if there is one
  const ViewMesh& at(int mesh) const { return meshes_[static_cast<std::size_t>(mesh)]; }
  std::size_t size() const { return meshes_.size(); }

 private:
  std::vector<ViewMesh> meshes_;
};

// A mesh as a page has it: columns x, y, z of places [m] and of normals, then indices; corners that
// are the same to a column's step are one.
struct PageMesh {
  std::size_t vertices = 0, indices = 0;
};
PageMesh appendMesh(std::string& bytes, const ViewMesh& mesh);

}  // namespace pincer::tasks
