// mesh_builder: what all readers share: it takes vertices, normals and polygons as a file lists
// them, and makes a validated mesh of them.
//
// Every defect throws InputError at the place (MeshFile) that the reader gave with the vertex or face. Faces are
// checked at the end, since a file may give a face's vertices after it. Where ReadOptions::left_out is set, a face that
// is bad is told there and left out. Numbers in messages count as the format does, from `first_index`.
#pragma once
#include <span>
#include <vector>

#include "pincer/contact/mesh/mesh_file.h"
#include "pincer/contact/mesh/polygon.h"
#include "pincer/contact/mesh_reader.h"

namespace pincer::contact {

constexpr std::size_t kMaxTriangles = 2'000'000;         // chosen: 40 times what a finger feels
constexpr std::size_t kMaxVertices = 3 * kMaxTriangles;  // as in files that share none; also of normals
constexpr std::size_t kMaxCorners = 1000;                // of one polygon: ear clipping is quadratic
constexpr double kMaxCoordinate = 1000;                  // [m], chosen: finds a wrong unit
// The remedy where a face names a vertex that the file lacks.
constexpr const char* kCutOffOrJoined = "The file is cut off or was joined by hand; export it again.";

class MeshBuilder {
 public:
  // `file` and `options` must outlive this object. Throws InputError for a unit that isn't finite and above 0.
  MeshBuilder(const MeshFile& file, const ReadOptions& options, int first_index);

  // Make room; the caller has checked that the file can hold so many. More faces than
  // a mesh may have throw InputError at once.
  void reserveVertices(std::size_t vertices) { mesh_.vertices.reserve(vertices); }
  void reserveFaces(std::size_t faces, std::int32_t place);

  std::size_t vertices() const { return mesh_.vertices.size(); }
  std::size_t normals() const { return mesh_.normals.size(); }
  std::size_t faces() const { return faces_.size(); }
  // The next one's name in messages.
  std::size_t nextVertex() const { return vertices() + first_index_; }
  std::size_t nextNormal() const { return normals() + first_index_; }
  std::size_t nextFace() const { return faces() + first_index_; }

  void addVertex(const Vec3& p, std::int32_t place);  // in the file's unit, finite
  void addNormal(const Vec3& n, std::int32_t place);  // finite, of any length but zero
  // A face is begun, then gets its corners. Indices count from 0; `normal` -1 stands for none.
  // That they exist is checked at the end.
  void beginFace(std::int64_t corners, std::int32_t place);
  void addCorner(std::int64_t vertex, std::int64_t normal = -1);
  // Runs `read`, which reads corners of the face begun last. If that throws InputError and
  // bad faces are to be left out, this one is.
  template <class Read>
  void readCorners(Read&& read) {
    leaveOutIfBad(faces_.back(), read);
  }
  // Of the faces begun from here on; 0 for none.
  void setSmoothingGroup(std::int32_t group) { group_ = group; }
  // Likewise: the part that they are of, by the caller's numbers.
  void setPart(std::int32_t part) { part_ = part; }

  TriangleMesh build();
  // Of each triangle of the mesh, once it is built.
  const std::vector<std::int32_t>& parts() const { return parts_; }

 private:
  struct Corner {
    std::int32_t vertex;
    std::int32_t normal;
  };
  struct Face {
    std::size_t first_corner;
    std::int32_t place;
    std::int32_t group;
    std::int32_t part;
    bool is_left_out = false;
  };
  struct Polygon {
    std::size_t number;  // as messages count
    std::int32_t place;
    std::int32_t group;
    std::int32_t part;
    std::span<const Corner> corners;
  };

  template <class Use>
  void leaveOutIfBad(Face& face, Use&& use) {
    if (!options_.left_out) return use();
    try {
      use();
    } catch (const InputError& error) {
      if (!face.is_left_out) options_.left_out(error.what());
      face.is_left_out = true;
    }
  }
  void addPolygons();
  void cutOff(std::size_t triangles);
  Polygon polygon(std::size_t face) const;
  void requireFew(std::size_t triangles, std::int32_t place) const;
  void requireRoom(std::size_t count, const char* what, std::int32_t place) const;
  std::int32_t inRange(std::int64_t index, const char* what) const;
  void dropUnusedFeatures();
  void checkIndices(const Polygon& face) const;
  void rejectRepeatedVertex(const Polygon& face) const;
  void addPolygon(const Polygon& face);
  std::vector<CornerTriple> triplesOf(const Polygon& face) const;
  std::vector<CornerTriple> degenerateTriples(const std::vector<Vec3>& points) const;
  void addTriangle(const Polygon& face, const CornerTriple& triple);
  const Vec3& at(const Corner& c) const { return mesh_.vertices[static_cast<std::size_t>(c.vertex)]; }

  const MeshFile& file_;
  const ReadOptions& options_;
  std::size_t first_index_;
  TriangleMesh mesh_;
  std::vector<Face> faces_;
  std::vector<Corner> corners_;
  std::size_t triangles_ = 0;
  std::int32_t group_ = 0, part_ = 0;
  std::vector<std::int32_t> parts_;
};

}  // namespace pincer::contact
