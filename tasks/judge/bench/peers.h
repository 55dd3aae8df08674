// peers: other engines' sphere-against-mesh query, on the same finger and mesh, for measuring beside them.
//
// The adapters live in tasks/judge/peers and are built with -DPINCER_PEERS=ON; without it there are none.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "pincer/contact/math.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::tasks {

struct PeerContact {
  bool touches = false;
  Vec3 n_B = Vec3::UnitZ();  // out of the mesh, of the deepest contact
  double phi = 0;            // its gap [m], negative when they overlap
};

class MeshPeer {
 public:
  virtual ~MeshPeer() = default;
  virtual std::string name() const = 0;
  virtual PeerContact query(const Vec3& p_BC) = 0;
};

// One of each engine that is built in; `mesh` must outlive them.
std::vector<std::unique_ptr<MeshPeer>> meshPeers(const contact::TriangleMesh& mesh, double finger_radius);

}  // namespace pincer::tasks
