#pragma once
#include "evert/core/collective.hpp"
#include "evert/core/petsc.hpp"

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace evert::test {

/// PETSc options for the life of the object. The same on all ranks.
class Options {
 public:
  using Option = std::pair<std::string, std::string>;
  Options(std::initializer_list<Option> options) : options_(options) {
    for (const auto& [name, value] : options_)
      check(PetscOptionsSetValue(nullptr, name.c_str(), value.c_str()));
  }
  ~Options() {
    for (const auto& [name, value] : options_)
      static_cast<void>(PetscOptionsClearValue(nullptr, name.c_str()));
  }
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;

 private:
  std::vector<Option> options_;
};

/// The solver that a run would take on one rank. On several, which share cores here, multigrid's many small
/// messages take minutes: there every rank factors the small matrix of a test.
inline Options quasistatic_solver() {
  if (size_of(PETSC_COMM_WORLD) == 1) return {{"-quasistatic_pc_type", "gamg"}};
  return {{"-quasistatic_ksp_type", "preonly"}, {"-quasistatic_pc_type", "redundant"}};
}

}  // namespace evert::test
