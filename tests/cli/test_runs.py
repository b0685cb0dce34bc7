"""Runs: what they write, what they refuse, and what an interrupted one leaves behind."""

import json
import os
import re
import resource
import shutil
import signal
import time

import bodies
from harness import BAD_INPUT, INTERRUPTED, LONG, NUMERICAL, SMALL, SMALL_DRUM, SMALL_PILE, SOURCE, TESTER, PelletlabTest

RESULTS = ("run.h5", "observables.json", "stage.json")


def strict_json(text):
    """JSON as other programs read it: NaN and Infinity are no JSON."""
    return json.loads(text, parse_constant=lambda word: (_ for _ in ()).throw(ValueError(f"{word} in JSON")))


class Runs(PelletlabTest):
    def state_hash(self, result):
        found = re.search(r"state hash ([0-9a-f]{16})", result.out)
        self.assertTrue(found, result)
        return found.group(1)

    def test_fill_writes_every_result(self):
        result = self.succeeds("fill", self.new_case(), *SMALL[:-4], "-o", "out/tube", "--set", "output.picture_width=200")
        for name in (*RESULTS, "case.resolved.toml", "tube.png", "paraview/bodies.pvd", "paraview/spheres.pvd", "paraview/walls.pvd"):
            self.assertTrue(os.path.getsize(self.path("out/tube", name)) > 0, name)
        with open(self.path("out/tube/run.h5"), "rb") as stream:
            self.assertEqual(stream.read(8), b"\x89HDF\r\n\x1a\n")
        values = {one["name"]: one for one in strict_json(self.read("out/tube/observables.json"))["values"]}
        self.assertTrue(any("height" in name for name in values), values.keys())
        self.assertTrue(any("packing_fraction" in name for name in values), values.keys())
        self.assertTrue(all(one["unit"] is not None and one["method"] for one in values.values()))
        self.assertNotIn(".part", " ".join(self.everything()), result)

    def test_drum_writes_every_result(self):
        self.succeeds("drum", self.new_case("drum"), *SMALL_DRUM[:-4], "-o", "out/drum", "--set", "output.picture_width=200")
        for name in (*RESULTS, "case.resolved.toml", "drum.png", "velocity-map.png", "paraview/walls.pvd"):
            self.assertTrue(os.path.getsize(self.path("out/drum", name)) > 0, name)
        text = self.read("out/drum/observables.json")
        strict_json(text)
        self.assertIn("angle", text)

    PILE = ["--set", "pellet.count=40", "--set", "time.step=2e-5 s", "--set", "funnel.top_diameter=30 mm", "--set", "funnel.outlet_diameter=16 mm",
            "--set", "funnel.outlet_height=30 mm", "--set", "pile.plate_diameter=150 mm", "--set", "time.settle_limit=0.1 s",
            "--set", "pile.discharge_limit=0.4 s", "--set", "output.paraview=false", "--set", "output.picture_width=200"]

    def test_pile_writes_every_result(self):
        result = self.succeeds("pile", self.new_case("pile"), *self.PILE, "-o", "out/pile")
        for name in (*RESULTS, "case.resolved.toml", "pile.png", "top-surface.png"):
            self.assertTrue(os.path.getsize(self.path("out/pile", name)) > 0, name)
        values = {one["name"]: one["value"] for one in strict_json(self.read("out/pile/observables.json"))["values"]}
        self.assertEqual(values["pellets_counted"] + values["pellets_above"] + values["pellets_off_plate"], 40, result)
        self.assertGreater(values["pile_height_highest"], 2.5, result)  # a pellet lies or stands 3 mm high
        self.assertLess(values["discharge_time"], 0.4, result)
        self.succeeds("pile", "pile.toml", *SMALL_PILE, "--set", "pile.release=cylinder", "-o", "out/lifted")

    def test_pile_has_the_same_bits_for_one_and_two_threads(self):
        file = self.new_case("pile")
        hashes = {self.state_hash(self.succeeds("--threads", n, "pile", file, *self.PILE, "--set", "output.pictures=false", "-o", f"out-{n}")) for n in ("1", "2")}
        self.assertEqual(len(hashes), 1)

    def test_tester_writes_every_result_with_the_same_bits_for_one_and_two_threads(self):
        file = self.new_case("tester")
        hashes = set()
        for threads in ("1", "2"):
            result = self.succeeds("--threads", threads, "tester", file, *TESTER, "--set", "output.picture_width=200", "-o", "out-" + threads)
            hashes.add(self.state_hash(result))
        self.assertEqual(len(hashes), 1)
        for name in (*RESULTS, "case.resolved.toml", "tester.png", *(f"cloud_{45 * m:03}.png" for m in range(8))):
            self.assertTrue(os.path.getsize(self.path("out-1", name)) > 0, name)
        self.assertEqual(self.read("out-1/observables.json"), self.read("out-2/observables.json"))
        values = {one["name"]: one["value"] for one in strict_json(self.read("out-1/observables.json"))["values"]}
        self.assertAlmostEqual(values["turns_measured"], 2.0, delta=1e-6)
        for kind in ("pellets", "wall", "baffle"):
            self.assertGreater(values["collision_rate_" + kind], 0.0, kind)
            self.assertLess(values["mean_normal_dissipation_" + kind], values["mean_total_dissipation_" + kind], kind)

    def test_a_case_of_another_rig_names_the_verb(self):
        self.fails(2, "fill", self.new_case("pile"), says=["pile", "pelletlab pile"])

    def test_results_carry_version_commit_seed_and_hashes(self):
        self.succeeds("fill", self.new_case(), *SMALL, "-o", "out", "--set", "seed=42")
        version, commit = re.match(r"pelletlab (\S+) \((\S+)\)", self.succeeds("--version").out).groups()
        text = self.read("out/observables.json")
        for part in (version, commit, "42"):
            self.assertIn(part, text)
        self.assertRegex(text, r'"[0-9a-f]{64}"')
        self.assertEqual(self.read("out/case.resolved.toml").rstrip("\n"),
                         self.succeeds("case", "check", "out/case.resolved.toml").out.rstrip("\n"))

    def test_the_resolved_case_in_the_results_runs_from_there(self):
        os.mkdir(self.path("cases"))
        self.take_clump()
        self.succeeds("case", "new", "tube", "-o", "cases/tube.toml")
        one = self.succeeds("fill", "cases/tube.toml", *SMALL, "--set", "pellet.clump_file=../pellet.clump.toml", "-o", "results/deep/one")
        self.assertIn('clump_file = "../../../pellet.clump.toml"', self.read("results/deep/one/case.resolved.toml"))
        two = self.succeeds("fill", "results/deep/one/case.resolved.toml", "-o", "two")
        self.assertEqual(self.state_hash(one), self.state_hash(two))

    def test_same_bits_for_one_and_two_threads(self):
        file = self.new_case()
        setting = SMALL + ["--set", "pellet.count=40", "--set", "time.settle_limit=0.05 s"]
        hashes = {self.state_hash(self.succeeds("--threads", n, "fill", file, *setting, "-o", f"out-{n}")) for n in ("1", "2")}
        self.assertEqual(len(hashes), 1)
        self.assertEqual(strict_json(self.read("out-1/observables.json"))["values"], strict_json(self.read("out-2/observables.json"))["values"])

    def test_another_seed_gives_another_bed(self):
        file = self.new_case()
        hashes = {self.state_hash(self.succeeds("fill", file, *SMALL, "--set", f"seed={n}", "-o", f"out-{n}")) for n in (1, 2)}
        self.assertEqual(len(hashes), 2)

    def test_nothing_to_do_when_nothing_changed(self):
        file = self.new_case()
        self.succeeds("fill", file, *SMALL, "-o", "out")
        before = {name: os.stat(self.path("out", name)).st_mtime_ns for name in RESULTS}
        self.assertIn("up to date", self.succeeds("fill", file, *SMALL, "-o", "out").out)
        self.assertEqual(before, {name: os.stat(self.path("out", name)).st_mtime_ns for name in RESULTS})
        self.assertNotIn("up to date", self.succeeds("fill", file, *SMALL, "-o", "out", "--force").out)
        self.assertNotIn("up to date", self.succeeds("fill", file, *SMALL, "-o", "out", "--set", "seed=5").out)

    def test_examples_run_in_small(self):
        for name in sorted(os.listdir(os.path.join(SOURCE, "examples"))):
            if not name.endswith(".toml"):
                continue
            with self.subTest(example=name):
                self.take_clump()
                shutil.copy(os.path.join(SOURCE, "examples", name), self.path(name))
                rig = re.search(r'(?m)^rig\s*=\s*"(\w+)"', self.read(name)).group(1)
                verb, setting = {"tube": ("fill", SMALL), "drum": ("drum", SMALL_DRUM), "pile": ("pile", SMALL_PILE), "tester": ("tester", SMALL_DRUM)}[rig]
                self.succeeds(verb, name, *setting, "--set", "pellet.clump_file=pellet.clump.toml", "-o", "out-" + name)


