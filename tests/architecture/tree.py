"""A source tree to check: the repository's tracked files, or a folder of fixtures."""

import os
import re
import subprocess

import rules

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
# Raw strings, strings, characters, comments: whatever comes first wins. A digit separator (1'000) opens no character.
NOT_CODE = re.compile(r'R"(?P<d>[^(\s]*)\(.*?\)(?P=d)"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\'|//[^\n]*|/\*.*?\*/', re.DOTALL)


class Tree:
    def __init__(self, root):
        self.root = os.path.abspath(root)
        self._files = None

    def files(self):
        """Tracked and new, not ignored files, relative to the root; every file when the root is no git repository (a fixture, an unpacked archive)."""
        if self._files is None:
            names = None
            if os.path.exists(os.path.join(self.root, ".git")):
                git = ["git", "-c", "safe.directory=*", "-C", self.root, "ls-files", "--cached", "--others", "--exclude-standard"]
                answer = subprocess.run(git, capture_output=True, text=True, check=False)
                if answer.returncode == 0:
                    names = answer.stdout.split("\n")
            if names is None:
                names = [os.path.relpath(os.path.join(folder, name), self.root) for folder, _, found in os.walk(self.root) for name in found]
                names = [name for name in names if not name.startswith((".git/", "build/", "out/", "demo-out/")) and "__pycache__" not in name]
            self._files = sorted({name for name in names if name and os.path.isfile(os.path.join(self.root, name))})
        return self._files

    def sources(self):
        return [name for name in self.files() if name.endswith((".hpp", ".cpp", ".hpp.in", ".cpp.in"))]

    def rooms(self):
        return [room for room in rules.ALLOWED if any(name.startswith(room + "/") for name in self.sources())]

    def text(self, file):
        with open(os.path.join(self.root, file), encoding="utf-8", errors="replace") as stream:
            return stream.read()

    def includes(self, file):
        text = self.text(file)
        return [(text.count("\n", 0, found.start(1)) + 1, found.group(1)) for found in INCLUDE.finditer(text)]

    def code(self, file):
        """The text with comments blanked and the inside of strings emptied, line for line."""

        def blank(found):
            lines = "\n" * found.group(0).count("\n")
            return lines if found.group(0).startswith("/") else '""' + lines

        return NOT_CODE.sub(blank, self.text(file))
