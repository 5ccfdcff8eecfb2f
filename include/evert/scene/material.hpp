#pragma once
#include "evert/core/schema.hpp"
#include "evert/materials/material.hpp"
#include "evert/scene/config.hpp"

#include <string>

/// From the `material:` of a scene to a model that computes.
namespace evert {

/// Keys, units, ranges and help of a material.
[[nodiscard]] const schema::Table<MaterialConfig>& material_table();

/// λ and μ of small strains, whichever way the moduli are given.
[[nodiscard]] Lame lame_of(const MaterialConfig& config);

[[nodiscard]] Material material_of(const MaterialConfig& config);

/// True of models that need the directions of fibres.
[[nodiscard]] bool has_fibres(MaterialModel model);

/// "neo_hookean", as in scenes.
[[nodiscard]] std::string name_of(MaterialModel model);

}  // namespace evert
