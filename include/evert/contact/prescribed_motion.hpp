#pragma once
#include "evert/contact/velocity_constraints.hpp"

#include <array>
#include <limits>
#include <span>
#include <vector>

/// Nodes that a scene holds or moves (Dirichlet conditions).
namespace evert {

/// A velocity at a time.
struct VelocityKeyframe {
  double time = 0;   ///< [s]
  Vec3d velocity{};  ///< [m/s]
};

/// Owned nodes with a common prescribed velocity.
struct PrescribedNodes {
  std::vector<LocalIndex> nodes;                           ///< sorted
  std::vector<VelocityKeyframe> keyframes;                 ///< linear in between, constant outside; not empty
  std::array<bool, 3> axes{true, true, true};              ///< the components that are prescribed
  double from = 0;                                         ///< [s]
  double until = std::numeric_limits<double>::infinity();  ///< [s]
};

/// All prescribed nodes of a rank, as velocity constraints at any time. A node in several groups obeys the
/// first for each component.
class PrescribedMotion {
 public:
  explicit PrescribedMotion(std::vector<PrescribedNodes> groups);

  /// The constraints at time `t` [s], sorted by node; valid until the next call.
  [[nodiscard]] std::span<const NodeConstraint> at(double t);
  /// The same at time `t`, with the way [m] from time `begin` on in the place of the velocity: what of it
  /// lies within `from` and `until` of each group.
  [[nodiscard]] std::span<const NodeConstraint> ways(double begin, double t);
  [[nodiscard]] bool empty() const { return groups_.empty(); }

 private:
  template <class Prescribed>
  std::span<const NodeConstraint> join_groups(double t, Prescribed&& prescribed);

  std::vector<PrescribedNodes> groups_;
  std::vector<NodeConstraint> now_, group_, joined_;
};

}  // namespace evert
