// How long work tells the person who waits, and how that person stops it. Libraries report through these and never print.
#pragma once

#include <functional>
#include <string>

namespace pelletlab {

struct Progress {
    std::string stage;      ///< «settling», «fitting spheres»
    double done = 0.0;      ///< in [0, total]
    double total = 0.0;     ///< 0 when unknown
    std::string unit;       ///< of done and total: «s of simulated time»
    double rate = 0.0;      ///< work per wall second, in rate_unit; 0 when unknown
    std::string rate_unit;  ///< «pellet-steps/s»
    std::string note;       ///< anything worth a glance: «bed at rest», «12 of 1000 still in the air»
};

using ProgressSink = std::function<void(const Progress&)>;

/// Makes Ctrl-C and SIGTERM set a flag instead of ending the process at once; the second signal ends it.
void install_interrupt_handler();

/// True after a signal came.
bool interrupt_requested();

/// Throws Error(interrupted) after a signal came; long loops call it where nothing is half done.
void throw_if_interrupted();

}  // namespace pelletlab
