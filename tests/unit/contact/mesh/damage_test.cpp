// Damaged files of every format: each is refused with an InputError that names the file, or is a valid mesh; nothing
// else may happen. A few thousand per format; with PINCER_LONG_TESTS set, a hundred thousand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh/mesh_writer.h"
#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/tests/support/effort.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::contact {
namespace {

using tests::RandomNumbers;

TriangleMesh featured() {
  TriangleMesh mesh = icosphere(0.5, 0);
  for (const Vec3& p : mesh.vertices) mesh.normals.push_back(p.normalized());
  mesh.triangle_normals = mesh.triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    mesh.smoothing_groups.push_back(static_cast<std::int32_t>(t) / 7);
  return mesh;
}

std::string bigEndianPly(const TriangleMesh& mesh) {
  std::string bytes = formatMesh(mesh, MeshFormat::ply);
  bytes.replace(bytes.find("little"), 6, "big");
  std::size_t at = bytes.find("end_header\n") + 11;
  const auto swap = [&](std::size_t size) {
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                 bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
    at += size;
  };
  for (std::size_t i = 0; i < 6 * mesh.vertices.size(); ++i) swap(8);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    ++at;
    for (int i = 0; i < 3; ++i) swap(4);
  }
  return bytes;
}

// Lines of a text format that the writers don't write.
std::string oddities(MeshFormat format) {
  switch (format) {
    case MeshFormat::obj:
      return "vn 0 0 1\nvt 0 0\nf 1/1/1 2/1/1 3/1/1\nf 1//1 12//1 6//1 2//1\nf -1 -2 \\\n-3\n# end\n";
    case MeshFormat::stl:
      return "solid\nendsolid\n";
    default:
      return "";
  }
}

struct Sound {
  const char* name;
  MeshFormat format;
  std::string bytes;
};

std::vector<Sound> soundFiles() {
  const TriangleMesh mesh = featured();
  const auto text = [&](MeshFormat format) { return formatMesh(mesh, format, {.ascii = true}) + oddities(format); };
  return {{"OBJ", MeshFormat::obj, text(MeshFormat::obj)},
          {"ascii STL", MeshFormat::stl, text(MeshFormat::stl)},
          {"binary STL", MeshFormat::stl, formatMesh(mesh, MeshFormat::stl)},
          {"ascii PLY", MeshFormat::ply, text(MeshFormat::ply)},
          {"little-endian PLY", MeshFormat::ply, formatMesh(mesh, MeshFormat::ply)},
          {"big-endian PLY", MeshFormat::ply, bigEndianPly(mesh)},
          {"OFF", MeshFormat::off, text(MeshFormat::off)}};
}

// In place of the number (or of four bytes) at `at`.
void blowUp(std::string& bytes, std::size_t at, RandomNumbers& random) {
  constexpr std::array kNumbers = {"4294967295", "2147483647", "-1",   "0",      "99999999999999999999",
                                   "1e308",      "nan",        "-inf", "1e-320", "1000000"};
  constexpr std::array<std::uint32_t, 6> kBits = {0xffffffff, 0x7fffffff, 0x80000000, 0x7fc00000, 0x00ffffff, 0};
  const auto is_digit = [&](std::size_t i) { return i < bytes.size() && bytes[i] >= '0' && bytes[i] <= '9'; };
  if (is_digit(at)) {
    std::size_t end = at;
    while (is_digit(end)) ++end;
    bytes.replace(at, end - at, kNumbers[static_cast<std::size_t>(random.below(kNumbers.size()))]);
  } else if (at + 4 <= bytes.size()) {
    std::memcpy(bytes.data() + at, &kBits[static_cast<std::size_t>(random.below(kBits.size()))], 4);
  }
}

