// commands: the subcommands of the program, one source file each (`sim_command.cpp`, ...). Each adds itself to
// `app`; when the user asks for it, its callback does the work and leaves an ExitCode (tasks/app/app.h) in
// `exit_code`, or throws InputError (exit code 3).
#pragma once

namespace CLI {
class App;
}

namespace pincer::tasks {

void addSimCommand(CLI::App& app, int& exit_code);
void addTestCommand(CLI::App& app, int& exit_code);
void addPlanCommand(CLI::App& app, int& exit_code);
void addBenchCommand(CLI::App& app, int& exit_code);
void addMeshCommand(CLI::App& app, int& exit_code);
void addRunCommand(CLI::App& app, int& exit_code);
void addVerifyCommand(CLI::App& app, int& exit_code);
void addStressCommand(CLI::App& app, int& exit_code);
void addReportCommand(CLI::App& app, int& exit_code);
void addExportCommand(CLI::App& app, int& exit_code);
void addReplayCommand(CLI::App& app, int& exit_code);
void addShareCommand(CLI::App& app, int& exit_code);
void addKeysCommand(CLI::App& app, int& exit_code);
void addDevicesCommand(CLI::App& app, int& exit_code);
void addSweepCommand(CLI::App& app, int& exit_code);
void addImportCommand(CLI::App& app, int& exit_code);
void addSolveCommand(CLI::App& app, int& exit_code);
void addSchemaCommand(CLI::App& app, int& exit_code);
void addManualCommand(CLI::App& app, int& exit_code);
void addCompletionCommand(CLI::App& app, int& exit_code);

}  // namespace pincer::tasks
