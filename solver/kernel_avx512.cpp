// Kernels for processors with AVX-512 (F, VL, DQ, BW). Compiled with those flags: nothing here may run before kernel_dispatch.cpp has asked the processor.
#include "solver/detail/kernels.hpp"

#ifdef __AVX512F__
#include "solver/detail/lanes_avx512_impl.hpp"
#include "solver/detail/pair_kernel_impl.hpp"

namespace pelletlab::solver::detail {

extern const Kernels kernels_for_avx512;
constinit const Kernels kernels_for_avx512 = make_kernels<Avx512Lanes, Avx512ShortLanes>("AVX-512");

}  // namespace pelletlab::solver::detail
#endif
