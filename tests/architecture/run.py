#!/usr/bin/env python3
"""run.py --list | run.py NAME… [--root FOLDER]: the architecture checks; all of them when none is named. Exit 1 when a fault is found."""

import argparse
import os
import sys

sys.dont_write_bytecode = True
import checks
import self_test
from tree import Tree


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--root", default=os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
    options = parser.parse_args()
    everything = ["checks_can_fail", *checks.ALL]
    if options.list:
        print("\n".join(everything))
        return 0
    tree = Tree(options.root)
    faults = 0
    for name in options.names or everything:
        found = self_test.run() if name == "checks_can_fail" else checks.ALL[name](tree)
        for fault in found:
            print(f"{fault}  [{name}]")
        faults += len(found)
    print(f"{faults} fault(s)")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
