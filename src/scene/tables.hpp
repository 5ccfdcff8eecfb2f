#pragma once
#include "evert/core/schema.hpp"
#include "evert/scene/config.hpp"
#include "evert/scene/material.hpp"

/// The option tables of a scene, one a struct of scene/config.hpp (that of materials: scene/material.hpp),
/// and the types that only they use.
namespace evert {

[[nodiscard]] const schema::Table<SceneConfig>& scene_table();
[[nodiscard]] const schema::Table<MeshConfig>& mesh_table();
[[nodiscard]] const schema::Table<BodyConfig>& body_table();
[[nodiscard]] const schema::Table<DampingConfig>& damping_table();
[[nodiscard]] const schema::Table<FibreConfig>& fibre_table();
[[nodiscard]] const schema::Table<PlasticityConfig>& plasticity_table();
[[nodiscard]] const schema::Table<RotationConfig>& rotation_table();
[[nodiscard]] const schema::Table<ObstacleConfig>& obstacle_table();
[[nodiscard]] const schema::Table<MotionConfig>& motion_table();
[[nodiscard]] const schema::Table<ConstraintConfig>& constraint_table();
[[nodiscard]] const schema::Table<EventConfig>& event_table();

/// Three finite numbers.
[[nodiscard]] schema::Type<Vec3d> vector3(const std::string& unit,
                                          const schema::Range& range = schema::any_number());
/// Three numbers, not all zero; made a unit vector.
[[nodiscard]] schema::Type<Vec3d> direction();
/// [m/s^2]; also the type of the events that change it.
[[nodiscard]] schema::Type<Vec3d> gravity_type();
/// [-]; also the type of the events that change it.
[[nodiscard]] schema::Type<double> friction_type();

/// A constant, or [[t, activation], ...] with times that increase.
[[nodiscard]] schema::Type<ActivationConfig> activation_type();

/// Throws unless fibres and activation are given exactly where a material of the body has them.
void check_fibres(BodyConfig& body, const schema::Value& map, const std::string& path);

/// Throws where a material of the body cannot flow as asked for.
void check_plasticity(BodyConfig& body, const schema::Value& map, const std::string& path);

/// Throws unless min <= max along every axis.
void expect_ordered(const Vec3d& min, const Vec3d& max, const schema::Value& map, const std::string& path);

}  // namespace evert
