// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks a function whose body is a loop over arrays. The compiler makes two versions, one with
/// AVX2 and one for every processor of the architecture, and the loader chooses. Both do the same
/// arithmetic and give the same bits. Sanitizers cannot load such functions and get one version.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define STILLMAP_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define STILLMAP_VECTOR_CLONES
#endif
