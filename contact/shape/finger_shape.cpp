#include "pincer/contact/finger_shape.h"

#include <fmt/format.h>

#include <algorithm>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/shape/closed_forms.h"

namespace pincer::contact {
namespace {

// of a pad's axes as their author wrote them: buildGrasp takes lengths within 1e-6
[[maybe_unused]] constexpr double kUnitByHand = 1e-5;

double leastCurvatureRadius(const Vec3& a) { return a.minCoeff() * a.minCoeff() / a.maxCoeff(); }

Vec3 ellipsoidSupport(const Vec3& a, const Vec3& d) {
  const Vec3 ad = a.cwiseProduct(d);
  return a.cwiseProduct(ad) / ad.norm();
}

// x_i = a_i^2 y_i / (t + a_i^2) with the root t of sum (a_i y_i / (t + a_i^2))^2 = 1: convex and
// falling, so that Newton's method from its left never overshoots. Source: D. Eberly, Distance from a
// point to an ellipsoid, 2013 (the equation).
Vec3 nearestOnEllipsoid(const Vec3& a, const Vec3& y) {
  const Vec3 a2 = a.cwiseAbs2();
  double t = std::max(0.0, (a.cwiseProduct(y.cwiseAbs()) - a2).maxCoeff());
  for (int i = 0; i < 60; ++i) {
    const Vec3 q = a.cwiseProduct(y).cwiseQuotient(a2 + Vec3::Constant(t));
    const double g = q.squaredNorm() - 1;
    const double slope = -2 * q.cwiseAbs2().cwiseQuotient(a2 + Vec3::Constant(t)).sum();
    const double step = -g / slope;
    t += step;
    if (!(step > 1e-15 * (t + a2.minCoeff()))) break;
  }
  return a2.cwiseProduct(y).cwiseQuotient(a2 + Vec3::Constant(t));
}

struct CoreOf {
  const Vec3& p;
  const Vec3& d;

  Vec3 operator()(const Sphere&) const { return Vec3::Zero(); }
  Vec3 operator()(const CapsuleTip& c) const {
    return std::clamp(p.dot(c.half_F) / c.half_F.squaredNorm(), -1.0, 1.0) * c.half_F;
  }
  Vec3 operator()(const EllipsoidTip& e) const {
    const double rho = leastCurvatureRadius(e.semi_axes);
    if (p.cwiseQuotient(e.semi_axes).squaredNorm() <= 1) return ellipsoidSupport(e.semi_axes, d) - rho * d;
    const Vec3 x = nearestOnEllipsoid(e.semi_axes, p);
    return x - rho * x.cwiseQuotient(e.semi_axes.cwiseAbs2()).normalized();
  }
  Vec3 operator()(const PadTip& pad) const {
    const NearestPoint near = nearestPoint(Convex{pad.hull}, p);
    return near.distance > 0 ? near.p_BS : pad.hull->vertices()[static_cast<std::size_t>(pad.hull->extremeVertex(d))];
  }
};

struct CoreSupport {
  const Vec3& d;