class RefusedRuns(PelletlabTest):
    def test_pellet_larger_than_its_tube(self):
        self.fails(BAD_INPUT, "fill", self.new_case(), *SMALL, "-o", "out", "--set", "tube.diameter=2 mm", says="tube")

    def test_pellet_larger_than_its_drum(self):
        self.fails(BAD_INPUT, "drum", self.new_case("drum"), *SMALL_DRUM, "-o", "out", "--set", "drum.length=1 mm", says="drum")

    def test_more_pellets_than_fit(self):
        self.fails(BAD_INPUT, "fill", self.new_case(), *SMALL, "-o", "out", "--set", "pellet.count=5000", "--set", "tube.height=30 mm", says="fit")

    def test_more_pellets_than_fit_into_the_drum(self):
        self.fails(BAD_INPUT, "drum", self.new_case("drum"), *SMALL_DRUM, "-o", "out", "--set", "pellet.count=50000", says="fit")

    def test_clump_that_is_missing_broken_or_of_another_mesh(self):
        file = self.new_case()
        self.fails(BAD_INPUT, "fill", file, "-o", "out", "--set", "pellet.clump_file=nowhere.toml", says=["nowhere.toml", "pelletlab shape"])
        self.write("broken.clump.toml", self.read("pellet.clump.toml")[:200])
        self.fails(BAD_INPUT, "fill", file, "-o", "out", "--set", "pellet.clump_file=broken.clump.toml", says="broken.clump.toml")
        self.write("text.clump.toml", "Dear Ann\n")
        self.fails(BAD_INPUT, "fill", file, "-o", "out", "--set", "pellet.clump_file=text.clump.toml", says="text.clump.toml")
        bodies.write_binary_stl(self.path("pellet.stl"), bodies.box())
        self.fails(BAD_INPUT, "fill", file, *SMALL, "-o", "out", says=["pellet.stl", "changed"])
        os.remove(self.path("pellet.stl"))
        self.fails(BAD_INPUT, "fill", file, *SMALL, "-o", "out", says="pellet.stl")

    def test_output_folder_that_cannot_be_written(self):
        file = self.new_case()
        self.write("a-file", "x")
        self.fails(BAD_INPUT, "fill", file, *SMALL, "-o", "a-file/out", says="a-file")
        self.fails(BAD_INPUT, "fill", file, *SMALL, "-o", "a-file", says="a-file")
        self.fails(BAD_INPUT, "fill", file, *SMALL, "-o", "/proc/pelletlab", says="/proc/pelletlab")

    def test_full_disk_leaves_no_half_written_result(self):
        """A limit on the size of files stands for the full disk: writing fails in the middle of the trajectory."""

        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))

        result = self.run_program("fill", self.new_case(), *SMALL, "--set", "pellet.count=60", "-o", "out", preexec_fn=limit)
        self.assertIn(result.code, (BAD_INPUT, NUMERICAL), result)
        self.assertIn("error:", result.err, result)
        self.assertNotIn("terminate", result.err, result)
        left = [name for name in self.everything() if name.endswith(".part") or os.path.basename(name) in RESULTS]
        self.assertEqual(left, [], result)

    def test_unstable_time_step_is_refused_before_the_run(self):
        self.fails(BAD_INPUT, "fill", self.new_case(), *SMALL, "--set", "time.step=0.004 s", "-o", "out", says=["0.004 s is unstable", "% of the limit", "against"])

    def test_run_that_becomes_unstable_says_when_and_why(self):
        """Pellets shot down far faster than the step was judged for: one error with time, step and cause, and no result."""
        result = self.run_program("fill", self.new_case(), *SMALL, "--set", "insertion.fall_speed=80 m/s", "--set", "pellet.count=60", "-o", "out")
        self.assertEqual(result.code, NUMERICAL, result)
        self.assertEqual(result.err.count("error:"), 1, result)
        for word in ("time ", "step ", "what to do:"):
            self.assertIn(word, result.err, result)
        self.assertEqual([name for name in self.everything() if os.path.basename(name) in RESULTS], [], result)

    def test_pellet_that_leaves_the_domain_is_named_with_place_time_and_cause(self):
        """Gravity upwards: the pellets fall out of the open end of the tube."""
        result = self.run_program("fill", self.new_case(), *SMALL, "--set", "gravity=0 m/s^2, 0 m/s^2, 500 m/s^2", "--set", "time.settle_limit=2 s",
                                  "--set", "time.step=5 us", "-o", "out")
        self.assertEqual(result.code, NUMERICAL, result)
        self.assertEqual(result.err.count("error:"), 1, result)
        self.assertRegex(result.err, r"body \d+ left the domain at \(.*\) m .*time [0-9.e-]+ s, step \d+")
        self.assertEqual([name for name in self.everything() if os.path.basename(name) in RESULTS], [], result)

    def test_wall_that_jumps(self):
        self.fails(BAD_INPUT, "fill", self.new_case(), *SMALL, "--set", "physics.vibration_frequency=50000 Hz", "--set",
                   "physics.vibration_amplitude=0 mm, 0 mm, 1 mm", "-o", "out", says=["wall «shell» jumps", "time 0 s", "smaller time step"])

    def test_bodies_that_overlap_a_wall_at_the_start(self):
        """An upright plane through the loose cloud: some pellet stands in its way."""
        case = self.new_case()
        self.write(case, self.read(case) + '\n[walls.divider]\nshape = "plane"\npoint = ["0 mm", "0 mm", "0 mm"]\naxis = [1, 0, 0]\n')
        self.fails(BAD_INPUT, "fill", case, *SMALL, "--set", "pellet.count=200", "-o", "out", says=["body", "overlaps wall «divider» by", "near (", "apart"])


