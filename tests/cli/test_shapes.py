"""The verbs below `shape`, other methods than the fit, parametric and mended bodies; and what `shape` refuses."""

import math
import os
import re

import bodies
from harness import BAD_INPUT, USAGE, PelletlabTest

FORMATS = ["liggghts", "lammps", "yade", "mercury", "chrono", "pfc", "edem", "csv", "vtk", "stl"]


def spheres_of(text):
    """Rows of numbers in mm of a clump file."""
    block = text[text.index("spheres = ["):text.index("[mass_properties]")]
    return [[float(x.replace("mm", "")) for x in re.findall(r'"([^"]*)"', row)] for row in block.splitlines() if row.startswith("  [")]


def value_of(text, key):
    return float(re.search(rf'(?m)^{key} = "?([-+.\de]+)', text).group(1))


class ShapeClump(PelletlabTest):
    """With the clump of the shelf: the name brings the fixture."""

    def setUp(self):
        super().setUp()
        self.take_clump()


class ShapeCaseExport(ShapeClump):
    def test_every_format_and_back_again(self):
        self.succeeds("shape", "export", "pellet.clump.toml", "--to", "all", "-o", "out")
        wanted = spheres_of(self.read("pellet.clump.toml"))
        mains = {"liggghts": ["pellet.liggghts.txt", "pellet.liggghts.in"], "lammps": ["pellet.lammps.mol"], "yade": ["pellet.yade.txt", "pellet_yade.py"],
                 "mercury": ["pellet/Clump/Clump.txt", "pellet/Inertia/Mass.txt", "pellet/Inertia/TOI.txt", "pellet/Inertia/PD.txt"],
                 "chrono": ["pellet.chrono.csv", "pellet_chrono.py"], "pfc": ["pellet.p3dat"], "edem": ["pellet.edem.txt"],
                 "csv": ["pellet.csv", "pellet.mass.csv"], "vtk": ["pellet.vtk"]}
        for name, files in mains.items():
            units = ["--length-unit", "m", "--mass-unit", "kg"] if name == "mercury" else []
            found = self.succeeds("shape", "import", *[os.path.join("out", f) for f in files], "--from", name, *units, "--density", "1800 kg/m^3",
                                  "-o", f"{name}.clump.toml")
            text = self.read(f"{name}.clump.toml")
            for a, b in zip(spheres_of(text), wanted):
                if name == "edem":  # holds no mass properties: the frame is that of the union, other than the mesh's
                    a, b = a[3:], b[3:]
                self.assertLess(max(abs(x - y) for x, y in zip(a, b)), 1e-9, f"{name} {found}")  # Chrono keeps 1e-10 of the size
            self.assertEqual(len(spheres_of(text)), len(wanted), name)
            if "mass properties from  the file" in found.out:
                self.assertAlmostEqual(value_of(text, "mass") / value_of(self.read("pellet.clump.toml"), "mass"), 1.0, delta=1e-9, msg=name)
        self.assertTrue(os.path.getsize(self.path("out", "pellet.union.stl")) > 84)

    def test_ends_without_a_trace_when_refused(self):
        self.fails(USAGE, "shape", "export", "pellet.clump.toml", "--to", "ligghts", "-o", "out", says="liggghts")
        self.fails(USAGE, "shape", "export", "pellet.clump.toml", says="--to")
        self.fails(BAD_INPUT, "shape", "export", "nowhere.clump.toml", "--to", "csv", "-o", "out", says="nowhere")
        self.fails(BAD_INPUT, "shape", "export", "pellet.clump.toml", "--to", "csv", "--length-unit", "furlong", "-o", "out", says="furlong")
        self.fails(USAGE, "shape", "export", "pellet.clump.toml", "-n", "5", "--to", "csv", says="--spheres")

    def test_import_against_the_mesh_finds_the_same_quality(self):
        self.succeeds("shape", "export", "pellet.clump.toml", "--to", "vtk")
        self.succeeds("shape", "import", "pellet.vtk", "--mesh", "pellet.stl", "--unit", "mm", "-o", "again.clump.toml")
        for key in ("volume_error", "symmetric_difference"):
            self.assertAlmostEqual(value_of(self.read("again.clump.toml"), key), value_of(self.read("pellet.clump.toml"), key), delta=1e-9)
        self.fails(BAD_INPUT, "shape", "import", "pellet.vtk", "--mesh", "pellet.stl", "-o", "x.clump.toml", says="unit")

    def test_import_refuses_what_is_no_clump(self):
        self.write("letter.csv", "Dear Ann,\nplease find enclosed …\n")
        self.fails(BAD_INPUT, "shape", "import", "letter.csv", "--density", "1800 kg/m^3", "-o", "x.clump.toml", says="letter.csv")
        self.write("bare.csv", "x [mm],y [mm],z [mm],radius [mm]\n0,0,0,1\n")
        self.fails(BAD_INPUT, "shape", "import", "bare.csv", "-o", "x.clump.toml", says="density")
        self.fails(USAGE, "shape", "import", "bare.xyz", "-o", "x.clump.toml", says="--from")
        self.fails(USAGE, "shape", "import", "out.union.stl", "-o", "x.clump.toml", says="cannot be read")
        self.succeeds("shape", "import", "bare.csv", "--density", "1000 kg/m^3", "-o", "ball.clump.toml")
        self.assertAlmostEqual(value_of(self.read("ball.clump.toml"), "mass"), 4.0 / 3.0 * math.pi, delta=1e-5)  # mg


