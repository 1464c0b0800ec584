#pragma once

/// Marks a function of plain loops over float arrays: it is compiled for eight numbers at once, too, and the program takes
/// that one where the processor can. Results are the same bit for bit, as nothing is contracted or reordered. Not under
/// sanitizers, whose run-time is not there yet when the choice is made. It is given numbers and arrays: what it calls of a
/// library's templates (Eigen's coefficients, say) clang 19 may leave out of the program.
#define ALIGHT_WIDE_LOOPS
#if defined(__x86_64__) && defined(__ELF__) && defined(__has_feature)
#if !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer)
#undef ALIGHT_WIDE_LOOPS
#define ALIGHT_WIDE_LOOPS __attribute__((target_clones("avx2", "default")))
#endif
#endif
