#pragma once
#include <string>
#include <string_view>

/// The reference of the scene format, made from the tables that read it.
namespace evert {

/// Every key as an indented tree, one line each: for a terminal.
[[nodiscard]] std::string reference_tree();

/// All about the keys that `query` names: a path ("bodies.torus.material.youngs_modulus", with or without the
/// names of bodies and obstacles), its end ("material.youngs_modulus") or a single key. Throws UserError with
/// the nearest key when there is none.
[[nodiscard]] std::string reference_of(std::string_view query);

/// The whole reference as a page: docs/reference/scene.md.
[[nodiscard]] std::string reference_markdown();

}  // namespace evert
