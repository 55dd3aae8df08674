// ODE 0.16, double precision: dCollide of a trimesh (OPCODE) and a sphere, up to 2048 points, the deepest of which
// counts: with 64 the deepest isn't always among them on fine meshes. It says nothing while the two don't overlap.
#include <ode/ode.h>

#include "pincer/tasks/judge/peers/adapters.h"

namespace pincer::tasks {
namespace {

class OdeMesh : public MeshPeer {
 public:
  OdeMesh(const contact::TriangleMesh& mesh, double finger_radius) {
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    for (const Vec3& v : mesh.vertices) vertices_.insert(vertices_.end(), {v.x(), v.y(), v.z()});
    for (const auto& t : mesh.triangles) {
      for (const std::int32_t v : t) indices_.push_back(static_cast<dTriIndex>(v));
    }
    data_ = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildDouble(data_, vertices_.data(), 3 * sizeof(double), static_cast<int>(mesh.vertices.size()),
                                indices_.data(), static_cast<int>(indices_.size()), 3 * sizeof(dTriIndex));
    mesh_ = dCreateTriMesh(nullptr, data_, nullptr, nullptr, nullptr);
    finger_ = dCreateSphere(nullptr, finger_radius);
  }
  OdeMesh(const OdeMesh&) = delete;
  OdeMesh& operator=(const OdeMesh&) = delete;
  ~OdeMesh() override {
    dGeomDestroy(finger_);
    dGeomDestroy(mesh_);
    dGeomTriMeshDataDestroy(data_);
  }

  std::string name() const override { return "ODE"; }

  PeerContact query(const Vec3& p_BC) override {
    dGeomSetPosition(finger_, p_BC.x(), p_BC.y(), p_BC.z());
    const int n = dCollide(mesh_, finger_, static_cast<int>(points_.size()), points_.data(), sizeof(dContactGeom));
    PeerContact deepest;
    for (int i = 0; i < n; ++i) {
      const dContactGeom& point = points_[static_cast<std::size_t>(i)];
      if (deepest.touches && -point.depth >= deepest.phi) continue;
      // ODE's normal points into the first geom
      deepest = {true, -Vec3(point.normal[0], point.normal[1], point.normal[2]), -point.depth};
    }
    return deepest;
  }

 private:
  std::vector<double> vertices_;
  std::vector<dTriIndex> indices_;
  std::vector<dContactGeom> points_ = std::vector<dContactGeom>(2048);
  dTriMeshDataID data_;
  dGeomID mesh_, finger_;
};

}  // namespace

std::unique_ptr<MeshPeer> odeMesh(const contact::TriangleMesh& mesh, double finger_radius) {
  return std::make_unique<OdeMesh>(mesh, finger_radius);
}

}  // namespace pincer::tasks
