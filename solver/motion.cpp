#include "solver/detail/motion.hpp"

namespace pelletlab::solver::detail {

namespace {

void write_record(const Bodies& b, const BodyTemplate& t, std::size_t i, const double v[3], const double l[3], Kinematic& record) {
    const Matrix3 r = matrix_of(b.qw[i], b.qx[i], b.qy[i], b.qz[i]);
    double body_spin[3];
    for (int k = 0; k < 3; ++k) body_spin[k] = (r.m[0][k] * l[0] + r.m[1][k] * l[1] + r.m[2][k] * l[2]) * t.inverse_inertia[k];
    for (int k = 0; k < 3; ++k) {
        record.v[k] = v[k];
        record.w[k] = r.m[k][0] * body_spin[0] + r.m[k][1] * body_spin[1] + r.m[k][2] * body_spin[2];
    }
    record.p[0] = b.px[i], record.p[1] = b.py[i], record.p[2] = b.pz[i];
    record.q[0] = b.qw[i], record.q[1] = b.qx[i], record.q[2] = b.qy[i], record.q[3] = b.qz[i];
    record.inverse_mass = t.inverse_mass;
    record.inverse_inertia = 1.0 / t.smallest_inertia;
    record.unused = 0.0;
}

/// π_axis of the angular momentum l under orientation q.
double component(const Quaternion& q, const double l[3], const Vec3& axis) {
    const Matrix3 r = matrix_of(q.w, q.x, q.y, q.z);
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) sum += axis[k] * (r.m[0][k] * l[0] + r.m[1][k] * l[1] + r.m[2][k] * l[2]);
    return sum;
}

Quaternion turn_about(const Quaternion& q, const double l[3], const Vec3& axis, double excess, double dt) {
    const double angle = excess * component(q, l, axis) * dt;
    return product(q, rotation_by(axis[0] * angle, axis[1] * angle, axis[2] * angle));
}

}  // namespace

void kick_and_drift(Bodies& b, const BodyTemplate& t, std::size_t i, double dt, Kinematic& record) {
    const double half = 0.5 * dt;
    const double a[3] = {b.fx[i] * t.inverse_mass * half, b.fy[i] * t.inverse_mass * half, b.fz[i] * t.inverse_mass * half};
    const double k[3] = {b.tx[i] * half, b.ty[i] * half, b.tz[i] * half};
    const double v[3] = {b.vx[i] + a[0], b.vy[i] + a[1], b.vz[i] + a[2]};
    const double l[3] = {b.lx[i] + k[0], b.ly[i] + k[1], b.lz[i] + k[2]};
    b.vx[i] = v[0], b.vy[i] = v[1], b.vz[i] = v[2];
    b.lx[i] = l[0], b.ly[i] = l[1], b.lz[i] = l[2];
    b.px[i] += v[0] * dt, b.py[i] += v[1] * dt, b.pz[i] += v[2] * dt;

    Quaternion q{b.qw[i], b.qx[i], b.qy[i], b.qz[i]};
    if (t.second_excess != 0.0) q = turn_about(q, l, t.second_axis, t.second_excess, half);
    if (t.axial_excess != 0.0) q = turn_about(q, l, t.axis, t.axial_excess, dt);
    const double s = t.inverse_transverse * dt;
    q = product(rotation_by(l[0] * s, l[1] * s, l[2] * s), q);
    if (t.second_excess != 0.0) q = turn_about(q, l, t.second_axis, t.second_excess, half);
    const double correction = 1.5 - 0.5 * (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);  // one Newton step towards length 1
    b.qw[i] = q.w * correction, b.qx[i] = q.x * correction, b.qy[i] = q.y * correction, b.qz[i] = q.z * correction;

    const double predicted_v[3] = {v[0] + a[0], v[1] + a[1], v[2] + a[2]};
    const double predicted_l[3] = {l[0] + k[0], l[1] + k[1], l[2] + k[2]};
    write_record(b, t, i, predicted_v, predicted_l, record);
}

void fill_record(const Bodies& b, const BodyTemplate& t, std::size_t i, Kinematic& record) {
    const double v[3] = {b.vx[i], b.vy[i], b.vz[i]};
    const double l[3] = {b.lx[i], b.ly[i], b.lz[i]};
    write_record(b, t, i, v, l, record);
}

}  // namespace pelletlab::solver::detail