std::string damaged(std::string bytes, RandomNumbers& random) {
  constexpr int kLongest = 60;
  const auto place = [&] { return static_cast<std::size_t>(random.below(static_cast<int>(bytes.size()))); };
  const auto length = [&] { return static_cast<std::size_t>(random.below(kLongest)); };
  for (int k = random.below(3); k >= 0 && !bytes.empty(); --k) {
    const std::size_t at = place();
    switch (random.below(7)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
        break;
      case 1:
        bytes[at] = "0123456789-+./ \nefvnt\\#"[random.below(23)];
        break;
      case 2:
        bytes.erase(at, length());
        break;
      case 3:
        bytes.insert(at, bytes.substr(place(), length()));
        break;
      case 4:
        if (random.below(4) == 0) bytes.resize(at);
        break;
      default:
        blowUp(bytes, at, random);
    }
  }
  return bytes;
}

void expectValid(const TriangleMesh& mesh, std::size_t bytes, bool may_be_degenerate) {
  const auto below = [](std::int32_t i, std::size_t n) { return i < static_cast<std::int64_t>(n); };
  bool finite = true, in_range = true, distinct = true;
  for (const Vec3& v : mesh.vertices) finite = finite && v.allFinite();
  for (const Vec3& n : mesh.normals) finite = finite && std::abs(n.norm() - 1) < 1e-14;  // round-off of a normalisation
  for (const auto& t : mesh.triangles) {
    for (const std::int32_t v : t) in_range = in_range && v >= 0 && below(v, mesh.vertices.size());
    distinct = distinct && t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
  }
  for (const auto& t : mesh.triangle_normals) {
    for (const std::int32_t n : t) in_range = in_range && n >= -1 && below(n, mesh.normals.size());
  }
  EXPECT_TRUE(finite);
  EXPECT_TRUE(in_range);
  EXPECT_TRUE(distinct || may_be_degenerate);
  EXPECT_FALSE(mesh.triangles.empty());
  EXPECT_TRUE(mesh.triangle_normals.empty() || mesh.triangle_normals.size() == mesh.triangles.size());
  EXPECT_TRUE(mesh.smoothing_groups.empty() || mesh.smoothing_groups.size() == mesh.triangles.size());
  EXPECT_LE(mesh.vertices.capacity() + mesh.triangles.capacity(), bytes) << "each takes several bytes of the file";
  if (in_range && distinct) inspect(mesh);
}

int budget() { return tests::draws(3'000, 33); }

TEST(MeshDamage, IsRefusedByNameOrHarmless) {
  for (const Sound& sound : soundFiles()) {
    SCOPED_TRACE(sound.name);
    ASSERT_NO_THROW(parseMesh(sound.bytes, sound.format, "part"));
    RandomNumbers random(20);
    const int count = budget();
    int refused = 0;
    for (int i = 0; i < count; ++i) {
      const std::string bytes = damaged(sound.bytes, random);
      const ReadOptions options{.degenerate = i % 2 ? Degenerate::keep : Degenerate::reject};
      try {
        expectValid(parseMesh(bytes, sound.format, "part", options), bytes.size(), i % 2);
      } catch (const InputError& error) {
        ++refused;
        ASSERT_TRUE(std::string(error.what()).starts_with("part:")) << error.what();
      }
      if (HasFailure()) FAIL() << "damage number " << i;
    }
    EXPECT_GT(refused, count / 10) << "the damage should be real";
    EXPECT_LT(refused, count) << "and not always fatal";
  }
}

// OBJ announces no counts, so that it can be cut off between two lines without a trace.
TEST(MeshDamage, ACutOffFileIsNeverTakenForAWholeOne) {
  int formats = 0;
  for (const Sound& sound : soundFiles()) {
    if (sound.format == MeshFormat::obj) continue;
    ++formats;
    for (std::size_t size = 0; size < sound.bytes.size() - oddities(sound.format).size() - 20; ++size) {
      EXPECT_THROW(parseMesh(sound.bytes.substr(0, size), sound.format, "part"), InputError)
          << sound.name << " of " << size << " bytes";
    }
  }
  EXPECT_GE(formats, 6);
}

}  // namespace
}  // namespace pincer::contact