class ExactWalls(PelletlabTest):
    """Walls in closed form, asked for in the case."""

    def values(self, folder):
        return {one["name"]: one["value"] for one in strict_json(self.read(folder, "observables.json"))["values"]}

    def test_exact_tube_with_a_cone_and_air(self):
        plain, case = self.new_case(), "hill.toml"
        self.write(case, self.read(plain) + '\n[walls.hill]\nshape = "cone"\npoint = ["0 mm", "0 mm", "0 mm"]\naxis = [0, 0, 1]\nradius = "20 mm"\n'
                   'far_radius = "0 mm"\nlength = "12 mm"\n\n[contacts.pellet-hill]\nrestitution = 0.2\nsliding_friction = 2\nrolling_friction = 1\n')
        settings = [*SMALL, "--set", "time.settle_limit=0.3 s", "--set", "pellet.count=12", "--set", "insertion.packing_fraction=2 %"]
        self.succeeds("fill", plain, *settings, "-o", "plain")
        self.succeeds("fill", case, *settings, "-o", "hill")
        self.assertIn('shape = "cone"', self.read("hill/case.resolved.toml"))
        # Friction holds the pellets on the slope (31°). Spread over it they lie 4 mm higher in the mean; none may lie inside the cone.
        self.assertGreater(self.values("hill")["mean_centroid_height"], self.values("plain")["mean_centroid_height"] + 1.0)
        self.succeeds("fill", plain, *settings, "--set", "tube.surface=exact", "--set", "physics.air_density=1.2 kg/m^3",
                      "--set", "physics.air_viscosity=1.8e-5 Pa*s", "-o", "exact")
        heights = [self.values(folder)["mean_centroid_height"] for folder in ("plain", "exact")]
        self.assertAlmostEqual(heights[0], heights[1], delta=1.0)  # [mm]: a single layer, and in one of the two the air slows the fall a little
        self.assertIn('surface = "exact"', self.read("exact/case.resolved.toml"))

    def test_exact_drum_with_a_lifter_that_turns(self):
        case = self.new_case("drum")
        self.write(case, self.read(case) + '\n[walls.lifter]\nshape = "box"\npoint = ["0 mm", "0 mm", "37 mm"]\nsize = ["4 mm", "20 mm", "8 mm"]\n'
                   'turns = true\n')
        settings = [*SMALL_DRUM, "--set", "drum.surface=exact", "--set", "drum.speed=200 rpm", "--set", "time.measure=0.2 s"]
        self.succeeds("drum", case, *settings, "-o", "out")
        self.assertIn("[walls.lifter]", self.read("out/case.resolved.toml"))
        self.fails(BAD_INPUT, "fill", case, "--set", "rig=tube", "--set", "pellet.count=6", "-o", "tube", says=["walls.lifter", "only a drum or a tester turns", "drum.toml:"])

    def test_mistakes_have_their_place(self):
        case = self.new_case()
        text = self.read(case)
        line = text.count("\n") + 2
        for lines, number, says in (
                ('[walls.pin]\nshape = "sphere"', 1, ["walls.pin.shape", "box"]),
                ('[walls.pin]\nshape = "box"\npoint = ["0 mm", "0 mm", "0 mm"]\nsize = ["1 mm", "0 mm", "1 mm"]', 3, ["a box needs three edges"]),
                ('[walls.pin]\nshape = "plane"\npoint = [0, 0, 0]', 2, ["unit"]),
                ('[walls.pin]\nshape = "plane"\npoint = ["0 mm", "0 mm", "0 mm"]\naxes = [0, 0, 1]', 3, ["axes", "axis"])):
            self.write(case, text + "\n" + lines + "\n")
            self.fails(BAD_INPUT, "case", "check", case, says=[f"{case}:{line + number}", *says])


