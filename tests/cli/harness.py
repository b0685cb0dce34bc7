"""Runs the pelletlab program in an empty folder of its own and looks at exit code, messages and what it left behind."""

import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

USAGE, BAD_INPUT, NUMERICAL, INTERRUPTED = 2, 3, 4, 130
SOURCE = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))

# A run of the tube small enough for a test: few pellets, short, nothing to look at.
SMALL = ["--set", "pellet.count=6", "--set", "time.settle_limit=0.02 s", "--set", "output.frame_interval=0.005 s",
         "--set", "output.pictures=false", "--set", "output.paraview=false"]
SMALL_DRUM = ["--set", "pellet.count=6", "--set", "time.settle_limit=0.02 s", "--set", "time.spin_up=0.01 s", "--set", "time.measure=0.02 s",
              "--set", "output.frame_interval=0.005 s", "--set", "output.pictures=false", "--set", "output.paraview=false"]
TESTER = ["--set", "pellet.count=60", "--set", "time.step=2e-5 s", "--set", "tester.diameter=60 mm", "--set", "tester.length=20 mm",
          "--set", "tester.baffle_height=12 mm", "--set", "tester.speed=120 rpm", "--set", "time.settle_limit=0.1 s", "--set", "time.spin_up=0.1 s",
          "--set", "time.measure=1.05 s", "--set", "output.frame_interval=6.944 ms", "--set", "output.paraview=false"]  # two turns, a frame every 5 degrees
SMALL_TESTER = [*TESTER, "--set", "output.pictures=false"]
SMALL_PILE = [*SMALL, "--set", "pile.discharge_limit=0.03 s"]
# … and one that goes on for minutes, to be interrupted.
LONG = ["--set", "pellet.count=400", "--set", "time.settle_limit=60 s", "--set", "time.rest_kinetic_energy=1e-300",
        "--set", "output.frame_interval=0.001 s"]


class Result:
    def __init__(self, arguments, code, out, err):
        self.arguments, self.code, self.out, self.err = arguments, code, out, err
        self.text = out + err

    def __str__(self):
        return f"\npelletlab {' '.join(self.arguments)}\nexit code {self.code}\n--- out\n{self.out}\n--- err\n{self.err}"


class PelletlabTest(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.program = os.environ["PELLETLAB_PROGRAM"]
        self.folder = tempfile.mkdtemp(prefix="pelletlab-cli-")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def path(self, *parts):
        return os.path.join(self.folder, *parts)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as stream:
            stream.write(text)
        return name

    def read(self, *parts):
        with open(self.path(*parts), encoding="utf-8") as stream:
            return stream.read()

    def start(self, *arguments, **options):
        return subprocess.Popen([self.program, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True, **options)

    def run_program(self, *arguments, timeout=240, **options):
        process = self.start(*arguments, **options)
        try:
            out, err = process.communicate(timeout=timeout)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            self.fail(f"pelletlab {' '.join(arguments)} was not done after {timeout} s")
        return Result(arguments, process.returncode, out, err)

    def everything(self):
        """Every file and folder below the test's folder, relative to it."""
        return sorted(os.path.relpath(os.path.join(top, name), self.folder) for top, folders, files in os.walk(self.folder) for name in folders + files)

    # --- expectations

    def succeeds(self, *arguments, **options):
        result = self.run_program(*arguments, **options)
        self.assertEqual(result.code, 0, result)
        return result

    def fails(self, code, *arguments, says=(), **options):
        """Ends with `code`, one clear error on standard error that holds every text of `says` (any case), and leaves the folder as it was."""
        before = self.everything()
        result = self.run_program(*arguments, **options)
        self.assertEqual(result.code, code, result)
        self.assertEqual(result.err.lower().count("error:"), 1 if code != USAGE else min(1, result.err.lower().count("error:")), result)
        self.assertTrue(result.err.strip(), f"no message {result}")
        self.assertNotIn("terminate called", result.err, result)
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text.lower(), result.err.lower(), result)
        if code == BAD_INPUT:
            self.assertIn("what to do:", result.err, f"no remedy {result}")
        self.assertEqual(self.everything(), before, f"something was left behind {result}")
        return result

    # --- things to work on

    def take_clump(self):
        """The clump that the fixture test made, with its mesh beside it."""
        shelf = os.environ["PELLETLAB_CLI_SHELF"]
        for name in ("pellet.clump.toml", "pellet.stl"):
            shutil.copy(os.path.join(shelf, name), self.path(name))

    def new_case(self, rig="tube"):
        """A case of the rig, as `case new` writes it, with its clump."""
        self.take_clump()
        self.succeeds("case", "new", rig, "-o", f"{rig}.toml", "--overwrite")
        return f"{rig}.toml"

    def interrupt(self, process, when, number=signal.SIGINT, patience=120.0):
        """Sends the signal as soon as when() holds; returns the Result."""
        begin = time.monotonic()
        while not when():
            if process.poll() is not None:
                out, err = process.communicate()
                self.fail(f"ended by itself before it could be interrupted {Result(process.args[1:], process.returncode, out, err)}")
            if time.monotonic() - begin > patience:
                process.kill()
                process.communicate()
                self.fail("waited in vain for the moment to interrupt")
            time.sleep(0.02)
        process.send_signal(number)
        try:
            out, err = process.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            self.fail("still running a minute after the signal")
        return Result(process.args[1:], process.returncode, out, err)
