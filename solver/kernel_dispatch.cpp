// Chooses the kernels once the processor is known.
#include "solver/detail/kernels.hpp"

namespace pelletlab::solver::detail {

#ifdef PELLETLAB_SOLVER_X86_KERNELS

extern const Kernels kernels_for_avx2, kernels_for_avx512;

const Kernels* avx2_kernels() {
    return __builtin_cpu_supports("avx2") ? &kernels_for_avx2 : nullptr;
}

const Kernels* avx512_kernels() {
    const bool has_all =
        __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
    return has_all ? &kernels_for_avx512 : nullptr;
}

#else

const Kernels* avx2_kernels() {
    return nullptr;
}

const Kernels* avx512_kernels() {
    return nullptr;
}

#endif

const Kernels& best_kernels() {
    if (const Kernels* k = avx512_kernels()) return *k;
    if (const Kernels* k = avx2_kernels()) return *k;
    return scalar_kernels();
}

}  // namespace pelletlab::solver::detail
