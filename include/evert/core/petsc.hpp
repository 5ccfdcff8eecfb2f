#pragma once
#include <petscksp.h>
#include <petscvec.h>

#include <functional>
#include <source_location>
#include <stdexcept>
#include <string>
#include <utility>

/// Thin move-only handles over PETSc objects, and the one place where its error codes are looked at.
namespace evert {

/// PETSc or MPI reported an error. Not to be recovered from: collective state is unknown.
class PetscFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

[[noreturn]] void petsc_failed(PetscErrorCode code, const std::source_location& where);

/// Throws PetscFailure unless `code` is 0.
inline void check(PetscErrorCode code, const std::source_location& where = std::source_location::current()) {
  if (code != 0) [[unlikely]]
    petsc_failed(code, where);
}

/// Keeps OpenBLAS, if it is the BLAS of this process, to one thread: the ranks are the parallelism, and for
/// vectors of our length its threads cost many times what they gain. OPENBLAS_NUM_THREADS or OMP_NUM_THREADS
/// in the environment win. Not collective.
void use_one_blas_thread();

/// PETSc's own sentence when `calls` fail, in place of its traceback on standard error; else "". As
/// collective as they are.
[[nodiscard]] std::string refusal_of(const std::function<PetscErrorCode()>& calls);

/// Makes calls that read PETSc options, as collective as they are. A value that PETSc refuses (it cannot be
/// asked beforehand) becomes a UserError with PETSc's own sentence, in place of its traceback on standard
/// error; the objects involved are then only good for being destroyed.
void check_options(const std::function<PetscErrorCode()>& calls);

/// Owns one PETSc object; `Destroy` is its destructor, e.g. VecDestroy.
template <class Object, PetscErrorCode (*Destroy)(Object*)>
class PetscHandle {
 public:
  PetscHandle() = default;
  /// Takes over the reference that `object` holds.
  explicit PetscHandle(Object object) : object_(object) {}
  PetscHandle(PetscHandle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  PetscHandle& operator=(PetscHandle&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  PetscHandle(const PetscHandle&) = delete;
  PetscHandle& operator=(const PetscHandle&) = delete;
  ~PetscHandle() {
    if (object_ != nullptr) static_cast<void>(Destroy(&object_));
  }

  [[nodiscard]] Object get() const { return object_; }
  /// For PETSc's creating calls: check(VecCreate(comm, vec.out())). Destroys what was held.
  [[nodiscard]] Object* out() {
    if (object_ != nullptr) check(Destroy(&object_));
    return &object_;
  }
  explicit operator bool() const { return object_ != nullptr; }

 private:
  Object object_ = nullptr;
};

using VecHandle = PetscHandle<Vec, VecDestroy>;
using MatHandle = PetscHandle<Mat, MatDestroy>;
using KspHandle = PetscHandle<KSP, KSPDestroy>;
using IsHandle = PetscHandle<IS, ISDestroy>;
using VecScatterHandle = PetscHandle<VecScatter, VecScatterDestroy>;
using MatNullSpaceHandle = PetscHandle<MatNullSpace, MatNullSpaceDestroy>;
using LocalToGlobalHandle = PetscHandle<ISLocalToGlobalMapping, ISLocalToGlobalMappingDestroy>;

}  // namespace evert
