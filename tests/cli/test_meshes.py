"""Meshes that cannot be used, and those that can be repaired: `shape` and `mesh check`."""

import os

import bodies
from harness import BAD_INPUT, SOURCE, PelletlabTest


class Meshes(PelletlabTest):
    def reject(self, name, says, unit="mm"):
        """Both verbs refuse the file with the same exit code and words."""
        units = ["--unit", unit] if unit else []
        self.fails(BAD_INPUT, "mesh", "check", name, *units, says=says)
        self.fails(BAD_INPUT, "shape", name, *units, "-n", "2", "-o", "out/pellet.clump.toml", says=says)

    def test_missing_file(self):
        self.reject("nowhere.stl", "nowhere.stl")

    def test_folder_instead_of_a_file(self):
        os.mkdir(self.path("folder.stl"))
        self.reject("folder.stl", "folder.stl")

    def test_empty_file(self):
        self.write("empty.stl", "")
        self.reject("empty.stl", "empty.stl")

    def test_file_that_is_no_mesh(self):
        self.write("letter.stl", "Dear Ann,\nplease find enclosed …\n")
        self.reject("letter.stl", "letter.stl")

    def test_unknown_ending(self):
        self.write("pellet.xyzzy", "solid\n")
        self.reject("pellet.xyzzy", "pellet.xyzzy")

    def test_truncated_file(self):
        bodies.write_binary_stl(self.path("cut.stl"), bodies.cylinder())
        with open(self.path("cut.stl"), "rb+") as stream:
            stream.truncate(84 + 50 * 40 + 17)
        self.reject("cut.stl", "cut.stl")

    def test_mesh_without_triangles(self):
        bodies.write_text_stl(self.path("none.stl"), [])
        self.reject("none.stl", "none.stl")

    def test_open_mesh(self):
        bodies.write_binary_stl(self.path("open.stl"), bodies.without_a_triangle(bodies.cylinder()))
        self.reject("open.stl", ["open"])

    def test_self_intersecting_mesh(self):
        bodies.write_binary_stl(self.path("crossing.stl"), bodies.crossing())
        self.reject("crossing.stl", ["intersect"])

    def test_mesh_without_volume(self):
        bodies.write_binary_stl(self.path("flat.stl"), bodies.flat())
        self.reject("flat.stl", ["volume"])

    def test_nan_in_a_binary_file(self):
        bodies.write_binary_stl(self.path("nan.stl"), bodies.with_a_nan(bodies.cylinder()))
        self.reject("nan.stl", ["nan.stl", "finite"])

    def test_nan_in_a_text_file(self):
        bodies.write_text_stl(self.path("nan.stl"), bodies.with_a_nan(bodies.cylinder()))
        self.reject("nan.stl", ["nan.stl"])

    def test_unit_forgotten(self):
        bodies.write_binary_stl(self.path("pellet.stl"), bodies.cylinder())
        self.reject("pellet.stl", ["unit", "--unit mm"], unit=None)

    def test_unknown_unit(self):
        bodies.write_binary_stl(self.path("pellet.stl"), bodies.cylinder())
        self.reject("pellet.stl", ["furlong"], unit="furlong")

    def test_unit_of_another_dimension(self):
        bodies.write_binary_stl(self.path("pellet.stl"), bodies.cylinder())
        self.reject("pellet.stl", ["kg"], unit="kg")

    def test_body_of_three_metres_must_be_a_wrong_unit(self):
        bodies.write_binary_stl(self.path("pellet.stl"), bodies.cylinder())
        self.reject("pellet.stl", ["unit"], unit="m")

    def test_body_of_three_nanometres_must_be_a_wrong_unit(self):
        bodies.write_binary_stl(self.path("pellet.stl"), bodies.cylinder(3.12e-3, 2.96e-3))
        self.reject("pellet.stl", ["unit"], unit="um")

    def test_inside_out_mesh_is_repaired_and_said_so(self):
        bodies.write_binary_stl(self.path("right.stl"), bodies.cylinder())
        bodies.write_binary_stl(self.path("wrong.stl"), bodies.inside_out(bodies.cylinder()))
        self.assertNotIn("repaired", self.succeeds("mesh", "check", "right.stl", "--unit", "mm").text)
        self.assertRegex(self.succeeds("mesh", "check", "wrong.stl", "--unit", "mm").text, r"repaired: .*(inside|orient|revers|turn|flip)")
        shaped = self.succeeds("shape", "wrong.stl", "--unit", "mm", "-n", "2", "--no-picture", "-o", "wrong.clump.toml")
        self.assertRegex(shaped.text, r"repaired: .*(inside|orient|revers|turn|flip)")
        self.assertTrue(os.path.getsize(self.path("wrong.clump.toml")) > 0)

    def test_mixed_orientation_is_repaired_and_said_so(self):
        faces = bodies.cylinder()
        bodies.write_binary_stl(self.path("mixed.stl"), bodies.inside_out(faces[:5]) + faces[5:])
        self.assertIn("repaired:", self.succeeds("mesh", "check", "mixed.stl", "--unit", "mm").text)

    def test_text_and_binary_stl_are_the_same_body(self):
        bodies.write_binary_stl(self.path("binary.stl"), bodies.box())
        bodies.write_text_stl(self.path("text.stl"), bodies.box())
        self.assertEqual(self.succeeds("mesh", "check", "binary.stl", "--unit", "mm").out, self.succeeds("mesh", "check", "text.stl", "--unit", "mm").out)

    def test_reference_meshes_are_what_the_maker_makes(self):
        self.succeeds("mesh", "assets", "-o", "assets")
        kept = os.path.join(SOURCE, "meshes", "assets")
        made = sorted(name for name in os.listdir(self.path("assets")))
        self.assertTrue(any(name.endswith(".stl") for name in made))
        for name in made:
            with open(self.path("assets", name), "rb") as new, open(os.path.join(kept, name), "rb") as old:
                self.assertEqual(new.read() == old.read(), True, f"meshes/assets/{name} is not what `pelletlab mesh assets` writes")


class Shape(PelletlabTest):
    def setUp(self):
        super().setUp()
        bodies.write_binary_stl(self.path("pellet.stl"), bodies.cylinder())

    def test_quantities_need_their_unit(self):
        self.fails(BAD_INPUT, "shape", "pellet.stl", "--unit", "mm", "--density", "1800", says="unit")
        self.fails(BAD_INPUT, "shape", "pellet.stl", "--unit", "mm", "--density", "3 mm", says="density")

    def test_output_that_cannot_be_written(self):
        self.write("file", "x")
        self.fails(BAD_INPUT, "shape", "pellet.stl", "--unit", "mm", "-n", "2", "-o", "file/pellet.clump.toml", says="file")
        self.fails(BAD_INPUT, "shape", "pellet.stl", "--unit", "mm", "-n", "2", "-o", "/proc/pelletlab/pellet.clump.toml", says="/proc/pelletlab")

    def test_same_result_for_any_number_of_threads_and_nothing_to_do_again(self):
        for threads in ("1", "2"):
            self.succeeds("--threads", threads, "shape", "pellet.stl", "--unit", "mm", "-n", "3", "--no-picture", "-o", f"{threads}.clump.toml")
        self.assertEqual(self.read("1.clump.toml"), self.read("2.clump.toml"))
        again = self.succeeds("shape", "pellet.stl", "--unit", "mm", "-n", "3", "--no-picture", "-o", "1.clump.toml")
        self.assertIn("up to date", again.out)
        self.assertFalse([name for name in self.everything() if name.endswith(".part")])