class InterruptedRuns(PelletlabTest):
    def part_file(self):
        return any(name.endswith(".part") for name in self.everything())

    def leaves_a_checkpoint_only(self, result):
        """See test_resume.py for what becomes of it."""
        self.assertEqual(result.code, INTERRUPTED, result)
        self.assertIn("interrupt", result.err.lower(), result)
        left = [name for name in self.everything() if name.startswith("out/") and not os.path.isdir(self.path(name))]
        self.assertIn("out/unfinished.part/resume/run.checkpoint", left, result)
        self.assertTrue(all(name.startswith("out/unfinished.part/resume/") for name in left), left)

    def test_ctrl_c_in_the_middle_of_a_run(self):
        process = self.start("fill", self.new_case(), *LONG, "-o", "out")
        self.leaves_a_checkpoint_only(self.interrupt(process, self.part_file))

    def test_sigterm_in_the_middle_of_a_run(self):
        process = self.start("drum", self.new_case("drum"), *LONG, "-o", "out")
        self.leaves_a_checkpoint_only(self.interrupt(process, self.part_file, signal.SIGTERM))

    def test_ctrl_c_in_the_middle_of_a_fit(self):
        bodies.write_binary_stl(self.path("pellet.stl"), bodies.cylinder(facets=96))
        process = self.start("shape", "pellet.stl", "--unit", "mm", "-n", "1500", "-o", "pellet.clump.toml")
        self.assertIn("pellet.stl", process.stdout.readline())  # the mesh is read and checked: the fit begins
        begin = time.monotonic()
        result = self.interrupt(process, lambda: time.monotonic() - begin > 0.5)
        self.assertEqual(result.code, INTERRUPTED, result)
        self.assertEqual(self.everything(), ["pellet.stl"], result)

    def test_next_run_clears_what_a_killed_one_left(self):
        file = self.new_case()
        process = self.start("fill", file, *LONG, "-o", "out")
        self.interrupt(process, self.part_file, signal.SIGKILL)
        self.assertTrue(self.part_file(), "the killed run should have left a .part file, else this test shows nothing")
        self.assertFalse(os.path.exists(self.path("out/stage.json")))
        self.succeeds("fill", file, *SMALL, "-o", "out")
        self.assertFalse(self.part_file(), self.everything())

    def test_interrupted_run_over_an_older_result_leaves_no_mixture(self):
        """Either the old result stays whole, or nothing is left of it: never the new case beside the old numbers."""
        file = self.new_case()
        self.succeeds("fill", file, *SMALL, "-o", "out")
        old = {name: self.read("out", name) for name in ("case.resolved.toml", "observables.json")}
        process = self.start("fill", file, *LONG, "-o", "out")
        result = self.interrupt(process, self.part_file)
        self.assertEqual(result.code, INTERRUPTED, result)
        if os.path.exists(self.path("out/observables.json")):
            self.assertEqual(self.read("out", "case.resolved.toml"), old["case.resolved.toml"], "new case beside old numbers")
            self.assertEqual(self.read("out", "observables.json"), old["observables.json"])

    def test_run_leaves_files_of_others_alone(self):
        """The output folder may hold other things: a user's own .part file is not the program's to delete."""
        file = self.new_case()
        os.makedirs(self.path("out/my-downloads"))
        self.write("out/my-downloads/film.mkv.part", "mine")
        self.write("out/notes.txt", "mine")
        self.succeeds("fill", file, *SMALL, "-o", "out")
        self.assertEqual(self.read("out/my-downloads/film.mkv.part"), "mine")
        self.assertEqual(self.read("out/notes.txt"), "mine")
