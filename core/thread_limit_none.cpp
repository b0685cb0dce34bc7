// For ThreadSanitizer: Debian's oneTBB is not instrumented and gives false reports, so nothing of it is linked here.
#include "core/thread_limit.hpp"

namespace pelletlab {

void limit_library_threads(int) {}

}  // namespace pelletlab
