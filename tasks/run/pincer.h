// pincer: everything that a program of yours may use, in one header. Link pincer::pincer.
//
//   meshes and shapes       contact/mesh_reader.h, smooth_mesh.h, shape.h, polytope.h, finger_query.h, pair_query.h
//   bodies in motion        engine/model.h, state.h, step.h
//   fingers on them         grasp/model.h, step.h, pad_place.h, grasp_quality.h, finger_distance.h, passivity.h
//   scene files             tasks/run/scene.h, simulation.h
//   sessions and tables     tasks/run/session_store.h, csv.h
//
// Each can be included by itself. What stands in the rooms below these folders is private and changes without notice.
#pragma once
#include "pincer/contact/finger_query.h"
#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/mesh_repair.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/contact/pair_query.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/engine/step.h"
#include "pincer/grasp/baseline.h"
#include "pincer/grasp/energy_ledger.h"
#include "pincer/grasp/finger_distance.h"
#include "pincer/grasp/grasp_quality.h"
#include "pincer/grasp/pad_place.h"
#include "pincer/grasp/passivity.h"
#include "pincer/grasp/step.h"
#include "pincer/tasks/run/csv.h"
#include "pincer/tasks/run/scene.h"
#include "pincer/tasks/run/session_store.h"
#include "pincer/tasks/run/simulation.h"
