#include "pincer/contact/mesh/mesh_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "pincer/contact/assert.h"
#include "pincer/contact/io/printable.h"
#include "pincer/contact/mesh/mesh_bytes.h"
#include "pincer/contact/mesh/obj_reader.h"

namespace pincer::contact {

namespace {

constexpr std::string_view kUnnamed = "default";
constexpr std::size_t kMostGroups = 10'000;  // chosen: ten times the shapes that a body may have

// One part, while triangles come to it: what it has of the whole mesh's vertices and normals, by new numbers.
class GroupBuilder {
 public:
  GroupBuilder(const TriangleMesh& whole, std::string_view name) : whole_(whole) {
    group_.name = name;
    group_.mesh.source = fmt::format("{}, part \"{}\"", whole.source, printable(name));
  }

  void add(std::size_t triangle) {
    TriangleMesh& mesh = group_.mesh;
    mesh.triangles.push_back(renumbered(whole_.triangles[triangle], whole_.vertices, vertex_, mesh.vertices));
    if (!whole_.triangle_normals.empty())
      mesh.triangle_normals.push_back(
          renumbered(whole_.triangle_normals[triangle], whole_.normals, normal_, mesh.normals));
    if (!whole_.smoothing_groups.empty()) mesh.smoothing_groups.push_back(whole_.smoothing_groups[triangle]);
  }
  MeshGroup take() { return std::move(group_); }

 private:
  using Numbers = std::unordered_map<std::int32_t, std::int32_t>;

  static std::array<std::int32_t, 3> renumbered(const std::array<std::int32_t, 3>& old, const std::vector<Vec3>& from,
                                                Numbers& numbers, std::vector<Vec3>& to) {
    std::array<std::int32_t, 3> now{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (old[i] < 0) {
        now[i] = old[i];
        continue;
      }
      const auto [place, is_new] = numbers.emplace(old[i], static_cast<std::int32_t>(to.size()));
      if (is_new) to.push_back(from[static_cast<std::size_t>(old[i])]);
      now[i] = place->second;
    }
    return now;
  }

  const TriangleMesh& whole_;
  MeshGroup group_;
  Numbers vertex_, normal_;
};

}  // namespace

std::vector<MeshGroup> splitByName(const TriangleMesh& mesh, std::span<const std::string_view> names) {
  PINCER_ASSERT(names.size() == mesh.triangles.size());
  if (std::all_of(names.begin(), names.end(), [](std::string_view name) { return name.empty(); })) {
    throw InputError(
        fmt::format("{}: none of its faces stands under a name (\"o\" or \"g\"), so it has no parts. Export each solid "
                    "as an object of its own.",
                    mesh.source));
  }
  std::unordered_map<std::string_view, std::size_t> number;
  std::vector<GroupBuilder> builders;
  for (std::size_t t = 0; t < names.size(); ++t) {
    const std::string_view name = names[t].empty() ? kUnnamed : names[t];
    const auto [place, is_new] = number.emplace(name, builders.size());
    if (is_new && builders.size() == kMostGroups)
      throw InputError(
          fmt::format("{}: it has more than {} named parts. Join some of them.", mesh.source, kMostGroups));
    if (is_new) builders.emplace_back(mesh, name);
    builders[place->second].add(t);
  }
  std::vector<MeshGroup> groups;
  for (GroupBuilder& builder : builders) groups.push_back(builder.take());
  return groups;
}

std::vector<MeshGroup> readMeshGroups(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string bytes = readMeshBytes(path);
  return parseMeshGroups(bytes, formatOf(bytes, path.string()), path.string(), options);
}

std::vector<MeshGroup> parseMeshGroups(std::string_view bytes, MeshFormat format, const std::string& name,
                                       const ReadOptions& options) {
  requireMeshBytes(bytes, name);
  if (format != MeshFormat::obj) {
    throw InputError(
        fmt::format("{}: {} files give their parts no names; only OBJ does. Export it as OBJ.", name, nameOf(format)));
  }
  MeshFile file(bytes, name, options.progress);
  std::vector<MeshGroup> groups = readObjGroups(file, options);
  if (options.progress) options.progress(1);
  return groups;
}

}  // namespace pincer::contact
