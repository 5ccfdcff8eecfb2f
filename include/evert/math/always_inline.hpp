#pragma once

/// How functions of the kernels are inlined. The kernels are compiled once per CPU level (x86-64-v2, -v3,
/// -v4) into one binary, so a function that two levels share must not leave an out-of-line copy: the linker
/// keeps one of them, perhaps the one an older CPU cannot run. Templates over packs are safe (the packs of
/// two levels are different types); a helper that also serves plain scalars is forced inline.

/// A helper that kernels call: inlined at every level of optimisation.
#define EVERT_ALWAYS_INLINE [[gnu::always_inline]] inline

/// One stage of a staged kernel: a loop of its own over data that stays in L1. `noipa`, not `noinline`,
/// because g++ 12.2 at -O3 was seen to take such a stage for free of side effects and to drop the call.
#if defined(__clang__)
#define EVERT_STAGE [[gnu::noinline]]
#else
#define EVERT_STAGE [[gnu::noipa]]
#endif
