// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// PARKADE_ISA_CLONES before a function compiles it for several instruction sets; the processor's is
// chosen when the program starts. Such functions are plain loops over plain arrays. Contraction to
// fused multiply-add is off in their files, so that every version gives the same bits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__linux__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PARKADE_ISA_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define PARKADE_ISA_CLONES
#endif
