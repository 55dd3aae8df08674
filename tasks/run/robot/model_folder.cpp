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

std::string ModelFolder::findUri(const XmlElement& element, const std::string& uri) const {
  const std::size_t scheme_end = uri.find("://");
  if (scheme_end == std::string::npos) return find(element, "", uri);
  const std::string scheme = uri.substr(0, scheme_end), rest = uri.substr(scheme_end + 3);
  if (scheme == "package" || scheme == "model") return findPackaged(element, uri, rest);
  if (scheme == "file") return find(element, "", rest);
  element.reject(fmt::format(
      "names \"{}\", and files are found by package://NAME/PATH, file://PATH or a path beside the model only.", uri));
}

std::string ModelFolder::findPackaged(const XmlElement& element, const std::string& uri,
                                      const std::string& in_package) const {
  const fs::path path(in_package), package = path.empty() ? path : *path.begin();
  const fs::path within = path.lexically_relative(package);
  std::vector<fs::path> places;
  for (const std::string& folder : allowed_) {
    places.push_back(fs::path(folder) / path);
    places.push_back(fs::path(folder) / within);
  }
  for (fs::path above = allowed_.front(); above.has_relative_path(); above = above.parent_path()) {
    if (above.filename() == package) places.push_back(above / within);
  }
  std::error_code error;
  for (const fs::path& place : places) {
    if (fs::exists(place, error)) return find(element, "", place.string());
  }
  element.reject(
      fmt::format("names the file \"{}\", and there is neither {} nor {}. Copy it there, or correct the name.", uri,
                  places[0].string(), places[1].string()));
}

}  // namespace pincer::tasks
