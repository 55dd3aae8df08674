// adapters: one maker per engine.
#pragma once
#include "pincer/tasks/judge/bench/engine/bench_world.h"
#include "pincer/tasks/judge/bench/peers.h"

namespace pincer::tasks {

std::unique_ptr<MeshPeer> bulletMesh(const contact::TriangleMesh& mesh, double finger_radius);
std::unique_ptr<MeshPeer> odeMesh(const contact::TriangleMesh& mesh, double finger_radius);

// Each engine's settings, its documented best. (which are built in: engine_peers.cpp, made by CMakeLists.txt)
std::vector<Contestant> bulletEngines();
std::vector<Contestant> odeEngines();
std::vector<Contestant> mujocoEngines();
std::vector<Contestant> dartEngines();

}  // namespace pincer::tasks
