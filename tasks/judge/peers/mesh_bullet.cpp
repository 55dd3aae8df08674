// Bullet 3.24, double precision: btBvhTriangleMeshShape (quantised tree) against btSphereShape
// through btCollisionWorld::contactPairTest, the mesh's margin 0, contacts up to 1 mm apart.
// The deepest of the points it gives counts.
#include <btBulletCollisionCommon.h>

#include "pincer/tasks/judge/peers/adapters.h"

namespace pincer::tasks {
namespace {

struct Deepest : btCollisionWorld::ContactResultCallback {
  PeerContact contact;
  Vec3 centre;

  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    if (contact.touches && point.getDistance() >= contact.phi) return 0;
    const btVector3& n = point.m_normalWorldOnB;
    const btVector3& p = point.getPositionWorldOnB();
    contact.touches = true;
    contact.phi = point.getDistance();
    contact.n_B = Vec3(n.x(), n.y(), n.z());
    // out of the mesh, towards the centre
    if (contact.n_B.dot(centre - Vec3(p.x(), p.y(), p.z())) < 0) contact.n_B = -contact.n_B;
    return 0;
  }
};

class BulletMesh : public MeshPeer {
 public:
  BulletMesh(const contact::TriangleMesh& mesh, double finger_radius) : sphere_(finger_radius) {
    for (const Vec3& v : mesh.vertices) vertices_.insert(vertices_.end(), {v.x(), v.y(), v.z()});
    for (const auto& t : mesh.triangles) indices_.insert(indices_.end(), t.begin(), t.end());
    arrays_ = std::make_unique<btTriangleIndexVertexArray>(
        static_cast<int>(mesh.triangles.size()), indices_.data(), 3 * static_cast<int>(sizeof(int)),
        static_cast<int>(mesh.vertices.size()), vertices_.data(), 3 * static_cast<int>(sizeof(btScalar)));
    shape_ = std::make_unique<btBvhTriangleMeshShape>(arrays_.get(), true);
    shape_->setMargin(0);
    object_.setCollisionShape(shape_.get());
    finger_.setCollisionShape(&sphere_);
  }

  std::string name() const override { return "Bullet"; }

  PeerContact query(const Vec3& p_BC) override {
    finger_.getWorldTransform().setOrigin(btVector3(p_BC.x(), p_BC.y(), p_BC.z()));
    Deepest deepest;
    deepest.centre = p_BC;
    deepest.m_closestDistanceThreshold = 0.001;
    world_.contactPairTest(&finger_, &object_, deepest);
    return deepest.contact;
  }

 private:
  std::vector<btScalar> vertices_;
  std::vector<int> indices_;
  std::unique_ptr<btTriangleIndexVertexArray> arrays_;
  std::unique_ptr<btBvhTriangleMeshShape> shape_;
  btSphereShape sphere_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broad_phase_;
  btCollisionWorld world_{&dispatcher_, &broad_phase_, &configuration_};
  btCollisionObject object_, finger_;
};

}  // namespace

std::unique_ptr<MeshPeer> bulletMesh(const contact::TriangleMesh& mesh, double finger_radius) {
  return std::make_unique<BulletMesh>(mesh, finger_radius);
}

}  // namespace pincer::tasks
