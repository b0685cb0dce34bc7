"""LIGGGHTS inputs for scripts/bench-peers, the bodies they end with, and the speed that a log states. Standard library only.

A case is packed once by LIGGGHTS (random insertion, five times gravity and drag, then true gravity), kept as its restart file, and read back as bodies for
solver_benchmark --bodies, so both programs time the same bed. Geometry, masses and contact parameters are those of benchmarks/solver_benchmark.cpp.
"""
import math
import os
import re

R, H, RHO, BIG, SMALL = 1.56e-3, 2.96e-3, 1800.0, 0.765e-3, 0.35e-3
VOLUME = math.pi * R * R * H
MASS = VOLUME * RHO
REACH = 2.2e-3  # more than a pellet's bounding radius
TUBE_RADIUS = 0.026
MODEL = "hertz tangential history rolling_friction cdt"
SKIN = {"tube": 0.2e-3, "drum": 0.2e-3, "box": 0.3e-3}


def spheres(count):
    """The pellet of solver_benchmark: [(x, y, z, r)] in metres."""
    if count == 1:
        return [(0.0, 0.0, 0.0, (0.75 * R * R * H) ** (1.0 / 3.0))]
    out = []

    def rings(number, n, r, phase):
        top = 0.5 * H - r
        for k in range(number):
            for i in range(n):
                a = 2.0 * math.pi * (i + phase) / n
                out.append(((R - r) * math.cos(a), (R - r) * math.sin(a), -top + 2.0 * top * k / (number - 1), r))

    for arguments in {10: [(2, 5, BIG, 0.0)], 12: [(2, 6, BIG, 0.0)], 24: [(3, 8, BIG, 0.0)], 42: [(3, 8, BIG, 0.0), (2, 9, SMALL, 0.5)],
                      82: [(3, 16, BIG, 0.0), (2, 17, SMALL, 0.5)], 200: [(5, 24, BIG, 0.0), (2, 40, SMALL, 0.5)]}[count]:
        rings(*arguments)
    return out


def drum_size(pellets):
    """Diameter and length: 20 % of the volume at a bulk packing of 0.6; length / diameter as the study's 90 / 240."""
    diameter = (pellets * VOLUME / 0.6 / 0.2 / (0.25 * math.pi * 0.375)) ** (1.0 / 3.0)
    return diameter, 0.375 * diameter


def write_stl(path, radius, low, high, facets, axis, caps, layers, rings):
    """The prism of solver_benchmark; cut into more triangles, because LIGGGHTS searches long ones badly."""
    def point(r, k, t):
        x, y = r * math.cos(2.0 * math.pi * k / facets), r * math.sin(2.0 * math.pi * k / facets)
        return (x, y, t) if axis == "z" else (x, t, y)

    triangles = []

    def quad(a, b, c, d):
        triangles.extend([(a, b, c), (a, c, d)])

    for layer in range(layers):
        t0, t1 = (low + (high - low) * (layer + s) / layers for s in (0, 1))
        for k in range(facets):
            quad(point(radius, k, t0), point(radius, k + 1, t0), point(radius, k + 1, t1), point(radius, k, t1))
    for t, wanted in zip((low, high), caps):
        for k in range(facets if wanted else 0):
            triangles.append((point(0, 0, t), point(radius / rings, k, t), point(radius / rings, k + 1, t)))
            for ring in range(1, rings):
                r0, r1 = radius * ring / rings, radius * (ring + 1) / rings
                quad(point(r0, k, t), point(r1, k, t), point(r1, k + 1, t), point(r0, k + 1, t))
    with open(path, "w", encoding="ascii") as f:
        f.write("solid wall\n")
        for corners in triangles:
            f.write("facet normal 0 0 0\nouter loop\n" + "".join("vertex %.9g %.9g %.9g\n" % c for c in corners) + "endloop\nendfacet\n")
        f.write("endsolid wall\n")


STAMP = """p=$PPID
while [ "$(cat /proc/$p/comm)" != liggghts ]; do p=$(awk '{print $4}' /proc/$p/stat); done
awk '{print $14+$15}' /proc/$p/stat >> cpu.txt
"""

