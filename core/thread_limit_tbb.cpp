#include <oneapi/tbb/global_control.h>

#include <cstddef>
#include <memory>

#include "core/thread_limit.hpp"

namespace pelletlab {

void limit_library_threads(int count) {
    static std::unique_ptr<tbb::global_control> limit;
    limit.reset();
    if (count > 0) limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
}

}  // namespace pelletlab
