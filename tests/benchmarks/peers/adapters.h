// adapters: one maker per engine.
#pragma once
#include "tasks/bench/peers.h"

namespace pincer::tasks {

std::unique_ptr<MeshPeer> bulletMesh(const contact::TriangleMesh& mesh, double finger_radius);
std::unique_ptr<MeshPeer> odeMesh(const contact::TriangleMesh& mesh, double finger_radius);

}  // namespace pincer::tasks
