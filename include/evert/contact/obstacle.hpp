#pragma once
#include "evert/math/vec3.hpp"

#include <memory>
#include <string>

/// Rigid bodies that nodes collide with, as implicit surfaces.  paper A, section 9; PHYSICS 8
namespace evert {

/// A rigid body: φ < 0 inside. Thread- and rank-free: every rank holds all obstacles.
class Obstacle {
 public:
  Obstacle(std::string name, double friction) : name_(std::move(name)), friction_(friction) {}
  virtual ~Obstacle() = default;

  /// Distance to the surface at time `t` [s], negative inside [m]; 1-Lipschitz in `x`.
  [[nodiscard]] virtual double signed_distance(const Vec3d& x, double t) const = 0;
  /// Unit outward normal ∇φ, defined everywhere (any unit vector where the gradient is not).
  [[nodiscard]] virtual Vec3d normal(const Vec3d& x, double t) const = 0;
  /// Velocity of the body's material at `x` [m/s].
  [[nodiscard]] virtual Vec3d velocity(const Vec3d& x, double t) const = 0;

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Coulomb coefficient, ≥ 0.
  [[nodiscard]] double friction() const { return friction_; }
  void set_friction(double friction) { friction_ = friction; }

 private:
  std::string name_;
  double friction_;
};

/// Everything behind the plane through `point` with outward normal `normal` (need not be unit; not zero),
/// moving with constant `velocity`.
class HalfSpace final : public Obstacle {
 public:
  HalfSpace(std::string name, double friction, const Vec3d& point, const Vec3d& normal,
            const Vec3d& velocity = {});
  [[nodiscard]] double signed_distance(const Vec3d& x, double t) const override;
  [[nodiscard]] Vec3d normal(const Vec3d& /*x*/, double /*t*/) const override { return normal_; }
  [[nodiscard]] Vec3d velocity(const Vec3d& /*x*/, double /*t*/) const override { return velocity_; }

 private:
  Vec3d point_, normal_, velocity_;
};

/// A ball of `radius` > 0 [m], its centre at `center` when t = 0, moving with constant `velocity`.
class Sphere final : public Obstacle {
 public:
  Sphere(std::string name, double friction, const Vec3d& center, double radius, const Vec3d& velocity = {});
  [[nodiscard]] double signed_distance(const Vec3d& x, double t) const override;
  [[nodiscard]] Vec3d normal(const Vec3d& x, double t) const override;
  [[nodiscard]] Vec3d velocity(const Vec3d& /*x*/, double /*t*/) const override { return velocity_; }

 private:
  [[nodiscard]] Vec3d center_at(double t) const { return center_ + t * velocity_; }
  Vec3d center_, velocity_;
  double radius_;
};

}  // namespace evert
