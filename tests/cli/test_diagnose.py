"""pelletlab diagnose on the made-up campaign of examples/diagnosis: verdict, files, messages, blind cases."""

import json
import os
import shutil

import harness
from harness import BAD_INPUT, USAGE, PelletlabTest

EXAMPLE = os.path.join(harness.SOURCE, "examples", "diagnosis")


class Diagnose(PelletlabTest):
    def take_example(self, **changes):
        """A copy of the example; experiment.toml with every key of `changes` replaced by its value, and few simulated cases."""
        shutil.copytree(EXAMPLE, self.path("example"))
        text = self.read("example", "experiment.toml").replace("recalibration_cases = 40", "recalibration_cases = 10")
        for old, new in changes.get("replace", []):
            self.assertIn(old, text)
            text = text.replace(old, new, 1)
        self.write(os.path.join("example", "experiment.toml"), text)
        return os.path.join("example", "experiment.toml")

    def test_run_finds_the_effect_that_made_the_data(self):
        experiment = self.take_example()
        result = self.succeeds("diagnose", "run", experiment, "-o", "out")
        self.assertIn("== EFFECT", result.out)
        with open(self.path("out", "diagnosis.json"), encoding="utf-8") as stream:
            diagnosis = json.load(stream)["diagnosis"]
        self.assertEqual(diagnosis["named"], ["rolling"])
        rolling = next(h for h in diagnosis["hypotheses"] if h["name"] == "rolling")["amplitudes"][0]
        self.assertTrue(rolling["lower"] < (0.24 / 0.4) ** 0.5 < rolling["upper"], rolling)  # what the data were made with
        held_out = next(s for s in diagnosis["how_far"] if s["data"] == "held out")
        self.assertLess(held_out["after"], held_out["before"])
        page = self.read("out", "report.html")
        self.assertIn("EFFECT", page)
        self.assertNotIn("<script", page)
        self.assertFalse([name for name in self.everything() if name.endswith(".part")])
        # the same again, with another number of threads: the same bytes
        self.succeeds("--threads", "1", "diagnose", "run", experiment, "-o", "again")
        self.assertEqual(self.read("out", "diagnosis.json"), self.read("again", "diagnosis.json"))
        self.succeeds("diagnose", "report", os.path.join("out", "diagnosis.json"), "-o", "page.html")
        self.assertEqual(self.read("page.html"), page)

    def test_audit_and_plan_do_not_judge(self):
        experiment = self.take_example()
        self.assertIn("runs within the effects' ranges", self.succeeds("diagnose", "audit", experiment).out)
        plan = self.succeeds("diagnose", "plan", experiment).out
        self.assertIn("lambda", plan)
        for verdict in ("NO-GAP", "EFFECT", "OUTSIDE"):
            self.assertNotIn(verdict, plan)

    def test_the_same_data_twice(self):
        experiment = self.take_example(replace=[("measured_35rpm.csv", "measured_20rpm.csv")])
        self.fails(BAD_INPUT, "diagnose", "run", experiment, "-o", "out", says=["same data", "held out"])

    def test_an_unknown_key_and_a_missing_file(self):
        experiment = self.take_example(replace=[("seed = 1", "sede = 1")])
        self.fails(BAD_INPUT, "diagnose", "plan", experiment, says=["sede", "experiment.toml:"])
        self.fails(BAD_INPUT, "diagnose", "plan", "nowhere.toml", says="nowhere.toml")
        self.fails(USAGE, "diagnose", says="required")

    def test_a_report_of_something_else(self):
        self.write("other.json", "{}")
        self.fails(BAD_INPUT, "diagnose", "report", "other.json", "-o", "page.html", says="no diagnosis")

    def test_blind_cases_are_sealed_judged_and_scored(self):
        experiment = self.take_example()
        self.succeeds("diagnose", "blind", "make", experiment, "-o", "blind", "--cases", "8", "--seed", "3")
        self.fails(BAD_INPUT, "diagnose", "blind", "score", "blind", says="no verdicts")
        public = [name for name in self.everything() if name.startswith(os.path.join("blind", "public"))]
        for name in public:
            if name.endswith((".toml", ".csv")):
                text = self.read(name)
                for word in ("null", "single", "outside", "seal", "amplitude"):
                    self.assertNotIn(word, text, name)
        self.succeeds("diagnose", "blind", "run", "blind")
        score = self.succeeds("diagnose", "blind", "score", "blind").out
        self.assertIn("false alarm on nulls", score)
        self.assertEqual(self.read("blind", "sealed", "unsealed.log").count("\n"), 1)
        labels = self.read("blind", "sealed", "labels.json")
        self.write(os.path.join("blind", "sealed", "labels.json"), labels.replace("\"configuration\": ", "\"configuration\": 1", 1))
        result = self.run_program("diagnose", "blind", "score", "blind")
        self.assertEqual(result.code, BAD_INPUT, result)
        self.assertIn("not the one that was sealed", result.err)
        self.write(os.path.join("blind", "verdicts", "thresholds.txt"), "loose\n")
        self.fails(BAD_INPUT, "diagnose", "blind", "score", "blind", says="changed after they were frozen")
