#pragma once
#include "evert/contact/obstacle.hpp"
#include "evert/contact/support_points.hpp"

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace evert {

/// Rigid bodies against each other and against the other obstacles: inelastic impacts with Coulomb friction,
/// the coefficient of two being the geometric mean of theirs. A body is felt at its support points, which
/// must not enter another, and by its own distance function where a support point of another enters it.
class RigidContacts {
 public:
  explicit RigidContacts(std::span<const std::unique_ptr<Obstacle>> obstacles);

  /// Finds the contacts where the obstacles are now.
  void find();
  /// Changes the velocities of the bodies so that none of them goes on into another; never adds energy in
  /// the frame of what does not move.
  void stop();
  /// Moves the bodies out of each other where the contacts still are inside.
  void separate();

  /// Whether `obstacle` has a contact.
  [[nodiscard]] bool touches(std::size_t obstacle) const;
  /// What `obstacle` gave to bodies since find(), the angular part about the origin of its frame.
  [[nodiscard]] const std::pair<Vec3d, Vec3d>& given(std::size_t obstacle) const { return given_[obstacle]; }

 private:
  /// A support point of `inner` in `outer`.
  struct Contact {
    std::size_t inner, outer;
    const SupportPoint* support;
    Vec3d place;   // on the surface of the support
    Vec3d normal;  // out of `outer`
    Mat3d mobility;
    double friction;
    Vec3d impulse{};  // on `inner`
  };
  void find(std::size_t inner, std::size_t outer);
  [[nodiscard]] Vec3d velocity(std::size_t obstacle, const Vec3d& place) const;
  [[nodiscard]] Mat3d mobility(std::size_t obstacle, const Vec3d& place) const;
  void apply(const Contact& contact, const Vec3d& impulse);
  static Vec3d rubbing(const Contact& contact, const Vec3d& rubbed, const Vec3d& sliding, double most);
  double improve(Contact& contact);

  std::span<const std::unique_ptr<Obstacle>> obstacles_;
  std::vector<std::vector<SupportPoint>> support_;  // parallel to obstacles_
  std::vector<Contact> contacts_;
  std::vector<std::pair<Vec3d, Vec3d>> given_;  // parallel to obstacles_
};

}  // namespace evert
