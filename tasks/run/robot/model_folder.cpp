#include "pincer/tasks/run/robot/model_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace pincer::tasks {
namespace {

namespace fs = std::filesystem;

bool isWithin(const fs::path& file, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

fs::path canonicalFolder(const std::string& folder) {
  std::error_code error;
  const fs::path path = fs::canonical(folder.empty() ? "." : folder, error);
  if (error || !fs::is_directory(path, error))
    throw InputError(fmt::format("--allow {}: is no folder. Name one that exists.", folder));
  return path;
}

}  // namespace

ModelFolder::ModelFolder(const std::string& path, const std::vector<std::string>& allowed) {
  const fs::path folder = fs::path(path).parent_path();
  root_ = folder.empty() ? "." : folder.string();
  std::error_code error;
  allowed_.push_back(fs::weakly_canonical(root_, error).string());
  for (const std::string& more : allowed) allowed_.push_back(canonicalFolder(more).string());
}

std::string ModelFolder::find(const XmlElement& element, const std::string& folder, const std::string& name) const {
  const fs::path path = fs::path(root_) / folder / name;  // an absolute one replaces what stands before it
  std::error_code error;
  const fs::path real = fs::canonical(path, error);
  if (error)
    element.reject(fmt::format("names the file \"{}\", and there is no {}. Copy it there, or correct the name.", name,
                               path.string()));
  const bool is_allowed =
      std::any_of(allowed_.begin(), allowed_.end(), [&](const std::string& a) { return isWithin(real, a); });
  if (!is_allowed) {
    element.reject(fmt::format(
        "names the file \"{}\", which lies outside of the model's folder. If you trust it, give --allow {}.", name,
        real.parent_path().string()));
  }
  return path.lexically_normal().string();
}

}  // namespace pincer::tasks
