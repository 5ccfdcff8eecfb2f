#pragma once
#include "evert/scene/config.hpp"

#include <mpi.h>

#include <span>
#include <string>

/// The PETSc options of a scene and of the command line.
namespace evert {

/// Puts the options of the scene's `petsc:` block into PETSc's database, those left out that are in there
/// already: the command line wins. The same on every rank. Call before anything reads options.
void apply_petsc_block(const SceneConfig& scene);

/// Collective. Throws UserError when the database holds an option that nothing has read, with the nearest one
/// that we know, unless `allow_unknown`. `ours` are options that the program itself looks at by other means
/// (set, quiet). Call when everything that reads options exists.
void reject_unused_options(MPI_Comm comm, bool allow_unknown, std::span<const std::string> ours = {});

}  // namespace evert
