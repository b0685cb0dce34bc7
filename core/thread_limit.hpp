// The thread limit for libraries that bring their own threads (OpenVDB's oneTBB). Used by parallel.cpp only.
#pragma once

namespace pelletlab {

/// 0 takes the limit away.
void limit_library_threads(int count);

}  // namespace pelletlab
