// Kernels for processors with AVX2. Compiled with -mavx2: nothing here may run before kernel_dispatch.cpp has asked the processor.
#include "solver/detail/kernels.hpp"

#ifdef __AVX2__
#include "solver/detail/lanes_avx2_impl.hpp"
#include "solver/detail/pair_kernel_impl.hpp"

namespace pelletlab::solver::detail {

extern const Kernels kernels_for_avx2;
constinit const Kernels kernels_for_avx2 = make_kernels<Avx2Lanes, Avx2Lanes>("AVX2");

}  // namespace pelletlab::solver::detail
#endif
