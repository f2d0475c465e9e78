// SPDX-License-Identifier: Apache-2.0
#pragma once

/// On a function that is a loop over arrays: compiled twice, for wider vectors where the processor
/// has them and for those that every one has, and chosen at load time. The arithmetic is the same,
/// and so are the bits. Sanitizers cannot load such functions and get one.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define STILLMAP_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define STILLMAP_VECTOR_CLONES
#endif