HEAD = """atom_style sphere
atom_modify map array sort %(sort)s
boundary %(boundary)s
newton off
communicate single vel yes
processors %(processors)s
units si
hard_particles yes
"""
MATERIALS = """neigh_modify delay 0 every 1 check yes
fix m1 all property/global youngsModulus peratomtype 5.e6 7.5e9
fix m2 all property/global poissonsRatio peratomtype 0.25 0.25
fix m3 all property/global coefficientRestitution peratomtypepair 2 0.4 0.4 0.4 0.4
fix m4 all property/global coefficientFriction peratomtypepair 2 0.7 0.7 0.7 0.7
fix m5 all property/global coefficientRollingFriction peratomtypepair 2 0.05 0.05 0.05 0.05
pair_style gran model %(model)s
pair_coeff * *
"""
AFTER = """fix integr all %(integrator)s
compute kems all %(energy)s
thermo_style custom step atoms time c_kems cpu
thermo 500
thermo_modify lost warn norm no flush yes
"""


def write_inputs(folder, rig, pellets, count, steps, pack, settle, rpm=35.0, spin=0):
    """in.pack makes settled.bin and settled.dump; in.time1 and in.time2 time `steps` steps from there with one and two processes."""
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "stamp.sh"), "w", encoding="ascii") as f:
        f.write(STAMP)
    ball = spheres(count)
    with open(os.path.join(folder, "clump.txt"), "w", encoding="ascii") as f:
        f.writelines("%.9g %.9g %.9g %.9g\n" % s for s in ball)
    grids = {1: "1 1 1", 2: "2 1 1"}
    boundary = "f f f"
    if rig == "tube":
        height = pellets * VOLUME / (0.27 * math.pi * TUBE_RADIUS**2) + 2 * REACH
        box = (-TUBE_RADIUS - 0.002, TUBE_RADIUS + 0.002, -TUBE_RADIUS - 0.002, TUBE_RADIUS + 0.002, -0.004, height + 0.008)
        write_stl(os.path.join(folder, "wall.stl"), TUBE_RADIUS, 0.0, height + 0.007, 96, "z", (True, False), max(2, round(height / 0.004)), 8)
        region = "region ins cylinder z 0. 0. %g %g %g units box" % (TUBE_RADIUS * math.cos(math.pi / 96) - REACH, REACH, height)
    elif rig == "drum":
        grids[2] = "1 2 1"
        diameter, length = drum_size(pellets)
        radius = 0.5 * diameter
        inner = radius * math.cos(math.pi / 120) - REACH
        low, high = 0.0, 2.0 * inner
        for _ in range(60):  # depth of the lens that holds the pellets at 26 %
            depth = 0.5 * (low + high)
            area = inner**2 * math.acos(1.0 - depth / inner) - (inner - depth) * math.sqrt(max(0.0, 2.0 * inner * depth - depth * depth))
            low, high = (depth, high) if area * (length - 2 * REACH) < pellets * VOLUME / 0.26 else (low, depth)
        box = (-radius - 0.002, radius + 0.002, -0.5 * length - 0.002, 0.5 * length + 0.002, -radius - 0.002, radius + 0.002)
        write_stl(os.path.join(folder, "wall.stl"), radius, -0.5 * length, 0.5 * length, 120, "y", (True, True), max(2, round(length / 0.006)), 10)
        region = ("region rc cylinder y 0. 0. %g %g %g units box\nregion rz block INF INF INF INF %g %g units box\nregion ins intersect 2 rc rz"
                  % (inner, -0.5 * length + REACH, 0.5 * length - REACH, -radius, -inner + depth))
    else:  # single spheres in a box
        side = math.sqrt(pellets / 1e5) * 0.24
        height = pellets * VOLUME / (0.30 * side * side)
        half = 0.5 * side
        box = (-half - 0.002, half + 0.002, -half - 0.002, half + 0.002, -0.004, height + 0.006)
        write_box_stl(os.path.join(folder, "wall.stl"), half, height + 0.004)
        edge = half - REACH
        region = "region ins block %g %g %g %g %g %g units box" % (-edge, edge, -edge, edge, REACH, height)
    single = count == 1
    inertia = (MASS * (3 * R * R + H * H) / 12, 0.5 * MASS * R * R)
    if single:
        particle = "fix pts1 all particletemplate/sphere 15485863 atom_type 1 density constant %g radius constant %.9g" % (RHO, ball[0][3])
    else:
        particle = ("fix pts1 all particletemplate/multisphere 15485863 atom_type 1 density constant %g nspheres %d ntry 100000 spheres file clump.txt "
                    "scale 1.0 type 1 mass %.9e inertia_tensor %.9e 0 0 %.9e 0 %.9e use_density" % (RHO, count, MASS, inertia[0], inertia[0], inertia[1]))
    walls = "fix vessel all mesh/surface file wall.stl type 2\nfix wall all wall/gran model %s mesh n_meshes 1 meshes vessel\n" % MODEL
    after = AFTER % {"integrator": "nve/sphere" if single else "multisphere", "energy": "ke" if single else "ke/multisphere"}
    turn = "fix rot all move/mesh mesh vessel rotate origin 0. 0. 0. axis 0. 1. 0. period %.9g\n" % (60.0 / rpm) if rig == "drum" else ""
    common = {"boundary": boundary, "sort": "200 0.004"}
    # Small rim spheres need 1e-5 s also while they are packed; drag keeps them slow.
    step = 1e-5 if count in (42, 82, 200) else 2e-5
    drag = MASS * 49.05 / count
    with open(os.path.join(folder, "in.pack"), "w", encoding="ascii") as f:
        f.write(HEAD % dict(common, processors=grids[1]))
        f.write("region box block %g %g %g %g %g %g units box\ncreate_box 2 box\nneighbor 0.8e-3 bin\n" % box)
        f.write(MATERIALS % {"model": MODEL} + "timestep %g\nfix grav all gravity 49.05 vector 0 0 -1\n" % step + walls + particle + "\n")
        f.write("fix pdd1 all particledistribution/discrete 15485867 1 pts1 1.0\n%s\n" % region)
        f.write("fix ins all insert/pack seed 32452843 distributiontemplate pdd1 maxattempt 2000 vel constant 0 0 -1 insert_every once overlapcheck yes "
                "%sregion ins particles_in_region %d ntry_mc 100000\n" % ("" if single else "orientation random ", pellets))
        f.write(after + "run 1\nfix visc all viscous %g\nrun %d\nunfix visc\nunfix grav\nfix grav all gravity 9.81 vector 0 0 -1\n" % (drag, pack))
        f.write("timestep 1e-5\nneighbor %g bin\nrun %d\n%srun %d\n" % (SKIN[rig], settle, turn, spin))
        f.write("write_restart settled.bin\ndump d all custom 1000000000 settled.dump id %s x y z vx vy vz omegax omegay omegaz\n"
                "dump_modify d first yes sort id format \"%d %d %.15g %.15g %.15g %.9g %.9g %.9g %.9g %.9g %.9g\"\nrun 0\n".replace("%s", "type" if single else "mol", 1))
    for processes, grid in grids.items():
        with open(os.path.join(folder, "in.time%d" % processes), "w", encoding="ascii") as f:
            f.write(HEAD % dict(common, processors=grid) + "read_restart settled.bin\nneighbor %g bin\n" % SKIN[rig])
            f.write(MATERIALS % {"model": MODEL} + "timestep 1e-5\nfix grav all gravity 9.81 vector 0 0 -1\n" + walls + particle + "\n" + after + turn)
            f.write("thermo 1000000\nrun 20\nshell sh stamp.sh\nrun %d\nshell sh stamp.sh\n" % steps)


