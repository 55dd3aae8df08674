#include "pincer/tasks/judge/peers/adapters.h"

namespace pincer::tasks {

std::vector<std::unique_ptr<MeshPeer>> meshPeers(const contact::TriangleMesh& mesh, double finger_radius) {
  std::vector<std::unique_ptr<MeshPeer>> peers;
  peers.push_back(bulletMesh(mesh, finger_radius));
  peers.push_back(odeMesh(mesh, finger_radius));
  return peers;
}

}  // namespace pincer::tasks
