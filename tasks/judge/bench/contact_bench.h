// contact_bench: `pincer bench contact`: what touching a mesh costs and how well it is
// felt, measured against docs/benchmarks.md.
//
// Object by object: iterations, failures, continuity. Against closed forms: approximation errors, per variant
// of shading. Costs: per query, with the global guard, over the number of triangles, beside other engines.
// Scenes: what a haptics lab would try first.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pincer/tasks/run/measure/measurement.h"

namespace pincer::tasks {

struct ContactBenchOptions {
  std::int64_t queries = 100000;  // per object
  std::string meshes;             // directory of further mesh files; empty: none
  std::string out;                // directory for CSV files and plots; empty: none
  bool peers = false;             // beside Bullet and ODE, where they are built in
};

// In the order in which a person should read them. Throws InputError.
std::vector<Measurement> contactMeasurements(const ContactBenchOptions& options);

// Its parts, one source file each.
std::vector<Measurement> strokeMeasurements(const ContactBenchOptions& options);   // iterations, failures, continuity
std::vector<Measurement> accuracyMeasurements();                                   // closed forms, gaps across edges
std::vector<Measurement> curveMeasurements();                                      // the 2D algorithm
std::vector<Measurement> costMeasurements(const ContactBenchOptions& options);     // nanoseconds, growth, peers
std::vector<Measurement> shadingMeasurements(const ContactBenchOptions& options);  // the variants side by side, plots
std::vector<Measurement> pairMeasurements();                                       // two bodies: errors, costs, names
std::vector<Measurement> meshPairMeasurements();    // bodies on meshes: facets, many triangles
std::vector<Measurement> meshDefectMeasurements();  // bad meshes: reading, repair, contact
// a finger that presses and drags
std::vector<Measurement> fingerSceneMeasurements(const ContactBenchOptions& options);

}  // namespace pincer::tasks