  Vec3 operator()(const Sphere&) const { return Vec3::Zero(); }
  Vec3 operator()(const CapsuleTip& c) const { return signOf(c.half_F.dot(d)) * c.half_F; }
  Vec3 operator()(const EllipsoidTip& e) const {
    return ellipsoidSupport(e.semi_axes, d) - leastCurvatureRadius(e.semi_axes) * d;
  }
  Vec3 operator()(const PadTip& pad) const {
    return pad.hull->vertices()[static_cast<std::size_t>(pad.hull->extremeVertex(d))];
  }
};

// The unit direction at share `s` of the turn from a to b.
Vec3 directionBetween(const Vec3& a, const Vec3& b, double angle, double s) {
  if (angle < 1e-9) return b;
  Vec3 across = b - b.dot(a) * a;
  if (across.norm() < 1e-12) across = frameFromNormal(a).col(0);  // opposite: any way round
  return math::cos(s * angle) * a + math::sin(s * angle) * across.normalized();
}

}  // namespace

double roundingOf(const FingerShape& finger) {
  if (const auto* sphere = std::get_if<Sphere>(&finger)) return sphere->radius;
  if (const auto* capsule = std::get_if<CapsuleTip>(&finger)) return capsule->radius;
  if (const auto* pad = std::get_if<PadTip>(&finger)) return pad->rounding;
  return leastCurvatureRadius(std::get<EllipsoidTip>(finger).semi_axes);
}

double boundingRadiusOf(const FingerShape& finger) {
  if (const auto* sphere = std::get_if<Sphere>(&finger)) return sphere->radius;
  if (const auto* capsule = std::get_if<CapsuleTip>(&finger)) return capsule->radius + capsule->half_F.norm();
  if (const auto* pad = std::get_if<PadTip>(&finger)) return pad->rounding + pad->hull->boundingRadius();
  return std::get<EllipsoidTip>(finger).semi_axes.maxCoeff();
}

Vec3 coreSupportOf(const FingerShape& finger, const Vec3& d_F) { return std::visit(CoreSupport{d_F}, finger); }

Vec3 supportOf(const FingerShape& finger, const Vec3& d_F) {
  PINCER_ASSERT(!(std::abs(d_F.squaredNorm() - 1) > kUnitByHand));
  return coreSupportOf(finger, d_F) + roundingOf(finger) * d_F;
}

Vec3 nearestOnCore(const FingerShape& finger, const Vec3& p_F, const Vec3& d_F) {
  PINCER_ASSERT(isUnitIfFinite(d_F));
  return std::visit(CoreOf{p_F, d_F}, finger);
}

double arcOverSkin(const FingerShape& finger, const Vec3& from_F, const Vec3& normal_F, const Vec3& to_F) {
  PINCER_ASSERT(!(std::abs(from_F.squaredNorm() - 1) > kUnitByHand));
  PINCER_ASSERT(isUnitIfFinite(normal_F));
  const double angle = angleBetween(from_F, normal_F), rho = roundingOf(finger);
  double arc = rho * angle;
  if (std::holds_alternative<Sphere>(finger)) return arc;
  constexpr int kChords = 32;  // short of the arc by a (24 * 32^2)-th of its angle squared
  Vec3 last = coreSupportOf(finger, from_F);
  for (int i = 1; i <= kChords; ++i) {
    const Vec3 next = i == kChords
                          ? Vec3(to_F - rho * normal_F)
                          : coreSupportOf(finger, directionBetween(from_F, normal_F, angle, double(i) / kChords));
    arc += (next - last).norm();
    last = next;
  }
  return arc;
}

std::string problemWith(const FingerShape& finger) {
  const auto good = [](double length) { return length > 0 && length <= 1; };
  if (const auto* sphere = std::get_if<Sphere>(&finger)) {
    if (!good(sphere->radius))
      return fmt::format("radius = {} is out of range (0, 1]. It is in metres; a fingertip has about 0.008.",
                         sphere->radius);
  } else if (const auto* capsule = std::get_if<CapsuleTip>(&finger)) {
    if (!good(capsule->radius))
      return fmt::format("radius = {} is out of range (0, 1]. It is in metres; a fingertip has about 0.008.",
                         capsule->radius);
    if (!good(2 * capsule->half_F.norm()))
      return fmt::format("length = {} is out of range (0, 1]. It is in metres.", 2 * capsule->half_F.norm());
  } else if (const auto* ellipsoid = std::get_if<EllipsoidTip>(&finger)) {
    const Vec3& a = ellipsoid->semi_axes;
    if (!(good(a.minCoeff()) && good(a.maxCoeff()) && a.maxCoeff() <= 10 * a.minCoeff())) {
      return fmt::format(
          "semi_axes = ({}, {}, {}) are out of range: each in (0, 1] m, and none more than ten times another.", a.x(),
          a.y(), a.z());
    }
  } else {
    const auto& pad = std::get<PadTip>(finger);
    if (!pad.hull) return "pad: it has no points.";
    if (!good(pad.rounding))
      return fmt::format("rounding = {} is out of range (0, 1]. It is in metres; 0.0005 suits a fingerpad.",
                         pad.rounding);
  }
  return "";
}

}  // namespace pincer::contact
