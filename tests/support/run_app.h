// run_app: the command line as its user types it, in this process.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "pincer/tasks/app/app.h"

namespace pincer::tests {

struct AppResult {
  int exit_code;
  std::string out, error;
};

// `arguments` without the program's name.
inline AppResult runPincer(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "pincer");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const int exit_code = tasks::runApp(static_cast<int>(argv.size()), argv.data());
  return {exit_code, ::testing::internal::GetCapturedStdout(), ::testing::internal::GetCapturedStderr()};
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace pincer::tests
