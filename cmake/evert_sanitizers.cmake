# -DEVERT_SANITIZE=ON: AddressSanitizer (with LeakSanitizer) and UndefinedBehaviorSanitizer; any finding ends the
# program with a non-zero exit code. -DEVERT_COVERAGE=ON: gcov. Both at -O1, which halves the time to build.
option(EVERT_SANITIZE "Build with ASan and UBSan" OFF)
option(EVERT_COVERAGE "Build for gcov" OFF)

if(EVERT_SANITIZE)
  add_compile_options(-O1 -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
  add_library(evert_foreign_leaks OBJECT ${PROJECT_SOURCE_DIR}/cmake/foreign_leaks.cpp)
  target_link_libraries(evert_foreign_leaks PRIVATE PkgConfig::PETSC MPI::MPI_CXX)
  link_libraries($<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:evert_foreign_leaks>)
  # For sources that instantiate kernels. These checks watch every temporary of every pack: with them a kernel takes
  # minutes to compile, without them seconds. Bounds, overflow and the heap stay watched.
  set(EVERT_KERNEL_SANITIZERS -fno-sanitize-address-use-after-scope -fno-sanitize=null,alignment,object-size)
endif()

if(EVERT_COVERAGE)
  add_compile_options(-O1 --coverage -fprofile-update=atomic)
  add_link_options(--coverage)
endif()
