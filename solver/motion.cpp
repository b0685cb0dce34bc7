#include "solver/detail/motion.hpp"

namespace pelletlab::solver::detail {

void fill_record(const Bodies& bodies, const BodyTemplate& t, std::size_t i, Kinematic& record) {
    const Vec3 p = bodies.position(i), v = bodies.velocity(i), w = spin_of(t, bodies.orientation(i), bodies.angular_momentum(i));
    const Quat q = bodies.orientation(i);
    record = {{p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), t.largest_offset},
              {v.x(), v.y(), v.z(), w.x(), w.y(), w.z(), t.inverse_mass, 1.0 / t.smallest_inertia}};
}

}  // namespace pelletlab::solver::detail
