#include "core/progress.hpp"

#include <csignal>

#include "core/error.hpp"

namespace pelletlab {

namespace {

volatile std::sig_atomic_t signal_seen = 0;

extern "C" void note_signal(int number) {
    signal_seen = 1;
    std::signal(number, SIG_DFL);
}

}  // namespace

void install_interrupt_handler() {
    std::signal(SIGINT, note_signal);
    std::signal(SIGTERM, note_signal);
}

bool interrupt_requested() {
    return signal_seen != 0;
}

void throw_if_interrupted() {
    if (interrupt_requested()) throw Error(ErrorKind::interrupted, "interrupted; finished results are kept, half-written ones are not");
}

}  // namespace pelletlab
