"""pelletlab campaign and calibrate: many small runs, killed in the middle, one table, and what it says about the parameters."""

import csv
import json
import os
import re
import signal
import time

from harness import BAD_INPUT, SMALL, SOURCE, PelletlabTest

PLAN = """name = "small"
largest_failed_share = 1.0
good = ["complete", "not at rest"]
[[rig]]
name = "tube"
case = "tube.toml"
set = ["pellet.count=20", "time.settle_limit=0.4 s", "time.step=2e-5 s", "output.frame_interval=0.01 s"]
[[parameter]]
name = "sliding"
keys = ["contacts.pellet-pellet.sliding_friction", "contacts.pellet-vessel.sliding_friction"]
range = [0.2, 0.9]
[[observable]]
name = "mean_centroid_height"
tolerance = 0.5
[design]
points = 8
anchors = 2
repeats = 2
"""


class Campaign(PelletlabTest):
    def prepare(self, plan=PLAN):
        self.new_case()
        return self.write("plan.toml", plan)

    def rows(self):
        with open(self.path("c", "runs.csv"), newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_a_killed_campaign_goes_on_and_gives_one_table(self):
        plan = self.prepare()
        process = self.start("campaign", "run", plan, "-o", "c", "--jobs", "2", start_new_session=True)
        for _ in range(600):
            time.sleep(0.05)
            status = self.run_program("campaign", "status", plan, "-o", "c")
            finished = re.search(r"finished\s+(\d+)", status.out)
            if finished and int(finished.group(1)) > 0:
                break
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        result = self.succeeds("campaign", "run", plan, "-o", "c", "--jobs", "2")
        self.assertNotIn(" 0 of them finished before", result.out)
        rows = self.rows()
        self.assertEqual(len(rows), 10)
        self.assertEqual(len({(row["sliding"], row["seed"]) for row in rows}), 10)
        self.assertEqual(len({row["sliding"] for row in rows}), 8)
        self.assertTrue(all(float(row["mean_centroid_height"]) > 0 for row in rows))
        table = self.read("c", "runs.csv")
        # Again there is nothing to do; from the beginning in another folder, by hand, come the same numbers.
        self.assertIn("10 runs, 10 of them finished before", self.succeeds("campaign", "run", plan, "-o", "c").out)
        self.succeeds("campaign", "run", plan, "-o", "d", "--launcher", "parallel", "--jobs", "1")
        with open(self.path("d", "jobs.txt"), encoding="utf-8") as file:
            self.assertIn("campaign work", file.read())
        self.succeeds("campaign", "work", plan, "-o", "d")
        self.succeeds("campaign", "export", plan, "-o", "d")
        self.assertEqual(self.read("d", "runs.csv"), table)
        self.succeeds("campaign", "run", plan, "-o", "e", "--launcher", "slurm", "--jobs", "3")
        self.assertIn("#SBATCH --array=1-3", self.read("e", "array.sbatch"))
        # Calibrated on its own middle, the friction stays open: five pellets do not know it.
        middle = sorted(float(row["mean_centroid_height"]) for row in rows)[5]
        self.write("experiment.toml", f"""name = "own"
campaign = "c/campaign.toml"
[[measurement]]
observable = "mean_centroid_height"
regime = "tube"
value = {middle}
unit = "mm"
uncertainty = 0.5
""")
        result = self.succeeds("calibrate", "experiment.toml", "-o", "cal")
        self.assertIn("sliding", result.out)
        found = json.loads(self.read("cal", "calibration.json"))
        low, high = found["parameters"][0]["interval_90"]
        self.assertTrue(0.2 <= low < high <= 0.9)

    def test_what_is_wrong_is_said_before_anything_runs(self):
        plan = self.prepare(PLAN.replace("contacts.pellet-vessel.sliding_friction", "contacts.pellet-vessel.sliding"))
        self.fails(BAD_INPUT, "campaign", "run", plan, "-o", "c", says="sliding")
        self.write("plan.toml", PLAN.replace('case = "tube.toml"', 'case = "nowhere.toml"'))
        self.fails(BAD_INPUT, "campaign", "run", plan, "-o", "c", says="nowhere.toml")
        self.write("plan.toml", PLAN.replace("range = [0.2, 0.9]", "range = [0.9, 0.2]"))
        self.fails(BAD_INPUT, "campaign", "run", plan, "-o", "c", says="plan.toml:11")

    def test_effects_of_the_library(self):
        library = """[[effect]]
name = "pellet_size"
full = 0.1
[[effect]]
name = "tapping"
full = 2
[[effect]]
name = "surface_threshold"
[[observable]]
name = "bed_height"
tolerance = 0.5
"""
        plan = self.prepare(PLAN.replace("[[rig]]", """[[rig]]
name = "drum"
case = "drum.toml"
set = ["pellet.count=20", "drum.diameter=30 mm", "drum.length=10 mm", "time.settle_limit=0.1 s", "time.spin_up=0.02 s", "time.measure=0.1 s", "time.step=2e-5 s", "output.frame_interval=0.01 s"]
[[rig]]""", 1).replace('"not at rest"]', '"not at rest", "not steady", "thin bed"]').replace("[[observable]]", library + "[[observable]]", 1).replace("points = 8", "points = 10\nruns_an_effect = 4"))
        self.succeeds("case", "new", "drum", "-o", "drum.toml")
        self.assertIn("readings of them by instruments", self.succeeds("campaign", "run", plan, "-o", "c", "--jobs", "2").out)
        rows = self.rows()
        self.assertEqual(len(rows), 2 * (10 + 2 + 4 + 4 + 4))
        sizes = [float(row["pellet_size"]) for row in rows if float(row["pellet_size"]) != 0]
        self.assertEqual(len(sizes), 8)
        self.assertTrue(all(0.015 <= abs(a) <= 0.1 for a in sizes) and min(sizes) < 0 < max(sizes))
        self.assertEqual({float(row["tapping"]) for row in rows}, {0, 1, 2})
        # An instrument's reading is the base point's own run, moved by the amplitude and by nothing else.
        read = [row for row in rows if row["regime"] == "drum" and float(row["surface_threshold"]) != 0]
        self.assertEqual(len(read), 4)
        for row in read:
            base = next(r for r in rows if r["regime"] == "drum" and r["seed"] == row["seed"] and float(r["surface_threshold"]) == 0)
            self.assertEqual(row["sliding"], base["sliding"])
            if base["bed_height"]:
                self.assertAlmostEqual(float(row["bed_height"]) - float(base["bed_height"]), float(row["surface_threshold"]), places=9)
        self.assertIn('class = "operation"', self.read("c", "campaign.toml"))
        table = self.succeeds("diagnose", "signatures", "c/campaign.toml").out
        self.assertIn("pellet_size", table)
        self.write("plan.toml", self.read(plan).replace('"tapping"', '"taping"'))
        self.fails(BAD_INPUT, "campaign", "run", "plan.toml", "-o", "d", says="did you mean 'tapping'")

    def test_one_run_with_an_effect(self):
        self.new_case()
        small = ["fill", "tube.toml", *SMALL]
        plain = self.succeeds(*small, "-o", "plain").out
        state = re.search(r"state hash (\w+)", plain).group(1)
        self.assertEqual(re.search(r"state hash (\w+)", self.succeeds(*small, "-o", "none", "--effect", "pellet_size=0").out).group(1), state)
        self.assertNotEqual(re.search(r"state hash (\w+)", self.succeeds(*small, "-o", "large", "--effect", "pellet_size=0.05").out).group(1), state)
        self.assertIn("size_factor = 1.05", self.read("large", "case.resolved.toml"))
        self.fails(BAD_INPUT, *small, "-o", "x", "--effect", "pelet_size=0.05", says="did you mean 'pellet_size'")
        self.fails(BAD_INPUT, *small, "-o", "x", "--effect", "camera_layer=1", says="changes no run")
        self.fails(BAD_INPUT, *small, "-o", "x", "--effect", "pellet_size=-0.99", says="with its effects the case is not possible")

    def test_the_page_of_effects_is_that_of_the_program(self):
        with open(os.path.join(SOURCE, "docs", "effects.md"), encoding="utf-8") as stream:
            page = stream.read()
        table = self.succeeds("diagnose", "effects", "--markdown").out.strip("\n")
        self.assertIn(table, page, "run: pelletlab diagnose effects --markdown, and put it into docs/effects.md")
        names = re.findall(r"^\S+\s+(\w+)  \(", self.succeeds("diagnose", "effects").out, re.MULTILINE)
        self.assertGreaterEqual(len(names), 20)
        for name in names:
            self.assertIn(f"`{name}`", table)