def write_box_stl(path, half, height):
    """The open box of solver_benchmark's rig `box`, in pieces of about 12 mm."""
    triangles = []
    n = max(1, round(2 * half / 0.012))
    m = max(1, round(height / 0.012))

    def plate(corner, u, v, nu, nv):
        def p(a, b):
            return tuple(corner[k] + u[k] * a / nu + v[k] * b / nv for k in range(3))
        for a in range(nu):
            for b in range(nv):
                triangles.extend([(p(a, b), p(a + 1, b), p(a + 1, b + 1)), (p(a, b), p(a + 1, b + 1), p(a, b + 1))])

    s = 2 * half
    plate((-half, -half, 0), (s, 0, 0), (0, s, 0), n, n)
    for corner, along in (((-half, -half, 0), (s, 0, 0)), ((-half, half, 0), (s, 0, 0)), ((-half, -half, 0), (0, s, 0)), ((half, -half, 0), (0, s, 0))):
        plate(corner, along, (0, 0, height), n, m)
    with open(path, "w", encoding="ascii") as f:
        f.write("solid wall\n")
        for corners in triangles:
            f.write("facet normal 0 0 0\nouter loop\n" + "".join("vertex %.9g %.9g %.9g\n" % c for c in corners) + "endloop\nendfacet\n")
        f.write("endsolid wall\n")


