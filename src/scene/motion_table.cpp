#include "motion.hpp"
#include "tables.hpp"

/// How obstacles move.
namespace evert {

using namespace schema;

namespace {

/// [[t, x, y, z, w, x, y, z], ...] with times that increase.
Type<std::vector<PoseKey>> pose_keys() {
  const auto rows = sequence_of(array_of<8>(number("s, m, -"), "numbers t, x, y, z, w, x, y, z"));
  return {.info = {.name = "list of: [t, x, y, z, w, x, y, z]", .unit = "s, m, -"},
          .read =
              [=](const Value& value, const std::string& path) {
                std::vector<PoseKey> keys;
                for (const auto& row : rows.read(value, path)) {
                  const auto key = pose_key(row);
                  if (const auto wrong = wrong_with(keys, key); !wrong.empty())
                    fail(value.items[keys.size()], path + "[" + std::to_string(keys.size()) + "]", wrong);
                  keys.push_back(key);
                }
                if (keys.empty()) fail(value, path, "must have one row at least");
                return keys;
              },
          .write = [](const std::vector<PoseKey>&) { return std::string(); }};
}

/// The keys of one kind of motion.
struct Kind {
  const char* what;
  std::vector<const char*> keys;
};

/// Throws unless the keys are those of one kind of motion, and enough for it.
void expect_one_kind(MotionConfig& motion, const Value& map, const std::string& path) {
  static const std::vector<Kind> kinds{{"a steady motion", {"velocity", "angular_velocity"}},
                                       {"a table", {"keyframes"}},
                                       {"a table", {"file"}},
                                       {"an oscillation", {"amplitude", "angle", "frequency", "phase"}}};
  const char* first = nullptr;
  const Kind* chosen = nullptr;
  for (const auto& kind : kinds)
    for (const char* key : kind.keys) {
      const auto* value = map.find(key);
      if (value == nullptr) continue;
      if (chosen != nullptr && chosen != &kind)
        fail(*value, join(path, key),
             std::string("is of ") + kind.what + ", but '" + first + "' of " + chosen->what +
                 ": a motion is one of them");
      if (chosen == nullptr) first = key;
      chosen = &kind;
    }
  if (chosen == nullptr)
    fail(map, path, "needs 'velocity' or 'angular_velocity', 'keyframes', 'file', or 'frequency'");
  const bool oscillates = chosen == &kinds.back();
  if (oscillates && motion.frequency == 0) fail(map, path, "'frequency' is missing [Hz], e.g. frequency: 2");
  if (oscillates && motion.amplitude == Vec3d{} && motion.angle == Vec3d{})
    fail(map, path, "needs 'amplitude' [m] or 'angle' [rad], not zero, beside 'frequency'");
}

}  // namespace

const Table<MotionConfig>& motion_table() {
  static const auto table =
      Table<MotionConfig>(
          "How an obstacle moves from the place that its shape has at the start: steadily (velocity, "
          "angular_velocity), as a table says (keyframes, file), or to and fro (frequency).")
          .either("velocity", &MotionConfig::velocity, vector3("m/s"), "[0, -1, 0]",
                  "Constant, of the point about.")
          .either("angular_velocity", &MotionConfig::angular_velocity, vector3("rad/s"), "[0, 0, 2]",
                  "Constant, along the axis by the right-hand rule.")
          .either("about", &MotionConfig::about, vector3("m"), "[0, 1, 0]",
                  "The point that it turns about, at the start, from where it moves along; the middle of the "
                  "shape unless given, the origin for a half_space.")
          .either(
              "keyframes", &MotionConfig::keyframes, pose_keys(),
              "[[0, 0, 0, 0, 1, 0, 0, 0], [1, 0, 0.5, 0, 1, 0, 0, 0]]",
              "Times, translations, and rotations about the point about as quaternions w, x, y, z; smooth "
              "in between, at rest before and after.")
          .either("file", &MotionConfig::file, text("path"), "hand.csv",
                  "A CSV file with such rows, relative to the scene file.")
          .either("amplitude", &MotionConfig::amplitude, vector3("m"), "[0, 0.1, 0]",
                  "Translation by this times sin(2 pi frequency t + phase).")
          .either("angle", &MotionConfig::angle, vector3("rad"), "[0, 0, 0.5]",
                  "Rotation by this vector, an angle along its axis, times the same sine.")
          .either("frequency", &MotionConfig::frequency, number("Hz", above(0)), "2",
                  "Of an oscillation; amplitude, angle or both go with it.")
          .either("phase", &MotionConfig::phase, number("rad"), "1.5708",
                  "Of an oscillation; 0 unless given.")
          .then(expect_one_kind);
  return table;
}

}  // namespace evert