class Shapes(PelletlabTest):
    def test_parametric_body_brings_its_mesh(self):
        self.succeeds("shape", "--body", "cylinder:diameter=3mm,height=3mm,rim_radius=0.3mm,facets=24", "-n", "3", "--no-picture", "-o", "a/tablet.clump.toml")
        self.assertEqual(sorted(os.listdir(self.path("a"))), ["tablet.clump.toml", "tablet.stl"])
        self.assertIn('file = "tablet.stl"', self.read("a", "tablet.clump.toml"))
        self.succeeds("mesh", "check", "a/tablet.stl", "--unit", "mm")
        again = self.succeeds("shape", "--body", "cylinder:diameter=3mm,height=3mm,rim_radius=0.3mm,facets=24", "-n", "3", "--no-picture",
                              "-o", "a/tablet.clump.toml")
        self.assertIn("up to date", again.out)

    def test_bodies_that_cannot_be(self):
        for text, says in (("cilinder", "cylinder"), ("cylinder:diametre=3mm", "diameter"), ("cylinder:diameter=3", "unit"), ("ring:inner_diameter=9mm", "diameter"),
                           ("box:x=0mm", "positive"), ("sphere:diameter=3km", "unit")):
            self.fails(BAD_INPUT, "shape", "--body", text, "-n", "2", "-o", "out/x.clump.toml", says=says)
            self.fails(BAD_INPUT, "mesh", "make", text, "-o", "out/x.stl", says=says)
        self.fails(USAGE, "shape", "pellet.stl", "--body", "sphere", says="--body")

    def test_made_mesh_is_the_body(self):
        self.succeeds("mesh", "make", "box:x=1mm,y=2mm,z=3mm", "-o", "box.stl")
        self.assertRegex(self.succeeds("mesh", "check", "box.stl", "--unit", "mm").out, r"6(\.0+)? mm")

    def test_methods_of_others(self):
        shaped = self.succeeds("shape", "--body", "cylinder:facets=32", "--method", "shape2", "--no-picture", "--against", "favier", "-o", "s.clump.toml")
        self.assertEqual(len(spheres_of(self.read("s.clump.toml"))), 24)
        self.assertIn("hand-made", shaped.out)
        self.assertIn("volume-matched", shaped.out)
        self.succeeds("shape", "--body", "cylinder:facets=32", "--method", "shape2", "--volume-matched", "--no-picture", "-o", "m.clump.toml")
        self.assertLess(abs(value_of(self.read("m.clump.toml"), "volume_error")), 1e-6)
        self.assertLess(value_of(self.read("s.clump.toml"), "volume_error"), -0.1)
        self.fails(BAD_INPUT, "shape", "--body", "trilobe:facets=36", "--method", "shape2", "-o", "x.clump.toml", says="3.12 x 2.96")
        self.fails(BAD_INPUT, "shape", "--body", "ring:facets=24", "--method", "favier", "-o", "x.clump.toml", says="axis")
        self.fails(USAGE, "shape", "--body", "cylinder", "--method", "favourite", "-o", "x.clump.toml", says="favier")
        self.fails(USAGE, "shape", "--body", "cylinder", "--volume-matched", "-o", "x.clump.toml", says="--method")

    def test_mending_is_asked_for_and_said(self):
        bodies.write_binary_stl(self.path("open.stl"), bodies.without_a_triangle(bodies.cylinder()))
        self.fails(BAD_INPUT, "shape", "open.stl", "--unit", "mm", "-n", "2", "-o", "x.clump.toml", says=["open", "--repair"])
        mended = self.succeeds("shape", "open.stl", "--unit", "mm", "-n", "2", "--repair", "automatic", "--no-picture", "-o", "open.clump.toml")
        self.assertIn("repaired:", mended.out)
        self.assertIn('file = "open.repaired.stl"', self.read("open.clump.toml"))
        self.succeeds("mesh", "check", "open.repaired.stl", "--unit", "mm")
        bodies.write_binary_stl(self.path("crossing.stl"), bodies.crossing())
        self.assertIn("repaired:", self.succeeds("shape", "crossing.stl", "--unit", "mm", "-n", "2", "--repair", "unite-shells", "--no-picture",
                                                 "-o", "c.clump.toml").out)
        bodies.write_binary_stl(self.path("flat.stl"), bodies.flat())
        self.fails(BAD_INPUT, "shape", "flat.stl", "--unit", "mm", "-n", "2", "--repair", "automatic", "-o", "x.clump.toml", says="volume")

    def test_numbers_out_of_reach(self):
        bodies.write_binary_stl(self.path("pellet.stl"), bodies.cylinder())
        for n in ("0", "1000000", "-3", "many"):
            self.fails(USAGE, "shape", "pellet.stl", "--unit", "mm", "-n", n, "-o", "x.clump.toml", says="spheres")
        self.fails(BAD_INPUT, "shape", "pellet.stl", "--unit", "mm", "-n", "3", "--min-radius", "2 mm", "-o", "x.clump.toml", says="larger than the body")
        self.fails(BAD_INPUT, "shape", "pellet.stl", "--unit", "mm", "-n", "3", "--min-radius", "0.2", "-o", "x.clump.toml", says="unit")

    def test_two_bodies_far_apart(self):
        bodies.write_binary_stl(self.path("two.stl"), bodies.box() + bodies.box((50, 0, 0), (53, 2, 1)))
        self.fails(BAD_INPUT, "shape", "two.stl", "--unit", "mm", "-n", "3", "-o", "x.clump.toml", says="bodies")
        self.fails(BAD_INPUT, "shape", "two.stl", "--unit", "mm", "-n", "3", "--repair", "automatic", "-o", "x.clump.toml")

    def test_kinds_of_files(self):
        """The same tetrahedron as OBJ and PLY."""
        self.write("t.obj", "v 0 0 0\nv 3 0 0\nv 0 3 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        self.write("t.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
                            "property list uchar int vertex_indices\nend_header\n0 0 0\n3 0 0\n0 3 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n")
        found = []
        for name in ("t.obj", "t.ply"):
            self.succeeds("shape", name, "--unit", "mm", "-n", "4", "--no-picture", "-o", name + ".clump.toml")
            found.append(spheres_of(self.read(name + ".clump.toml")))
        for a, b in zip(*found):
            self.assertLess(max(abs(x - y) for x, y in zip(a, b)), 1e-6)


