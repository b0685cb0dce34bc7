"""The command line itself: help, version, words that are no verbs."""

import re

from harness import BAD_INPUT, USAGE, PelletlabTest

VERBS = [["shape"], ["shape", "export"], ["shape", "import"], ["shape", "compare"], ["shape", "pareto"], ["shape", "family"],
         ["fill"], ["drum"], ["pile"], ["tester"], ["demo"],
         ["observe"], ["observe", "tube"], ["observe", "pile"], ["observe", "drum"], ["observe", "tester"],
         ["compare"], ["compare", "tube"], ["campaign"], ["campaign", "run"], ["campaign", "work"], ["campaign", "status"], ["campaign", "export"], ["calibrate"],
         ["mesh"], ["mesh", "check"], ["mesh", "make"], ["mesh", "assets"],
         ["case"], ["case", "new"], ["case", "check"], ["case", "schema"], ["case", "reference"],
         ["diagnose"], ["diagnose", "audit"], ["diagnose", "plan"], ["diagnose", "run"], ["diagnose", "report"], ["diagnose", "effects"], ["diagnose", "signatures"],
         ["diagnose", "blind"], ["diagnose", "blind", "make"], ["diagnose", "blind", "run"], ["diagnose", "blind", "score"]]


class Usage(PelletlabTest):
    def test_help_of_every_verb_has_an_example(self):
        for verb in VERBS:
            help_text = self.succeeds(*verb, "--help").out
            if verb in (["case"], ["mesh"], ["observe"], ["compare"], ["campaign"], ["diagnose"], ["diagnose", "blind"]):  # groups: their verbs are listed, each with its example
                self.assertIn("example: pelletlab", help_text, verb)
            else:
                self.assertIn("example: pelletlab " + " ".join(verb), help_text, verb)

    def test_help_lists_every_verb_and_shows_the_chain(self):
        text = self.succeeds("--help").out
        for verb in ("shape", "fill", "drum", "pile", "tester", "observe", "compare", "campaign", "calibrate", "demo", "mesh", "case", "diagnose"):
            self.assertRegex(text, rf"(?m)^\s+{verb}\b")
        self.assertIn("pelletlab shape", text)

    def test_examples_of_the_help_are_valid_command_lines(self):
        for verb in VERBS:
            for line in re.findall(r"example: pelletlab (.*)", self.succeeds(*verb, "--help").out):
                words = [word.replace('"', "") for word in re.findall(r'(?:"[^"]*"|\S)+', line)]
                result = self.run_program(*words, "--help")
                self.assertEqual(result.code, 0, result)

    def test_version_names_program_number_and_commit(self):
        self.assertRegex(self.succeeds("--version").out, r"^pelletlab \d+\.\d+\.\d+ \([0-9a-f]{7,}|^pelletlab \d+\.\d+\.\d+ \(unknown\)")

    def test_no_verb(self):
        self.fails(USAGE)

    def test_unknown_verb(self):
        self.fails(USAGE, "shpe", says="shpe")

    def test_unknown_option(self):
        self.fails(USAGE, "case", "new", "tube", "--colour", "red", says="--colour")

    def test_missing_argument(self):
        for verb in ("shape", "fill", "drum", "pile", "tester"):
            self.fails(USAGE, verb, says="required")

    def test_numbers_out_of_range(self):
        self.fails(USAGE, "--threads", "-1", "case", "schema", says="threads")
        self.fails(USAGE, "--threads", "many", "case", "schema", says="threads")
        self.fails(USAGE, "shape", "x.stl", "-n", "0", says="spheres")

    def test_unknown_rig_of_a_new_case(self):
        self.fails(USAGE, "case", "new", "silo", says=["tube", "drum", "pile"])

    def test_demo_outside_the_source_folder(self):
        self.fails(USAGE, "demo", "-o", "demo-out", says="--source")

    def test_case_new_overwrites_nothing(self):
        self.write("mine.toml", "precious\n")
        self.fails(BAD_INPUT, "case", "new", "tube", "-o", "mine.toml", says="mine.toml")
        self.assertEqual(self.read("mine.toml"), "precious\n")
        self.succeeds("case", "new", "tube", "-o", "mine.toml", "--overwrite")
