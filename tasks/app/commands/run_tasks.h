// run_tasks: the experiments of `pincer run`, one source file each (`run_sphere_pickup.cpp`, ...). Each adds itself
// to the command `run`; when the user asks for it, its callback does the work and leaves an ExitCode
// (tasks/app/app.h) in `exit_code`, or throws InputError.
#pragma once

namespace CLI {
class App;
}

namespace pincer::tasks {

void addManipulationTask(CLI::App& run, int& exit_code);
void addSpherePickupTask(CLI::App& run, int& exit_code);
void addCylinderAlignmentTask(CLI::App& run, int& exit_code);
void addFindingsTask(CLI::App& run, int& exit_code);
// In run_studies.cpp:
void addSmoothnessTask(CLI::App& run, int& exit_code);
void addBacklashTask(CLI::App& run, int& exit_code);
void addDelayTask(CLI::App& run, int& exit_code);
void addLocalisationTask(CLI::App& run, int& exit_code);
void addShapeTask(CLI::App& run, int& exit_code);

}  // namespace pincer::tasks
