"""pelletlab observe: runs of our own and tables of tracked particles."""

import json
import math

from harness import BAD_INPUT, SMALL, SMALL_TESTER, USAGE, PelletlabTest

DRUM = ["--diameter", "80 mm", "--length", "20 mm", "--speed", "20 rpm", "--pellet-diameter", "4 mm", "--no-picture"]


def turning_table(mm=1.0):
    """Spheres that turn as a solid body with the drum, the lower half full: places only, no velocities."""
    speed, rows = 20.0 * 2.0 * math.pi / 60.0, ["time [s];id;x;y;z"]
    places = [(4.0 * i, 4.0 * j, 4.0 * k) for i in range(-9, 10) for j in (-2, 0, 2) for k in range(-9, 0) if math.hypot(4 * i, 4 * k) < 38.0]
    for step in range(12):
        turn = speed * 0.001 * step
        for number, (x, y, z) in enumerate(places):
            rows.append(f"{0.001 * step:.4f};{number};{mm * (x * math.cos(turn) + z * math.sin(turn)):.6f};{mm * y:.6f};"
                        f"{mm * (z * math.cos(turn) - x * math.sin(turn)):.6f}")
    return "\n".join(rows) + "\n"


class Observe(PelletlabTest):
    def values(self, folder):
        found = json.loads(self.read(folder, "observables.json"))
        return {one["name"]: one["value"] for one in found["values"]}

    def test_table_of_a_turning_drum(self):
        self.write("tracks.csv", turning_table())
        result = self.succeeds("observe", "drum", "tracks.csv", "--unit", "mm", *DRUM, "-o", "seen")
        self.assertIn("12 times", result.out)
        # The layer turns with the drum; without a known spin all points of a pellet move as its centre does, which costs a few percent beside the wall.
        self.assertAlmostEqual(self.values("seen")["rigid_layer_rotation"], 1.0, delta=0.05)
        self.assertIn("up to date", self.succeeds("observe", "drum", "tracks.csv", "--unit", "mm", *DRUM, "-o", "seen").out)
        # The same in metres is the same.
        self.write("metres.csv", turning_table(1e-3).replace(";x;y;z", ";x [m];y [m];z [m]"))
        self.succeeds("observe", "drum", "metres.csv", *DRUM, "-o", "again")
        self.assertAlmostEqual(self.values("again")["rigid_layer_rotation"], self.values("seen")["rigid_layer_rotation"], delta=0.01)

    def test_table_of_a_pile(self):
        rows = ["time (s),id,x (mm),y (mm),z (mm)"]
        number = 0
        for i in range(-30, 31):
            for j in range(-30, 31):
                if math.hypot(i, j) < 30:
                    number += 1
                    rows.append(f"1,{number},{2 * i},{2 * j},{0.5 * (60 - 2 * math.hypot(i, j)) + 2:.6f}")
        self.write("pile.csv", "\n".join(rows) + "\n")
        self.succeeds("observe", "pile", "pile.csv", "--pellet-diameter", "4 mm", "-o", "seen")
        # Spheres 2 mm apart leave dents of 0.27 mm at most below the ideal cone of slope 1/2: the flank is fitted to a few tenths of a degree.
        self.assertAlmostEqual(self.values("seen")["angle_of_repose_cone"], math.degrees(math.atan(0.5)), delta=0.5)
        self.assertIn("top-surface.png", self.everything_below("seen"))

    def test_table_of_crossed_cylinders_in_a_tube(self):
        """Two cylinders of 3.12 mm lie across each other, 0.2 mm into each other; the lower one 0.1 mm in the floor. Places and orientations only."""
        self.new_case()
        half = math.sqrt(0.5)
        self.write("bed.csv", "time [s],id,x [mm],y [mm],z [mm],qw,qx,qy,qz\n"
                   f"1,1,0,0,1.46,{half:.15f},{half:.15f},0,0\n1,2,0.3,0.2,4.38,{half:.15f},0,{half:.15f},0\n")
        tube = ["--diameter", "12 mm", "--pellet", "pellet.stl", "--pellet-unit", "mm", "-o", "seen"]
        result = self.succeeds("observe", "tube", "bed.csv", *tube)
        self.assertIn("a table tells no contact forces", result.out)
        values = self.values("seen")
        self.assertAlmostEqual(values["true_overlap_depth_max"], 0.2, delta=3e-4)
        self.assertAlmostEqual(values["wall_overlap_depth_max"], 0.1, delta=1e-6)
        self.assertEqual(values["true_neighbours_per_pellet"], 1.0)
        self.assertNotIn("contact_force_mean", values)
        # Both axes lie level, one along the radius of its own place and one across it as far as (0.3, 0.2) has it.
        self.assertAlmostEqual(values["mean_axis_alignment"], 0.0, delta=1e-6)
        # What is cut below the highest point of the bed is the volume of both but for the part in the floor, which the share of the walls tells.
        found = json.loads(self.read("seen", "observables.json"))
        axial = next(one for one in found["profiles"] if one["name"] == "packing_fraction_axial")
        step = axial["axis"][1] - axial["axis"][0]
        volume = sum(axial["value"]) * step * math.pi * 36.0
        prism = 2.0 * 12.0 * math.sin(math.radians(15.0)) * 1.56 ** 2 * 2.96
        self.assertAlmostEqual(volume, prism * (1.0 - values["wall_overlap_volume_share"]), delta=1e-5 * prism)

    def test_table_of_a_lying_tube(self):
        rows = ["time (s),id,x (mm),y (mm),z (mm)"]
        places = [(4 * i, 4 * j, 4 * k) for i in range(-9, 10) for j in range(-2, 3) for k in range(-9, 0) if math.hypot(4 * i, 4 * k) < 38.0]
        rows += [f"1,{number},{x},{y},{z}" for number, (x, y, z) in enumerate(places)]
        self.write("bed.csv", "\n".join(rows) + "\n")
        self.succeeds("observe", "tube", "bed.csv", "--lying", "--diameter", "80 mm", "--length", "20 mm", "--pellet-diameter", "4 mm", "-o", "seen")
        self.assertAlmostEqual(self.values("seen")["fill_level_highest"], 40.0 - 4.0 + 2.0, delta=1e-6)  # a line of the 1 mm grid meets the spheres' tops
        self.assertEqual(self.values("seen")["pellets_counted"], len(places))
        self.fails(USAGE, "observe", "tube", "bed.csv", "--lying", "--diameter", "80 mm", "--pellet-diameter", "4 mm", says="--length")

    def test_table_of_a_tester(self):
        """Five spheres ride on the baffle from the bottom to 120 degrees; twenty lie still at the bottom. A turn a second, two turns."""
        rows = ["time [s],id,x [mm],y [mm],z [mm],vx [mm/s],vy [mm/s],vz [mm/s]"]
        for frame in range(2 * 72 + 1):
            time, turn = frame / 72.0, 2.0 * math.pi
            angle = turn * (time % 1.0)
            for n in range(5):
                x, z = -45.0 * math.sin(angle) - 4.0 * math.cos(angle), -45.0 * math.cos(angle) + 4.0 * math.sin(angle)
                place = (x, z, turn * z, -turn * x) if angle < math.radians(118.0) else (0.0, 0.0, 0.0, 0.0)
                rows.append(f"{time:.9f},{n},{place[0]:.6f},{-10 + 5 * n},{place[1]:.6f},{place[2]:.6f},0,{place[3]:.6f}")
            rows += [f"{time:.9f},{5 + n},{5 * (n % 4) - 7.5},{5 * (n // 4) - 10},-40,0,0,0" for n in range(20)]
        self.write("tracks.csv", "\n".join(rows) + "\n")
        tester = ["--diameter", "100 mm", "--length", "30 mm", "--speed", "60 rpm", "--baffle-height", "15 mm", "--pellet-diameter", "4 mm"]
        self.fails(USAGE, "observe", "tester", "tracks.csv", *tester, says="--baffle-angle")
        self.succeeds("observe", "tester", "tracks.csv", *tester, "--baffle-angle", "0 deg", "-o", "seen")
        values = self.values("seen")
        self.assertAlmostEqual(values["turns_measured"], 2.0, delta=1e-6)
        self.assertAlmostEqual(values["baffle_load_largest"], 5.0, delta=1e-6)
        # The last loaded frame is that of 115 degrees, in the bin about 117.5; the next one is empty: half of the load is lost at 120.
        self.assertAlmostEqual(values["release_angle"], 120.0, delta=0.01)
        self.assertIn("cloud_090.png", self.everything_below("seen"))

    def test_run_of_a_tester(self):
        self.succeeds("tester", self.new_case("tester"), *SMALL_TESTER, "-o", "run")
        self.succeeds("observe", "tester", "run/run.h5", "-o", "seen")
        measured, again = self.values("run"), self.values("seen")
        self.assertEqual(json.loads(self.read("run", "observables.json"))["status"], json.loads(self.read("seen", "observables.json"))["status"])
        self.assertAlmostEqual(measured["turns_measured"], again["turns_measured"], delta=1e-4)  # a step more or less
        for name in ("baffle_load_largest", "release_angle", "loose_share_180", "centre_x_090"):
            self.assertAlmostEqual(measured[name], again[name], delta=1e-6 * abs(measured[name]), msg=name)  # the angle comes from the stored wall
        for name in ("collision_rate_pellets", "dissipated_power_wall"):
            self.assertEqual(measured[name], again[name], name)  # recorded by the run, which left them beside its trajectory
        self.assertIn("spectrum_impact_energy.png", self.everything_below("seen"))
        self.fails(USAGE, "observe", "drum", "run/run.h5", says="tester")

    def test_contacts_of_a_run_are_those_of_its_solver(self):
        bed = ["--set", "pellet.count=30", "--set", "tube.diameter=14 mm", "--set", "time.step=2e-5 s", "--set", "time.settle_limit=0.15 s",
               "--set", "time.rest_kinetic_energy=1e-3", "--set", "output.frame_interval=0.05 s", "--set", "output.pictures=false", "--set", "output.paraview=false"]
        for surface in ("facets", "exact"):
            self.succeeds("fill", self.new_case(), *bed, "--set", f"tube.surface={surface}", "-o", surface)
            self.succeeds("observe", "tube", f"{surface}/run.h5", "-o", "seen-" + surface)
            measured, again = self.values(surface), self.values("seen-" + surface)
            self.assertGreater(again["touching_neighbours"], 1.0)
            for name in ("touching_neighbours", "sphere_contacts_per_pellet", "wall_contacts_per_pellet"):
                self.assertAlmostEqual(measured[name], again[name], delta=1e-12, msg=name)
            # The floor carries its load by elastic forces but for what damping adds while the bed comes to rest.
            self.assertAlmostEqual(measured["floor_load_share"], again["floor_elastic_share"], delta=0.1)
        self.assertTrue({"porosity-from-wall.png", "packing-map.png", "orientation.png", "contact-forces.png", "profiles.csv"} <=
                        set(self.everything_below("seen-exact")))
        rows = self.read("seen-exact", "profiles.csv").splitlines()
        self.assertEqual(rows[0], "profile,unit,axis_name,axis_unit,axis,value,standard_error")
        found = json.loads(self.read("seen-exact", "observables.json"))
        self.assertEqual(len(rows) - 1, sum(len(one["axis"]) for one in found["profiles"]))

    def everything_below(self, folder):
        return [name[len(folder) + 1:] for name in self.everything() if name.startswith(folder + "/")]

    def test_errors_of_a_table(self):
        self.write("tracks.csv", "time [s],id,x [mm],y [mm],z [mm]\n0,1,1,1,1\n0.1,1,1,one,1\n")
        self.fails(BAD_INPUT, "observe", "drum", "tracks.csv", *DRUM, says=["tracks.csv:3:9", "'one'"])
        self.write("tracks.csv", "time,id,x,y,z\n0,1,1,1,1\n")
        self.fails(BAD_INPUT, "observe", "drum", "tracks.csv", *DRUM, says=["tracks.csv:1:", "unit"])
        self.write("tracks.csv", "time [s],id,x [mm],y [mm],z [mm]\n0,1,1,1,1\n")
        self.fails(BAD_INPUT, "observe", "pile", "tracks.csv", says=["how large", "--pellet-diameter"])
        self.fails(BAD_INPUT, "observe", "pile", "nothing.csv", says="nothing.csv")
        self.fails(USAGE, "observe", "drum", "tracks.csv", "--pellet-diameter", "4 mm", says="--diameter")
        self.fails(USAGE, "observe", "pile", "tracks.csv", "--pellet-diameter", "4 mm", "--up", "w", says="--up")
        self.fails(BAD_INPUT, "observe", "pile", "tracks.csv", "--pellet-diameter", "4", says="unit")
        self.fails(USAGE, "observe", "silo", "tracks.csv", says="silo")

    def test_run_of_a_tube(self):
        self.succeeds("fill", self.new_case(), *SMALL, "-o", "run")
        self.succeeds("observe", "tube", "run/run.h5", "-o", "seen")
        measured, again = self.values("run"), self.values("seen")
        for name in ("bed_height_h95", "bed_height_grid", "packing_fraction_mass"):
            self.assertEqual(measured[name], again[name], name)  # the same operator on the same frame
        self.fails(USAGE, "observe", "drum", "run/run.h5", says="tube")
        self.succeeds("fill", self.new_case(), *SMALL, "--set", "tube.lying=true", "--set", "tube.height=20 mm", "-o", "lying")
        self.succeeds("observe", "tube", "lying/run.h5", "-o", "seen-lying")
        for name in ("fill_level_mass", "fill_level_highest", "packing_fraction_mass"):
            self.assertEqual(self.values("lying")[name], self.values("seen-lying")[name], name)
        self.fails(USAGE, "observe", "tube", "run/run.h5", "--unit", "mm", says="leave")