# ---- from LIGGGHTS' dump to bodies

def minus(a, b):
    return [a[k] - b[k] for k in range(3)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return [x / length for x in a]


def frame_of(points, three):
    """Orthonormal frame (columns) that three points of a body carry."""
    a, b, c = (points[k] for k in three)
    x = unit(minus(b, a))
    z = unit(cross(x, minus(c, a)))
    return [x, cross(z, x), z]


def quaternion(m):
    """w, x, y, z of a rotation matrix by rows."""
    t = m[0][0] + m[1][1] + m[2][2]
    if t > 0.0:
        s = 2.0 * math.sqrt(1.0 + t)
        q = [0.25 * s, (m[2][1] - m[1][2]) / s, (m[0][2] - m[2][0]) / s, (m[1][0] - m[0][1]) / s]
    else:
        i = max(range(3), key=lambda k: m[k][k])
        j, k = (i + 1) % 3, (i + 2) % 3
        s = 2.0 * math.sqrt(1.0 + m[i][i] - m[j][j] - m[k][k])
        q = [(m[k][j] - m[j][k]) / s, 0.0, 0.0, 0.0]
        q[1 + i], q[1 + j], q[1 + k] = 0.25 * s, (m[j][i] + m[i][j]) / s, (m[k][i] + m[i][k]) / s
    size = math.sqrt(sum(x * x for x in q))
    return [x / size for x in q]


def read_dump(path):
    rows = []
    with open(path, encoding="ascii") as f:
        for line in f:
            if line.startswith("ITEM: ATOMS"):
                break
        for line in f:
            rows.append([float(x) for x in line.split()])
    return rows


def bodies_of_dump(path, count):
    """Bodies as lines of solver_benchmark --bodies: place, turn w x y z, velocity, spin. The spheres of a body come in the order of its template."""
    ball = spheres(count)
    groups = {}
    for row in read_dump(path):
        groups.setdefault(int(row[0] if count == 1 else row[1]), []).append(row)
    lines = []
    template = [list(s[:3]) for s in ball]
    if count > 1:
        three = (0, 1, max(range(2, count), key=lambda k: math.dist(template[0], template[k])))
        own = frame_of(template, three)
    for number in sorted(groups):
        rows = groups[number]
        if len(rows) != count:
            raise SystemExit("body %d of %s has %d spheres, not %d" % (number, path, len(rows), count))
        points, omega = [row[2:5] for row in rows], rows[0][8:11]
        if count == 1:
            place, turn = points[0], [1.0, 0.0, 0.0, 0.0]
        else:
            there = frame_of(points, three)
            matrix = [[sum(there[a][r] * own[a][c] for a in range(3)) for c in range(3)] for r in range(3)]
            place = [points[0][r] - sum(matrix[r][c] * template[0][c] for c in range(3)) for r in range(3)]
            for k in (count // 3, count // 2, count - 1):
                fitted = [place[r] + sum(matrix[r][c] * template[k][c] for c in range(3)) for r in range(3)]
                if math.dist(fitted, points[k]) > 1e-8:
                    raise SystemExit("the spheres of body %d of %s do not lie as in the template" % (number, path))
            turn = quaternion(matrix)
        arm = minus(place, points[0])
        velocity = [rows[0][5 + k] + cross(omega, arm)[k] for k in range(3)]
        lines.append(" ".join("%.17g" % x for x in [*place, *turn, *velocity, *omega]))
    return lines


def read_log(path):
    """Seconds, steps and neighbour builds of the last run of a log, and its memory a process [MB]."""
    with open(path, encoding="utf-8", errors="replace") as f:
        text = f.read()
    loops = re.findall(r"Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms", text)
    if not loops:
        raise SystemExit("no timing in %s:\n%s" % (path, text[-2000:]))
    builds = re.findall(r"Neighbor list builds = (\d+)", text)
    return float(loops[-1][0]), int(loops[-1][1]), int(builds[-1]) if builds else 0