class ShapeSweeps(PelletlabTest):
    def test_settings_of_the_fit(self):
        body = ["shape", "--body", "cylinder:facets=24", "--no-picture"]
        few = self.succeeds(*body, "--until", "rms=0.12mm", "-o", "until.clump.toml")
        self.assertLess(float(re.search(r'(?m)^both = .*rms = "([\d.e-]+) mm"', self.read("until.clump.toml")).group(1)), 0.12)
        self.assertIn("fits made", few.out)
        self.assertRegex(self.succeeds(*body, "-n", "4", "--mode", "inside", "-o", "inside.clump.toml").out, r"fit +\S")
        self.assertLess(value_of(self.read("inside.clump.toml"), "volume_error"), 0.0)
        self.assertIn("symmetry", self.succeeds(*body, "-n", "8", "--symmetry", "own", "-o", "own.clump.toml").out)
        self.fails(USAGE, *body, "-n", "4", "--until", "rms=0.1mm", "-o", "x.clump.toml", says="--until")
        self.fails(USAGE, *body, "--until", "rsm=0.1mm", "-o", "x.clump.toml", says="rms")
        self.fails(BAD_INPUT, *body, "--until", "rms=0.1", "-o", "x.clump.toml", says="unit")
        self.fails(BAD_INPUT, *body, "--until", "inertia=-1%", "-o", "x.clump.toml", says="positive")
        self.fails(USAGE, *body, "--mode", "best", "-o", "x.clump.toml", says="mode")
        self.fails(USAGE, *body, "--symmetry", "some", "-o", "x.clump.toml", says="own")
        self.fails(USAGE, *body, "--method", "favier", "--mode", "flat", "-o", "x.clump.toml", says="--mode")

    def test_pareto_goes_on_where_it_was(self):
        sweep = ["shape", "pareto", "--body", "cylinder:facets=24", "--counts", "4,8", "--modes", "mean", "--methods", "shape1,favier", "-o", "p"]
        self.succeeds(*sweep)
        rows = self.read("p", "pareto.csv").splitlines()
        self.assertEqual(len(rows), 1 + 2 + 2 + 4)  # head; fits; Shape 1 as drawn and matched; Favier at two numbers, as made and matched
        self.assertTrue(os.path.getsize(self.path("p", "pareto.png")) > 1000)
        self.assertTrue(any(row.split(",")[-2] == "1" for row in rows[1:]), "nothing on the front")
        os.remove(self.path("p", "clumps", "fit-mean-8.clump.toml"))
        self.assertIn("7 of 8 clumps were there already", self.succeeds(*sweep).out)
        self.assertEqual(self.read("p", "pareto.csv").splitlines(), rows)
        self.fails(USAGE, *sweep[:-2], "-o", "q", "--modes", "best", says="mode")
        self.fails(USAGE, "shape", "pareto", says="required")

    def test_family_of_worn_and_varied_pellets(self):
        self.succeeds("shape", "family", "--body", "cylinder:facets=24", "--rim-radius", "0mm,0.4mm", "--ovality", "5%", "--size-spread", "3%", "-n", "4", "-o", "f")
        rows = [row.split(",") for row in self.read("f", "family.csv").splitlines()]
        members = {row[0]: row for row in rows[1:]}
        self.assertEqual(sorted(members), ["oval-0.05", "rim-0.4mm", "rim-0mm", "size-large", "size-middle", "size-small"])
        volume = {name: float(row[5]) for name, row in members.items()}
        self.assertAlmostEqual(volume["oval-0.05"] / volume["rim-0mm"], 1.0, delta=1e-6)  # the same cross-section
        self.assertLess(volume["rim-0.4mm"], 0.99 * volume["rim-0mm"])
        self.assertAlmostEqual(volume["size-large"] / volume["size-middle"], (1 + 0.03 * 3**0.5) ** 3, delta=1e-5)
        self.assertAlmostEqual(sum(float(members[name][3]) for name in members if name.startswith("size")), 1.0, delta=1e-5)
        self.assertTrue(all(os.path.exists(self.path("f", name + end)) for name in members for end in (".clump.toml", ".stl")))
        self.fails(USAGE, "shape", "family", "--body", "cylinder", "-o", "g", says="varies")
        self.fails(USAGE, "shape", "family", "--body", "ring", "--rim-radius", "0.1mm", "-o", "g", says="cylinder")

    def test_compare_tells_and_draws(self):
        self.succeeds("shape", "--body", "cylinder:facets=24", "-n", "4", "--no-picture", "-o", "a.clump.toml")
        self.succeeds("shape", "--body", "cylinder:facets=24", "--method", "shape1", "--no-picture", "-o", "b.clump.toml")
        told = self.succeeds("shape", "compare", "a.clump.toml", "b.clump.toml")
        for text in ("sum of the spheres", "<- the clump's", "DEM cost", "a.compare.png", "b.compare.png"):
            self.assertIn(text, told.out)
        self.assertTrue(os.path.getsize(self.path("a.compare.png")) > 10000)
        os.remove(self.path("a.stl"))
        self.fails(BAD_INPUT, "shape", "compare", "a.clump.toml", "--no-picture", says="a.stl")
