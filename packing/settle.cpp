#include "packing/rest.hpp"
#include "packing/stage.hpp"

namespace pelletlab::packing {

SettleStatus settle(Course& course, const solver::Simulation& simulation, const Case& c, double frame_interval, const std::string& name) {
    RestRule rest(c, simulation);
    Stage stage;
    stage.name = name;
    stage.duration = c.time.settle_limit;
    stage.frame_interval = frame_interval;
    stage.watch_interval = 0.001;
    stage.memory.assign(RestRule::start.begin(), RestRule::start.end());
    stage.watch = [&](const solver::Simulation& now, std::vector<double>& memory) { return rest.holds(now, memory.data()); };
    stage.note = [&] { return rest.note(); };
    return course.run(stage) == StageEnd::watch_ended_it ? SettleStatus::at_rest : SettleStatus::not_at_rest;
}

}  // namespace pelletlab::packing
