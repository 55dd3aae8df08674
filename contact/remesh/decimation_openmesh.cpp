#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModBaseT.hh>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "pincer/contact/assert.h"
#include "pincer/contact/mesh/connectivity.h"
#include "pincer/contact/remesh/decimation.h"
#include "pincer/contact/remesh/vertex_normals.h"
#include "pincer/contact/surface/smooth_patch.h"

namespace pincer::contact {
namespace {

constexpr double kMostTurn = 0.5;     // cosine between a facet before and after: 60 degrees
constexpr double kMostLean = 0.3;     // cosine between a facet and its corners' normals: 72 degrees
constexpr double kSlenderest = 0.05;  // height over longest side
// weight of a move's length^4: in a plane, where all moves cost nothing, the short ones come first
constexpr double kShortFirst = 1e-12;

struct KernelTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
};
using Kernel = OpenMesh::TriMesh_ArrayKernelT<KernelTraits>;
using Attributes = OpenMesh::AttribKernelT<OpenMesh::FinalMeshItemsT<KernelTraits, true>, OpenMesh::TriConnectivity>;

}  // namespace
}  // namespace pincer::contact

// Compiled with the mesh although nobody asks for it; OpenMesh's own calls the C library's cosine, which other
// processors round otherwise.
template <>
inline bool OpenMesh::PolyMeshT<pincer::contact::Attributes>::is_estimated_feature_edge(HalfedgeHandle, Scalar) const {
  return false;
}

