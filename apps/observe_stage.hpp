// `pelletlab observe`: a trajectory, of our own or of tracked particles, through the same measurement operators.
#pragma once

#include <filesystem>
#include <string>

#include "apps/observe_input.hpp"

namespace pelletlab::apps {

/// Options as they were typed; empty: not given.
struct ObserveRequest {
    TrajectoryRequest trajectory;
    std::string diameter, length, speed, floor, ceiling;  ///< of the rig
    std::string baffle_height, baffle_angle;              ///< of a tester
    bool lying = false;                                   ///< of a tube
    std::string from, until;                              ///< window of time
    std::string grid, view_depth, camera_grid, slab;
    double pellets_each = 1.0;
    std::filesystem::path output;
    bool force = false;
    bool pictures = true;

    std::string settings() const;
};

void observe_tube(const ObserveRequest& request);
void observe_drum(const ObserveRequest& request);
void observe_pile(const ObserveRequest& request);
void observe_tester(const ObserveRequest& request);

}  // namespace pelletlab::apps
