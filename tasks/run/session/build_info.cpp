#include "pincer/tasks/run/session/build_info.h"

#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <sys/utsname.h>

#include <fstream>

namespace pincer::tasks {
namespace {

// "model name : X" of the first processor; elsewhere than on x86 what stands for it.
std::string modelOfProcessor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) continue;
    if (line.starts_with("model name") || line.starts_with("CPU implementer")) return line.substr(colon + 2);
  }
  return "unknown model";
}

// Features that libraries look at to choose between variants of a function.
std::string instructionSets() {
  std::string sets;
#if defined(__x86_64__)
  const auto add = [&](const char* name, int has) {
    sets += has ? fmt::format("{}{}", sets.empty() ? "" : " ", name) : "";
  };
  add("avx", __builtin_cpu_supports("avx"));
  add("avx2", __builtin_cpu_supports("avx2"));
  add("fma", __builtin_cpu_supports("fma"));
  add("avx512f", __builtin_cpu_supports("avx512f"));
#endif
  return sets.empty() ? "" : fmt::format(" ({})", sets);
}

std::string processor() {
  utsname system{};
  ::uname(&system);
  return fmt::format("{}, {}{}", system.machine, modelOfProcessor(), instructionSets());
}

constexpr const char* compiler() {
#if defined(__clang__)
  return "clang " __clang_version__;
#else
  return "g++ " __VERSION__;
#endif
}

}  // namespace

void tellBuild(SessionInfo& info) {
  info.version = kBuildInfo.version;
  info.commit = kBuildInfo.commit;
  info.sources = kBuildInfo.sources;
  info.build = compiler();
  info.flags = kBuildInfo.flags;
  info.c_library = fmt::format("glibc {}", gnu_get_libc_version());
  info.processor = processor();
}

void addBuild(SessionInfo& info) {
  SessionInfo here;
  tellBuild(here);
  const auto add = [](std::string& told, const std::string& now) {
    if (!told.empty() && told != now && !told.ends_with("; then " + now)) told += "; then " + now;
  };
  add(info.version, here.version);
  add(info.commit, here.commit);
  add(info.sources, here.sources);
  add(info.build, here.build);
  add(info.flags, here.flags);
  add(info.c_library, here.c_library);
  add(info.processor, here.processor);
}

std::string programOf(const SessionInfo& info) {
  const std::string sources = info.sources.empty() ? "" : ", sources " + info.sources;
  if (!info.commit.empty()) return fmt::format("pincer {} (commit {}{})", info.version, info.commit, sources);
  if (!info.sources.empty()) return fmt::format("pincer {} (made without its repository{})", info.version, sources);
  return fmt::format("pincer {} (of before sessions kept their commit)", info.version);
}

std::string versionText() {
  SessionInfo here;
  tellBuild(here);
  return fmt::format("{}\n{}, {}\n{}\n{}", programOf(here), here.build, here.c_library, here.processor, here.flags);
}

std::vector<std::string> surroundingsThatDiffer(const SessionInfo& then, const SessionInfo& now) {
  std::vector<std::string> lines;
  const auto compare = [&](const char* what, const std::string& a, const std::string& b) {
    if (!a.empty() && !b.empty() && a != b) lines.push_back(fmt::format("{}: {} then, {} now", what, a, b));
  };
  compare("compiler", then.build, now.build);
  compare("flags", then.flags, now.flags);
  compare("C library", then.c_library, now.c_library);
  compare("processor", then.processor, now.processor);
  return lines;
}

}  // namespace pincer::tasks
