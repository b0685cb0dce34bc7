#!/usr/bin/env python3
"""scripts/count-tests on every outcome that ctest writes (the cases below are ctest 3.25's own words)."""

import os
import subprocess
import sys
import tempfile

CASES = {
    "passed": '<testcase name="p" status="run"><system-out></system-out></testcase>',
    "failed": '<testcase name="f" status="fail"><failure message=""/></testcase>',
    "not started": '<testcase name="n" status="notrun"><skipped message="Unable to find executable"/></testcase>',
    "no fixture": '<testcase name="n" status="notrun"><skipped message="Fixture dependency failed"/></testcase>',
    "no file": '<testcase name="n" status="notrun"><skipped message="Required Files Missing"/></testcase>',
    "skipped by code": '<testcase name="s" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/></testcase>',
    "skipped by GoogleTest": '<testcase name="s" status="notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/></testcase>',
    "disabled": '<testcase name="d" status="disabled"></testcase>',
}
# outcomes, ctest's status → last line, exit code
EXPECTED = [
    (["passed", "passed"], 0, "2 passed, 0 failed, 0 skipped", 0),
    (["passed", "failed"], 8, "1 passed, 1 failed, 0 skipped", 1),
    (["passed", "not started"], 8, "1 passed, 1 failed, 0 skipped", 1),
    (["passed", "no fixture"], 8, "1 passed, 1 failed, 0 skipped", 1),
    (["passed", "no file"], 8, "1 passed, 1 failed, 0 skipped", 1),
    (["passed", "skipped by code", "skipped by GoogleTest", "disabled"], 0, "1 passed, 0 failed, 3 skipped", 0),
    (["skipped by code"], 0, "0 passed, 0 failed, 1 skipped", 1),
    ([], 0, "0 passed, 0 failed, 0 skipped", 1),
    (["passed"], 8, "1 passed, 0 failed, 0 skipped", 1),
    (None, 0, "0 passed, 1 failed, 0 skipped", 1),
]


def main():
    program = os.path.join(sys.argv[1], "scripts", "count-tests")
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for number, (outcomes, status, line, code) in enumerate(EXPECTED):
            file = os.path.join(folder, f"{number}.xml")
            if outcomes is not None:
                with open(file, "w", encoding="utf-8") as stream:
                    stream.write("<testsuite>" + "".join(CASES[name] for name in outcomes) + "</testsuite>")
            answer = subprocess.run([sys.executable, program, file, str(status)], capture_output=True, text=True, check=False)
            if answer.stdout != line + "\n" or answer.returncode != code:
                wrong += 1
                print(f"{outcomes} with ctest status {status}: expected «{line}» and {code}, got «{answer.stdout}» and {answer.returncode}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
