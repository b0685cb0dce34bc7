#!/usr/bin/env python3
"""run.py --list | run.py Class.test … : the command-line tests, one by one for ctest. PELLETLAB_PROGRAM names the program,
PELLETLAB_CLI_SHELF the folder where `run.py --make-shelf` puts the clump that the runs share."""

import inspect
import os
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bodies
import harness
import test_campaign
import test_cases
import test_compare
import test_diagnose
import test_meshes
import test_observe
import test_resume
import test_runs
import test_shapes
import test_usage

MODULES = (test_usage, test_meshes, test_observe, test_campaign, test_compare, test_cases, test_diagnose, test_runs, test_resume, test_shapes)
CLASSES = {name: one for module in MODULES for name, one in inspect.getmembers(module, inspect.isclass)
           if issubclass(one, harness.PelletlabTest) and one is not harness.PelletlabTest}


def make_shelf():
    """One small clump with its mesh, made by the program itself."""
    shelf = os.environ["PELLETLAB_CLI_SHELF"]
    os.makedirs(shelf, exist_ok=True)
    bodies.write_binary_stl(os.path.join(shelf, "pellet.stl"), bodies.cylinder())
    return subprocess.call([os.environ["PELLETLAB_PROGRAM"], "shape", "pellet.stl", "--unit", "mm", "-n", "4", "--no-picture", "--force",
                            "-o", "pellet.clump.toml"], cwd=shelf)


def main(arguments):
    if arguments == ["--list"]:
        for name, one in sorted(CLASSES.items()):
            for test in unittest.TestLoader().getTestCaseNames(one):
                print(f"{name}.{test[len('test_'):]}")
        return 0
    if arguments == ["--make-shelf"]:
        return make_shelf()
    suite = unittest.TestSuite()
    for argument in arguments:
        name, test = argument.split(".")
        suite.addTest(CLASSES[name]("test_" + test))
    return 0 if unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful() and suite.countTestCases() else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
