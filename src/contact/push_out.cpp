#include "evert/contact/push_out.hpp"

#include "evert/contact/velocity_constraints.hpp"
#include "evert/math/eigen_symmetric3.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace evert {
namespace {

// Of the largest bound: closer than this, bounds are obeyed.
constexpr double tolerance = 1e-12;
// Sine of the angle, or the volume, below which normals count as dependent.
constexpr double independent = 1e-7;

bool obeys(const Vec3d& change, std::span<const Bound> bounds, double slack) {
  return std::all_of(bounds.begin(), bounds.end(),
                     [&](const Bound& bound) { return dot(bound.normal, change) >= bound.least - slack; });
}

/// The shortest vector on both planes, if pushing off both is what leads there.
std::optional<Vec3d> on_two(const Bound& a, const Bound& b) {
  const double cosine = dot(a.normal, b.normal), determinant = 1 - cosine * cosine;
  if (determinant < independent * independent) return {};
  const double from_a = a.least - cosine * b.least, from_b = b.least - cosine * a.least;
  if (from_a < 0 || from_b < 0) return {};
  return (1 / determinant) * (from_a * a.normal + from_b * b.normal);
}

/// The point on three planes, if pushing off all of them is what leads there.
std::optional<Vec3d> on_three(const Bound& a, const Bound& b, const Bound& c) {
  const std::array reciprocal{cross(b.normal, c.normal), cross(c.normal, a.normal),
                              cross(a.normal, b.normal)};
  const double volume = dot(a.normal, reciprocal[0]);
  if (std::abs(volume) < independent) return {};
  const auto point =
      (1 / volume) * (a.least * reciprocal[0] + b.least * reciprocal[1] + c.least * reciprocal[2]);
  // point = Σ s_k n_k with s_k = (reciprocal_k · point) / volume
  for (const auto& direction : reciprocal)
    if (dot(direction, point) * volume < 0) return {};
  return point;
}

double violation(std::span<const Bound> bounds, const Vec3d& change) {
  double sum = 0;
  for (const auto& bound : bounds) sum += std::pow(std::max(0.0, bound.least - dot(bound.normal, change)), 2);
  return sum;
}

/// The shortest of the vectors that solve a · vector = right best; `a` of normals, whose eigenvalues are
/// shares of one.
Vec3d solve_best(const Mat3d& a, const Vec3d& right) {
  constexpr double none = 1e-9;
  const auto eigen = eigen_symmetric3(a);
  Vec3d solution{};
  for (std::size_t k = 0; k < 3; ++k)
    if (const auto mode = eigen.vectors.column[k]; eigen.values[k] > none)
      solution += (dot(mode, right) / eigen.values[k]) * mode;
  return solution;
}

/// min Σ max(0, least_k − n_k · d)² by Newton's method on the set of violated bounds; the smallest such d.
Vec3d least_violation(std::span<const Bound> bounds) {
  constexpr int most_rounds = 20;
  Vec3d change{};
  for (int round = 0; round < most_rounds; ++round) {
    Mat3d matrix{};
    Vec3d right{};
    for (const auto& bound : bounds) {
      if (dot(bound.normal, change) > bound.least) continue;
      matrix += outer(bound.normal, bound.normal);
      right += bound.least * bound.normal;
    }
    auto way = solve_best(matrix, right) - change;
    // Where other bounds are violated at its end a step may be too long, and sets of bounds could take turns.
    // Differences that rounding makes do not count: near the minimum they would stop the last step.
    const double most = (1 + 1e-9) * violation(bounds, change);
    while (violation(bounds, change + way) > most) way = 0.5 * way;
    change += way;
    if (norm(way) <= tolerance * norm(change)) break;
  }
  return change;
}

}  // namespace

/// The minimum lies on none, one, two or three of the planes, and is found by trying: there are few bodies.
PushOut push_out(std::span<const Bound> bounds) {
  double scale = 0;
  for (const auto& bound : bounds) scale = std::max(scale, std::abs(bound.least));
  const double slack = tolerance * scale;
  if (obeys({}, bounds, 0)) return {};
  for (const auto& bound : bounds)
    if (const auto change = bound.least * bound.normal; bound.least > 0 && obeys(change, bounds, slack))
      return {change};
  for (std::size_t i = 0; i < bounds.size(); ++i)
    for (std::size_t j = i + 1; j < bounds.size(); ++j)
      if (const auto change = on_two(bounds[i], bounds[j]); change && obeys(*change, bounds, slack))
        return {*change};
  for (std::size_t i = 0; i < bounds.size(); ++i)
    for (std::size_t j = i + 1; j < bounds.size(); ++j)
      for (std::size_t k = j + 1; k < bounds.size(); ++k)
        if (const auto change = on_three(bounds[i], bounds[j], bounds[k]);
            change && obeys(*change, bounds, slack))
          return {*change};
  return {least_violation(bounds), true};
}

Mat3d tangent_of(std::span<const Bound> bounds) {
  std::array<Vec3d, 3> normals{};
  auto tangent = identity<double>();
  std::size_t count = 0;
  for (const auto& bound : bounds) {
    if (count == normals.size()) break;  // a fourth independent direction does not exist
    if (norm(tangent * bound.normal) < 1e-6) continue;
    normals[count++] = bound.normal;
    tangent = projector_off(std::span(normals).first(count));
  }
  return tangent;
}

void split_over(std::span<const Bound> bounds, const Mat3d& tangent, const Vec3d& vector,
                std::vector<double>& shares) {
  shares.clear();
  if (bounds.size() == 1) {
    shares.push_back(dot(bounds.front().normal, vector));
    return;
  }
  auto matrix = tangent;  // keeps it regular: the vector has no part there
  for (const auto& bound : bounds) matrix += outer(bound.normal, bound.normal);
  const auto dual = inverse(matrix) * (vector - tangent * vector);
  for (const auto& bound : bounds) shares.push_back(dot(bound.normal, dual));
}

}  // namespace evert
