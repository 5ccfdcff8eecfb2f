#pragma once
#include <cstdint>
#include <vector>

namespace evert {

struct ActivationKeyframe {
  double time = 0;        ///< [s]
  double activation = 0;  ///< [-] in [0, 1]
};

/// The activation of the muscle of one region over time: a function of time only, so that a restart needs
/// nothing else.
struct Activation {
  std::int32_t region = 0;                    ///< index into DistributedMesh::regions
  std::vector<ActivationKeyframe> keyframes;  ///< linear in between, constant outside; not empty, times rise

  [[nodiscard]] double at(double time) const;
  /// The first time of a keyframe after `time`; infinity after the last.
  [[nodiscard]] double next_keyframe(double time) const;
  /// How far it rises above its value at `time`, at most, until `end`.
  [[nodiscard]] double rise(double time, double end) const;
};

}  // namespace evert
