"""pelletlab compare: filled tubes against measured heights."""

import csv

from harness import BAD_INPUT, SMALL, USAGE, PelletlabTest

# A few pellets that count as at rest once they lie: what is compared need not be a good bed here.
QUICK = [*SMALL, "--set", "time.settle_limit=1 s", "--set", "time.rest_kinetic_energy=0.05", "--set", "time.rest_contact_change=1", "--set", "time.step=2e-5 s"]


class Compare(PelletlabTest):
    def fill(self, seed, *more):
        folder = f"tube-{seed}"
        self.succeeds("fill", self.new_case(), *QUICK, "--set", f"seed={seed}", *more, "-o", folder)
        return folder

    def test_beds_against_measured_heights(self):
        runs = [self.fill(seed) for seed in (1, 2)]
        # The laboratory's mean lies where no bed of six pellets does; the other fill was not simulated.
        self.write("heights.csv", "pellets,mass [g],height [mm]\n6,0.23,30\n6,0.23,31\n6,0.23,32\n600,23,80\n")
        result = self.succeeds("compare", "tube", "heights.csv", "--runs", *runs, "-o", "compared")
        for words in ("mass check: 38.33 mg a pellet", "differs", "lower", "left out: measured fill of 600 pellets", "Dixon 1988"):
            self.assertIn(words, result.out)
        with open(self.path("compared", "comparison.csv"), newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(row["against"], row["verdict"], row["first_n"], row["second_n"]) for row in rows], [("measured", "differs", "2", "3")])
        self.assertLess(float(rows[0]["upper [mm]"]), 0.0)
        self.assertIn("compared/comparison.png", self.everything())

    def test_what_cannot_be_compared(self):
        run = self.fill(1)
        self.write("heights.csv", "pellets,height [mm]\n6,30\n6,31\n")
        self.fails(BAD_INPUT, "compare", "tube", "heights.csv", "--runs", run, run, "-o", "no", says="same bed")
        self.fails(BAD_INPUT, "compare", "tube", "heights.csv", "--runs", "nowhere", "-o", "no", says="nowhere")
        self.fails(USAGE, "compare", "tube", "heights.csv", "--runs", run, "--definition", "height", "-o", "no", says=["bed_height_h95"])
        self.write("heights.csv", "pellets,height\n6,30\n")
        self.fails(BAD_INPUT, "compare", "tube", "heights.csv", "--runs", run, "-o", "no", says="heights.csv:1:9")
        slippery = self.fill(2, "--set", "contacts.pellet-pellet.sliding_friction=0.1")
        self.write("heights.csv", "pellets,height [mm]\n6,30\n6,31\n")
        self.fails(BAD_INPUT, "compare", "tube", "heights.csv", "--runs", run, slippery, "-o", "no", says=["no repeats", "friction"])