namespace pincer::contact {
namespace {

std::size_t indexOf(const OpenMesh::BaseHandle& handle) { return static_cast<std::size_t>(handle.idx()); }

// Cross product of two sides: twice the area, along the normal.
Vec3 facetOf(const std::array<Vec3, 3>& p) { return (p[1] - p[0]).cross(p[2] - p[0]); }

double slendernessOf(const std::array<Vec3, 3>& p) {
  const double longest2 =
      std::max({(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
  return longest2 > 0 ? facetOf(p).norm() / longest2 : 0;
}

struct Original {
  const std::vector<Vec3>& vertices;
  const VertexNormals& normals;
  double error;  // allowed [m]
};

// A triangle's smooth surface, and how far from it a point is.
class Sheet {
 public:
  Sheet(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals)
      : p0_(corners[0]),
        e_(corners[1] - corners[0]),
        f_(corners[2] - corners[0]),
        patch_(smoothPatch(corners, normals)) {
    const double ee = e_.squaredNorm(), ef = e_.dot(f_), ff = f_.squaredNorm(), det = ee * ff - ef * ef;
    dual_e_ = (ff * e_ - ef * f_) / det;
    dual_f_ = (ee * f_ - ef * e_) / det;
  }

  struct Fit {
    double distance2;  // from the flat triangle [m^2]
    double error;      // along the smooth surface's normal [m]
  };
  Fit fitOf(const Vec3& p) const {
    double u = std::max(dual_e_.dot(p - p0_), 0.0), v = std::max(dual_f_.dot(p - p0_), 0.0);
    const double scale = 1 / std::max(u + v, 1.0);
    u *= scale;
    v *= scale;
    const PatchPoint x = evaluate(patch_, u, v);
    return {(p0_ + u * e_ + v * f_ - p).squaredNorm(), std::abs((p - x.S).dot(x.N.normalized()))};
  }

 private:
  Vec3 p0_, e_, f_, dual_e_, dual_f_;
  Patch patch_;
};

// The one of a few sheets that a point belongs to, and its error: the worst of
// those that are as near, as at a common edge.
struct Home {
  std::size_t sheet = 0;
  double error = 0;
};
Home homeOf(const Vec3& p, const std::vector<Sheet>& sheets) {
  constexpr double kAsNear = 1.02;  // squared
  double nearest2 = kInfinity;
  Home home;
  std::array<Sheet::Fit, 32> fits{};
  const std::size_t count = std::min(fits.size(), sheets.size());
  for (std::size_t i = 0; i < count; ++i) {
    fits[i] = sheets[i].fitOf(p);
    if (fits[i].distance2 < nearest2) home.sheet = i;
    nearest2 = std::min(nearest2, fits[i].distance2);
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (fits[i].distance2 <= kAsNear * nearest2) home.error = std::max(home.error, fits[i].error);
  }
  return home;
}

// The rules and the cost of a move, for OpenMesh's decimater.
class MoveRules : public OpenMesh::Decimater::ModBaseT<Kernel> {
 public:
  using Handle = OpenMesh::Decimater::ModHandleT<MoveRules>;
  using Move = CollapseInfo;  // vertex v0 onto v1

  explicit MoveRules(Kernel& kernel) : ModBaseT<Kernel>(kernel, false) {}
  void setOriginal(const Original* shape) { original_ = shape; }

  void initialize() override {
    middle_ = Vec3::Zero();
    for (const Vec3& p : original_->vertices) middle_ += p / static_cast<double>(original_->vertices.size());
    quadrics_.assign(original_->vertices.size(), Quadric::Zero());
    gone_.resize(mesh().n_faces());
    for (const auto face : mesh().faces()) {
      const auto corners = cornersOf(mesh().halfedge_handle(face));
      const Vec3 facet = facetOf(placesOf(corners));
      const double area = facet.norm() / 2;
      if (area == 0) continue;
      const Vec3 n = facet / (2 * area);
      Eigen::Vector4d plane;
      plane << n, -n.dot(original_->vertices[corners[0]] - middle_);
      for (const std::size_t v : corners) quadrics_[v] += area * plane * plane.transpose();
    }
  }

  float collapse_priority(const Move& move) override {
    if (!mayMove(move) || !keepsFacets(move) || !staysNear(move)) return static_cast<float>(ILLEGAL_COLLAPSE);
    const Vec3 &p0 = place(move.v0), &p1 = place(move.v1);
    Eigen::Vector4d p;
    p << p1 - middle_, 1;
    const double length2 = (p1 - p0).squaredNorm();
    return static_cast<float>(std::max(p.dot(quadrics_[indexOf(move.v0)] * p), 0.0) + kShortFirst * length2 * length2);
  }

  void preprocess_collapse(const Move& move) override { rehouse(move); }
  void postprocess_collapse(const Move& move) override { quadrics_[indexOf(move.v1)] += quadrics_[indexOf(move.v0)]; }

 private:
  using Quadric = Eigen::Matrix4d;
  using Corners = std::array<std::size_t, 3>;

  const Vec3& place(Kernel::VertexHandle v) const { return original_->vertices[indexOf(v)]; }
  std::array<Vec3, 3> placesOf(const Corners& c) const {
    return {original_->vertices[c[0]], original_->vertices[c[1]], original_->vertices[c[2]]};
  }
  // From the vertex that the half-edge leaves.
  Corners cornersOf(Kernel::HalfedgeHandle h) {
    return {indexOf(mesh().from_vertex_handle(h)), indexOf(mesh().to_vertex_handle(h)),
            indexOf(mesh().to_vertex_handle(mesh().next_halfedge_handle(h)))};
  }

  bool mayMove(const Move& move) {
    const std::size_t v = indexOf(move.v0);
    if (original_->normals.stays[v]) return false;
    return !original_->normals.on_crease[v] || isCrease(move);
  }

  // True if the two sides of the way have normals of their own, or if it is a border.
  bool isCrease(const Move& move) {
    if (mesh().is_boundary(move.v0v1) || mesh().is_boundary(move.v1v0)) return true;
    const auto normalAt = [&](Kernel::HalfedgeHandle h) {
      return original_->normals.nearest(indexOf(move.v0), facetOf(placesOf(cornersOf(h))));
    };
    return normalAt(move.v0v1) != normalAt(move.v1v0);
  }

  double leastLean(const Corners& corners, const Vec3& facet) const {
    double least = 1;
    for (const std::size_t v : corners) least = std::min(least, original_->normals.nearest(v, facet).dot(facet));
    return least;
  }

  bool keepsFacets(const Move& move) {
    const std::size_t v1 = indexOf(move.v1);
    for (const auto h : mesh().voh_range(move.v0)) {
      if (mesh().is_boundary(h)) continue;
      const Corners before = cornersOf(h), after = {v1, before[1], before[2]};
      if (before[1] != v1 && before[2] != v1 && !isFit(before, after)) return false;
    }
    return true;
  }

  // A triangle that was as bad before may stay so.
  bool isFit(const Corners& before, const Corners& after) const {
    const auto p = placesOf(before), q = placesOf(after);
    const Vec3 old_facet = facetOf(p).normalized(), facet = facetOf(q).normalized();
    if (!old_facet.isZero() && facet.dot(old_facet) < kMostTurn) return false;
    const double slenderness = slendernessOf(q);
    if (slenderness < kSlenderest && slenderness < slendernessOf(p)) return false;
    const double lean = leastLean(after, facet);
    return lean >= kMostLean || lean >= leastLean(before, old_facet);
  }

  // The facets around vertex 0 once it has moved, and who is to be near them.
  struct Outcome {
    std::vector<std::size_t> faces;
    std::vector<Sheet> sheets;
    std::vector<std::size_t> gone;  // vertices, vertex 0 among them
  };
  void foresee(const Move& move, Outcome& outcome) {
    const std::size_t v1 = indexOf(move.v1);
    outcome.faces.clear();
    outcome.sheets.clear();
    outcome.gone.assign(1, indexOf(move.v0));
    for (const auto h : mesh().voh_range(move.v0)) {
      if (mesh().is_boundary(h)) continue;
      const std::size_t face = indexOf(mesh().face_handle(h));
      for (const Gone& g : gone_[face]) outcome.gone.push_back(g.vertex);
      const Corners c = cornersOf(h);
      if (c[1] == v1 || c[2] == v1) continue;
      const Corners after = {v1, c[1], c[2]};
      const auto p = placesOf(after);
      const Vec3 facet = facetOf(p);
      const VertexNormals& n = original_->normals;
      outcome.faces.push_back(face);
      outcome.sheets.emplace_back(
          p, std::array{n.nearest(after[0], facet), n.nearest(after[1], facet), n.nearest(after[2], facet)});
    }
  }

  bool staysNear(const Move& move) {
    if (original_->error == kInfinity) return true;
    foresee(move, outcome_);
    return std::all_of(outcome_.gone.begin(), outcome_.gone.end(), [&](std::size_t v) {
      return homeOf(original_->vertices[v], outcome_.sheets).error <= original_->error;  // false where it isn't finite
    });
  }

  void rehouse(const Move& move) {
    constexpr std::size_t kMostGone = 8;  // vertices per face at which the error is measured
    foresee(move, outcome_);
    for (const auto h : mesh().voh_range(move.v0)) {
      if (!mesh().is_boundary(h)) gone_[indexOf(mesh().face_handle(h))].clear();
    }
    for (const std::size_t v : outcome_.gone) {
      const Home home = homeOf(original_->vertices[v], outcome_.sheets);
      std::vector<Gone>& list = gone_[outcome_.faces[home.sheet]];
      list.push_back({v, home.error});
      if (list.size() <= kMostGone) continue;
      list.erase(
          std::min_element(list.begin(), list.end(), [](const Gone& a, const Gone& b) { return a.error < b.error; }));
    }
  }

  struct Gone {
    std::size_t vertex;
    double error;
  };

  const Original* original_ = nullptr;
  std::vector<std::vector<Gone>> gone_;  // per face
  Outcome outcome_;
  Vec3 middle_ = Vec3::Zero();
  std::vector<Quadric> quadrics_;
};

}  // namespace

class Decimation::Data {
 public:
  Data(const TriangleMesh& mesh, double crease_angle, bool use_file_normals, const std::vector<bool>& stays)
      : input_(mesh),
        corners_(findCornerNormals(mesh, findNeighbours(mesh), crease_angle, use_file_normals)),
        normals_(mesh, corners_, stays),
        original_{input_.vertices, normals_, kInfinity},
        triangles_(static_cast<int>(mesh.triangles.size())) {
    for (const Vec3& p : mesh.vertices) kernel_.add_vertex({p.x(), p.y(), p.z()});
    for (const auto& [a, b, c] : mesh.triangles) {
      kernel_.add_face(OpenMesh::VertexHandle(a), OpenMesh::VertexHandle(b), OpenMesh::VertexHandle(c));
    }
    PINCER_ASSERT(kernel_.n_faces() == mesh.triangles.size());  // so that faces count as triangles do
    decimater_.add(rules_);
    decimater_.module(rules_).setOriginal(&original_);
    decimater_.initialize();
  }

  int triangles() const { return triangles_; }

  void reduceTo(int triangles, double error) {
    original_.error = error;
    while (triangles_ > triangles) {
      // each takes two triangles, on a border one
      const auto moves = static_cast<std::size_t>((triangles_ - triangles + 1) / 2);
      if (decimater_.decimate(moves) == 0) return;
      triangles_ = 0;
      for (const auto face : kernel_.all_faces()) triangles_ += !kernel_.status(face).deleted();
    }
  }

  TriangleMesh mesh() const {
    TriangleMesh result;
    result.source = input_.source;
    std::vector<std::int32_t> number(input_.vertices.size(), -1);
    for (const auto v : kernel_.all_vertices()) {
      if (kernel_.status(v).deleted() || kernel_.is_isolated(v)) continue;
      number[indexOf(v)] = static_cast<std::int32_t>(result.vertices.size());
      result.vertices.push_back(Vec3(input_.vertices[indexOf(v)]));
    }
    for (const auto face : kernel_.all_faces()) {
      if (!kernel_.status(face).deleted()) addTriangle(face, number, result);
    }
    return result;
  }

 private:
  // A corner that never moved keeps its own normal; one that did gets that which belongs to the facet.
  void addTriangle(Kernel::FaceHandle face, const std::vector<std::int32_t>& number, TriangleMesh& result) const {
    const auto& before = input_.triangles[indexOf(face)];
    std::array<std::size_t, 3> v{};
    std::size_t i = 0;
    for (const auto vertex : kernel_.fv_range(face)) v[i++] = indexOf(vertex);
    const auto& p = input_.vertices;
    const Vec3 facet = facetOf({p[v[0]], p[v[1]], p[v[2]]});
    const auto first = static_cast<std::int32_t>(result.normals.size());
    result.triangles.push_back({number[v[0]], number[v[1]], number[v[2]]});
    result.triangle_normals.push_back({first, first + 1, first + 2});
    for (const std::size_t corner : v) {
      const auto own = std::find(before.begin(), before.end(), static_cast<std::int32_t>(corner));
      result.normals.push_back(own == before.end()
                                   ? Vec3(normals_.nearest(corner, facet))
                                   : corners_.normals[indexOf(face)][static_cast<std::size_t>(own - before.begin())]);
    }
  }

  const TriangleMesh input_;
  const CornerNormals corners_;
  const VertexNormals normals_;
  Original original_;
  int triangles_;
  Kernel kernel_;
  OpenMesh::Decimater::DecimaterT<Kernel> decimater_{kernel_};
  MoveRules::Handle rules_;
};

Decimation::Decimation(const TriangleMesh& mesh, double crease_angle, bool use_file_normals,
                       const std::vector<bool>& stays)
    : data_(std::make_unique<Data>(mesh, crease_angle, use_file_normals, stays)) {}
Decimation::~Decimation() = default;

int Decimation::triangles() const { return data_->triangles(); }
void Decimation::reduceTo(int triangles, double error) { data_->reduceTo(triangles, error); }
TriangleMesh Decimation::mesh() const { return data_->mesh(); }

}  // namespace pincer::contact
