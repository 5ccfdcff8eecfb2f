#include "motion.hpp"

#include "evert/core/collective.hpp"
#include "evert/core/error.hpp"
#include "evert/core/formatted.hpp"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace evert {
namespace {

/// Eight numbers between commas; returns what is wrong with them, "" where nothing is.
std::string read_row(std::string_view line, std::array<double, 8>& row) {
  const char* place = line.data();
  const char* end = line.data() + line.size();
  const auto skip_blanks = [&] {
    while (place != end && (*place == ' ' || *place == '\t' || *place == '\r')) ++place;
  };
  for (std::size_t i = 0; i < row.size(); ++i) {
    skip_blanks();
    const auto [after, error] = std::from_chars(place, end, row[i]);
    if (error != std::errc() || !std::isfinite(row[i]))
      return "must be 8 finite numbers between commas, t, x, y, z and the quaternion w, x, y, z; number " +
             std::to_string(i + 1) + " is none";
    place = after;
    skip_blanks();
    const bool last = i + 1 == row.size();
    if (last != (place == end) || (!last && *place != ','))
      return "must be 8 numbers between commas: t, x, y, z and the quaternion w, x, y, z";
    if (!last) ++place;
  }
  return "";
}

/// A table of poses. Lines that begin with # are comments, and so is the first when it begins with a letter.
std::vector<PoseKey> read_keys(const std::string& path) {
  constexpr std::size_t most = 10'000'000;  // numbers of a table that is meant as one
  if (!std::filesystem::exists(path)) throw UserError(path + ": there is no such file");
  if (!std::filesystem::is_regular_file(path)) throw UserError(path + ": is not a regular file");
  std::ifstream file(path);
  if (!file) throw UserError(path + ": cannot be opened for reading");
  std::vector<PoseKey> keys;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    const auto first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    if (number == 1 && std::isalpha(static_cast<unsigned char>(line[first])) != 0) continue;
    const auto refuse = [&](const std::string& why) {
      throw UserError(path + ":" + std::to_string(number) + ": " + why);
    };
    std::array<double, 8> row{};
    if (const auto wrong = read_row(line, row); !wrong.empty()) refuse(wrong);
    const auto key = pose_key(row);
    if (const auto wrong = wrong_with(keys, key); !wrong.empty()) refuse(wrong);
    keys.push_back(key);
    if (keys.size() > most) refuse("more than 10 million rows: not a table of a motion");
  }
  if (keys.empty()) throw UserError(path + ": has no rows; a motion needs one at least");
  return keys;
}

/// Rank 0's keys on every rank.
std::vector<PoseKey> read_keys(MPI_Comm comm, const std::string& path) {
  std::vector<PoseKey> keys;
  on_root(comm, [&] { keys = read_keys(path); });
  auto count = static_cast<int>(keys.size());
  MPI_Bcast(&count, 1, MPI_INT, 0, comm);
  std::vector<double> numbers;
  for (const auto& [time, position, rotation] : keys)
    for (const double x : {time, position[0], position[1], position[2], rotation.w, rotation.v[0],
                           rotation.v[1], rotation.v[2]})
      numbers.push_back(x);
  numbers.resize(8 * static_cast<std::size_t>(count));
  MPI_Bcast(numbers.data(), 8 * count, MPI_DOUBLE, 0, comm);
  keys.clear();
  for (std::size_t i = 0; i < numbers.size(); i += 8) {
    std::array<double, 8> row{};
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(i), 8, row.begin());
    keys.push_back(pose_key(row));
  }
  return keys;
}

}  // namespace

PoseKey pose_key(const std::array<double, 8>& row) {
  return {row[0], {row[1], row[2], row[3]}, {row[4], {row[5], row[6], row[7]}}};
}

std::string wrong_with(const std::vector<PoseKey>& keys_before, const PoseKey& key) {
  constexpr double unit = 1e-6;  // what is further off was no rotation where it was made
  if (!keys_before.empty() && !(key.time > keys_before.back().time))
    return "has a time that is not later than that of the row before";
  const double length = norm(key.rotation);
  if (!(std::abs(length - 1) <= unit))
    return formatted("has a quaternion w, x, y, z of length %.9g: must be 1 within 1e-6", length);
  return "";
}

std::vector<std::vector<PoseKey>> read_motions(MPI_Comm comm, const SceneConfig& scene) {
  std::vector<std::vector<PoseKey>> all(scene.obstacles.size());
  for (std::size_t o = 0; o < all.size(); ++o)
    if (const auto& motion = scene.obstacles[o].motion; motion && !motion->file.empty())
      all[o] = read_keys(comm, motion->file);
  return all;
}

std::unique_ptr<RigidMotion> motion_of(const ObstacleConfig& obstacle, const RigidState& start,
                                       const std::vector<PoseKey>& keys) {
  if (!obstacle.motion) {
    auto moving = start;
    moving.velocity = obstacle.velocity;
    return std::make_unique<UniformMotion>(moving);
  }
  const auto& motion = *obstacle.motion;
  const auto about = motion.about.value_or(start.origin);
  if (!motion.file.empty()) return std::make_unique<KeyframedMotion>(start, about, keys);
  if (!motion.keyframes.empty()) return std::make_unique<KeyframedMotion>(start, about, motion.keyframes);
  if (motion.frequency > 0)
    return std::make_unique<Oscillation>(start, about, motion.amplitude, motion.angle, motion.frequency,
                                         motion.phase);
  auto moving = start;
  moving.angular_velocity = motion.angular_velocity;
  moving.velocity = motion.velocity + cross(motion.angular_velocity, start.origin - about);
  return std::make_unique<UniformMotion>(moving, about);
}

std::unique_ptr<RigidBody> rigid_body_of(const ObstacleConfig& obstacle, const ImplicitSurface& surface,
                                         RigidState start) {
  const auto bounds = surface.bounds();
  if (!std::isfinite(norm(bounds.upper - bounds.lower)))
    throw UserError("goes on for ever, and so cannot have a mass");
  const auto unit = mass_of(surface);
  const auto mass = unit.times(obstacle.mass ? *obstacle.mass / unit.mass : *obstacle.density);
  const auto inverse_inertia = inverse(mass.inertia);
  if (!std::isfinite(norm(inverse_inertia)) || !(mass.mass > 0) || !std::isfinite(1 / mass.mass))
    throw UserError(
        formatted("a mass of %g kg of this size is more or less than can be computed with", mass.mass));
  start.angular_velocity = obstacle.initial_angular_velocity;
  start.velocity = obstacle.initial_velocity - cross(start.angular_velocity, start.rotation * mass.center);
  return std::make_unique<RigidBody>(mass, start);
}

}  // namespace evert
