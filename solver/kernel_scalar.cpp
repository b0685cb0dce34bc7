// The scalar twin of the kernels: what the SIMD files must reproduce bit for bit.
#include "solver/detail/contact_kernel_impl.hpp"

namespace pelletlab::solver::detail {

const Kernels& scalar_kernels() {
    static constexpr Kernels kernels{"scalar", &contact_forces<ScalarLanes, HertzMindlinEdem, RollingConstantTorque>};
    return kernels;
}

const Kernels& best_kernels() {
    return scalar_kernels();
}

}  // namespace pelletlab::solver::detail
