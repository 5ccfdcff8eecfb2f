#include "evert/contact/obstacle.hpp"

namespace evert {

HalfSpace::HalfSpace(std::string name, double friction, const Vec3d& point, const Vec3d& normal,
                     const Vec3d& velocity)
    : Obstacle(std::move(name), friction),
      point_(point),
      normal_((1 / norm(normal)) * normal),
      velocity_(velocity) {}

double HalfSpace::signed_distance(const Vec3d& x, double t) const {
  return dot(normal_, x - point_ - t * velocity_);
}

Sphere::Sphere(std::string name, double friction, const Vec3d& center, double radius, const Vec3d& velocity)
    : Obstacle(std::move(name), friction), center_(center), velocity_(velocity), radius_(radius) {}

double Sphere::signed_distance(const Vec3d& x, double t) const { return norm(x - center_at(t)) - radius_; }

Vec3d Sphere::normal(const Vec3d& x, double t) const {
  const auto outward = x - center_at(t);
  const double distance = norm(outward);
  return distance > 0 ? (1 / distance) * outward : Vec3d{0, 1, 0};
}

}  // namespace evert
