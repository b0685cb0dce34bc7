// The scalar twin of the kernels: what the SIMD files must reproduce bit for bit.
#include "solver/detail/pair_kernel_impl.hpp"

namespace pelletlab::solver::detail {

const Kernels& scalar_kernels() {
    static constexpr Kernels kernels = make_kernels<ScalarLanes, ScalarLanes>("scalar");
    return kernels;
}

}  // namespace pelletlab::solver::detail
