#include "jobs/import/pbrt/pbrt_transforms.h"

#include <fmt/format.h>

#include <numbers>

#include "jobs/import/pbrt/pbrt_parameters.h"

namespace lacuna::pbrt {
namespace {

/// The next N numbers, which may stand in brackets.
template <std::size_t N>
std::array<double, N> numbers(std::string_view name, Tokens& tokens, const Place& place) {
  const bool brackets = tokens.peek() && tokens.peek()->kind == Token::Kind::open;
  if (brackets) tokens.next();
  std::array<double, N> out;
  for (double& x : out) {
    const auto token = tokens.next();
    const auto value =
        token && token->kind == Token::Kind::word ? number_of(token->text) : std::nullopt;
    if (!value) {
      fail(token ? token->place : place,
           fmt::format("{}: found {}; expected {} finite numbers", name,
                       token ? token->text : "the end of the file", N));
    }
    x = *value;
  }
  if (!brackets) return out;
  const auto token = tokens.next();
  if (token && token->kind == Token::Kind::close) return out;
  fail(place, fmt::format("{}: expected ] after {} numbers", name, N));
}

/// Camera from world: the camera at `eye` looks along its z axis, y is up, and x is to the right in
/// pbrt's left-handed coordinates.
M44d look_at(const std::array<double, 9>& n, const Place& place) {
  const V3d eye(n[0], n[1], n[2]), target(n[3], n[4], n[5]), up(n[6], n[7], n[8]);
  const V3d ahead = (target - eye).normalized();
  const V3d right = up.normalized().cross(ahead).normalized();
  if (!(right.length() > 0.5)) {
    fail(place,
         "LookAt: the eye is the target, or the up vector is parallel to the view direction");
  }
  const V3d y = ahead.cross(right);
  const M44d world_from_camera(right.x, right.y, right.z, 0, y.x, y.y, y.z, 0, ahead.x, ahead.y,
                               ahead.z, 0, eye.x, eye.y, eye.z, 1);
  return world_from_camera.inverse();
}

M44d matrix_of(const std::array<double, 16>& n) {
  M44d m;
  for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = n[static_cast<std::size_t>(i)];
  return m;
}

const M44d& checked(std::string_view name, const M44d& m, const Place& place) {
  if (m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1) return m;
  fail(place, fmt::format("{}: the matrix is projective; allowed: affine ones", name));
}

}  // namespace

bool is_singular(const M44d& m) {
  // Relative to the volume that rows of these lengths could span.
  double span = 1;
  for (int i = 0; i < 3; ++i) span *= V3d(m[i][0], m[i][1], m[i][2]).length();
  const double volume = V3d(m[0][0], m[0][1], m[0][2])
                            .cross(V3d(m[1][0], m[1][1], m[1][2]))
                            .dot(V3d(m[2][0], m[2][1], m[2][2]));
  return !(std::abs(volume) > 1e-14 * span);
}

void CurrentTransform::set(const M44d& m) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (active_[i]) at_[i] = m;
  }
}

void CurrentTransform::concatenate(const M44d& t) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (active_[i]) at_[i] = t * at_[i];
  }
}

void CurrentTransform::activate(const Token& which) {
  if (which.text != "All" && which.text != "StartTime" && which.text != "EndTime") {
    fail(which.place,
         fmt::format("ActiveTransform {}; allowed: All, StartTime, EndTime", which.text));
  }
  active_ = {which.text != "EndTime", which.text != "StartTime"};
}

bool read_transform(std::string_view name, Tokens& tokens, const Place& place,
                    CurrentTransform& ctm) {
  if (name == "Identity") {
    ctm.set(M44d());
  } else if (name == "Translate") {
    const auto n = numbers<3>(name, tokens, place);
    ctm.concatenate(M44d().setTranslation(V3d(n[0], n[1], n[2])));
  } else if (name == "Scale") {
    const auto n = numbers<3>(name, tokens, place);
    ctm.concatenate(M44d().setScale(V3d(n[0], n[1], n[2])));
  } else if (name == "Rotate") {
    const auto n = numbers<4>(name, tokens, place);
    const V3d axis(n[1], n[2], n[3]);
    if (axis.length() == 0) fail(place, "Rotate: the axis is 0 0 0");
    ctm.concatenate(M44d().setAxisAngle(axis.normalized(), n[0] * std::numbers::pi / 180));
  } else if (name == "LookAt") {
    ctm.concatenate(look_at(numbers<9>(name, tokens, place), place));
  } else if (name == "ConcatTransform") {
    ctm.concatenate(checked(name, matrix_of(numbers<16>(name, tokens, place)), place));
  } else if (name == "Transform") {
    ctm.set(checked(name, matrix_of(numbers<16>(name, tokens, place)), place));
  } else {
    return false;
  }
  return true;
}

}  // namespace lacuna::pbrt
