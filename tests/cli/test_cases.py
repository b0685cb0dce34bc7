"""Case files: what `case new` writes can be read; what is wrong in a file is named with its place."""

import json
import os
import re

from harness import BAD_INPUT, SOURCE, USAGE, PelletlabTest


class Cases(PelletlabTest):
    def edited_case(self, old, new, rig="tube"):
        """A new case in which the first line that matches `old` is replaced; returns file name and line number."""
        file = self.new_case(rig)
        lines = self.read(file).split("\n")
        number = next(i for i, line in enumerate(lines) if re.match(old, line))
        lines[number] = new
        self.write(file, "\n".join(lines))
        return file, number + 1

    def reject(self, old, new, says, rig="tube"):
        file, line = self.edited_case(old, new, rig)
        texts = [f"{file}:{line}", *([says] if isinstance(says, str) else says)]
        self.fails(BAD_INPUT, "case", "check", file, says=texts)
        self.fails(BAD_INPUT, {"tube": "fill"}.get(rig, rig), file, "-o", "out", says=texts)

    def test_new_cases_can_be_read_and_their_resolved_text_again(self):
        for rig in ("tube", "drum", "pile", "tester"):
            resolved = self.succeeds("case", "check", self.new_case(rig)).out
            self.write("resolved.toml", resolved)
            self.assertEqual(self.succeeds("case", "check", "resolved.toml").out, resolved)

    def test_unknown_key_with_a_suggestion(self):
        self.reject(r"count\s*=", "cuont = 5", ["cuont", "count"])

    def test_unknown_table_with_a_suggestion(self):
        self.reject(r"\[insertion\]", "[insertoin]", ["insertoin", "insertion"])

    def test_unit_forgotten(self):
        self.reject(r"diameter\s*=", "diameter = 52", ["unit", "mm"])

    def test_unit_of_another_dimension(self):
        self.reject(r"diameter\s*=", 'diameter = "52 kg"', ["kg", "length"])

    def test_unknown_unit(self):
        self.reject(r"speed\s*=", 'speed = "20 rmp"', ["rmp", "rpm"], rig="drum")

    def test_value_out_of_range(self):
        self.reject(r"restitution\s*=", "restitution = 1.5", ["restitution", "1.5"])
        self.reject(r"diameter\s*=", 'diameter = "-52 mm"', ["diameter"])
        self.reject(r"count\s*=", "count = -5", ["count"])
        self.reject(r"fill_fraction\s*=", "fill_fraction = 1.2", ["fill_fraction"], rig="drum")

    def test_picture_that_the_renderer_would_refuse_is_refused_before_the_run(self):
        file = self.new_case()
        for width in (199, 16385):
            self.fails(BAD_INPUT, "case", "check", file, "--set", f"output.picture_width={width}", says="picture_width")

    def test_value_of_another_type(self):
        self.reject(r"count\s*=", 'count = "many"', ["count"])
        self.reject(r"seed\s*=", "seed = 1.5", ["seed"])
        self.reject(r"paraview\s*=", 'paraview = "yes"', ["paraview"])

    def test_nan_and_infinity(self):
        self.reject(r"restitution\s*=", "restitution = nan", ["restitution"])
        self.reject(r"sliding_friction\s*=", "sliding_friction = inf", ["sliding_friction"])
        self.reject(r"diameter\s*=", 'diameter = "nan mm"', ["diameter"])

    def test_syntax_error_names_its_line(self):
        self.reject(r"count\s*=", "count = = 5", [])

    def test_material_that_is_not_defined(self):
        self.reject(r"material\s*=", 'material = "marble"', ["marble"])

    def test_key_given_twice(self):
        file, line = self.edited_case(r"count\s*=", "count = 5\ncount = 6")
        self.fails(BAD_INPUT, "case", "check", file, says=[f"{file}:{line + 1}", "count"])

    def test_missing_case_file(self):
        for verb in (["fill"], ["drum"], ["case", "check"]):
            self.fails(BAD_INPUT, *verb, "nowhere.toml", says="nowhere.toml")

    def test_case_that_is_a_folder_or_binary(self):
        os.mkdir(self.path("folder.toml"))
        self.fails(BAD_INPUT, "case", "check", "folder.toml", says="folder.toml")
        with open(self.path("binary.toml"), "wb") as stream:
            stream.write(bytes(range(256)))
        self.fails(BAD_INPUT, "case", "check", "binary.toml", says="binary.toml")

    def test_settings_on_the_command_line(self):
        file = self.new_case()
        resolved = self.succeeds("case", "check", file, "--set", "tube.diameter=41 mm", "--set", "pellet.count=7").out
        self.assertRegex(resolved, r'(?m)^diameter\s*=\s*"41 mm"')
        self.assertRegex(resolved, r"(?m)^count\s*=\s*7\b")
        for setting, says in [("tube.diametre=41 mm", "diameter"), ("tube.diameter=41", "unit"), ("tube.diameter", "="), ("pellet.count=-1", "count"),
                              ("=3", "=3"), ("tube=3", "tube")]:
            self.fails(BAD_INPUT, "case", "check", file, "--set", setting, says=says)

    def test_wrong_verb_for_the_rig(self):
        self.fails(USAGE, "drum", self.new_case("tube"), says="pelletlab fill")
        self.fails(USAGE, "fill", self.new_case("drum"), says="pelletlab drum")


class CaseDocuments(PelletlabTest):
    def test_schema_is_json_and_knows_every_key_of_a_new_case(self):
        schema = json.loads(self.succeeds("case", "schema").out)
        self.assertIn("$schema", schema)
        for rig in ("tube", "drum", "pile", "tester"):
            text = self.read(self.new_case(rig))
            for key in re.findall(r"(?m)^#?\s?(\w+) = ", text):
                self.assertIn(f'"{key}"', json.dumps(schema), key)

    def test_reference_knows_every_key_of_a_new_case(self):
        page = self.succeeds("case", "reference").out
        for rig in ("tube", "drum", "pile", "tester"):
            for key in re.findall(r"(?m)^#?\s?(\w+) = ", self.read(self.new_case(rig))):
                self.assertIn(key, page)

    def test_page_in_docs_is_the_generated_one(self):
        with open(os.path.join(SOURCE, "docs", "case-reference.md"), encoding="utf-8") as stream:
            kept = stream.read()
        self.assertEqual(self.succeeds("case", "reference").out.rstrip("\n"), kept.rstrip("\n"),
                         "run: pelletlab case reference -o docs/case-reference.md --overwrite")

    def test_examples_can_be_read(self):
        examples = os.path.join(SOURCE, "examples")
        names = sorted(name for name in os.listdir(examples) if name.endswith(".toml"))
        self.assertTrue(names)
        for name in names:
            self.succeeds("case", "check", os.path.join(examples, name))
