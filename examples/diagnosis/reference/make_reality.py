#!/usr/bin/env python3
"""A reality made by the solver: the rigs of a plan with parameters and effects that the diagnosis is not told, as an experiment.toml.

    make_reality.py PLAN --campaign CAMPAIGN.toml --effect name=amplitude [--set key=value] [--seeds 3] -o FOLDER

Every rig runs with `--seeds` seeds that no campaign uses. A measured value is the mean over them; its uncertainty is the standard error of that mean from the scatter of the seeds, pooled over the points of a
profile, and not less than a fifth of the tolerance. Observables, ranges and tolerances are those of the plan. To be no twin of the model, a reality should differ from it in more than the effect:
--set time.step=1e-5 s, another clump, facets instead of exact walls.
"""
import argparse
import csv
import json
import math
import os
import subprocess
import sys
import tomllib

VERBS = {"drum": "drum", "tube": "fill", "pile": "pile", "tester": "tester"}


def read_toml(path):
    with open(path, "rb") as file:
        return tomllib.load(file)


def mean_and_error(rows, floor):
    """Means over seeds of a list of values, and one pooled standard error of the mean."""
    count, length = len(rows), len(rows[0])
    means = [sum(row[i] for row in rows) / count for i in range(length)]
    if count < 2:
        return means, floor
    variance = sum((row[i] - means[i]) ** 2 for row in rows for i in range(length)) / ((count - 1) * length)
    return means, max(floor, math.sqrt(variance / count))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("plan")
    parser.add_argument("--campaign", required=True)
    parser.add_argument("--effect", action="append", default=[])
    parser.add_argument("--set", action="append", default=[], dest="overrides")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("-o", "--output", required=True)
    options = parser.parse_args()
    root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
    program = os.environ.get("PELLETLAB_PROGRAM", os.path.join(root, "build", "release", "apps", "pelletlab"))
    plan = read_toml(options.plan)
    os.makedirs(options.output, exist_ok=True)
    text = [f'name = "{os.path.basename(os.path.normpath(options.output))}"',
            f'campaign = {json.dumps(os.path.relpath(options.campaign, options.output))}']
    for rig in plan["rig"]:
        case = os.path.join(os.path.dirname(options.plan), rig["case"])
        verb = VERBS[read_toml(case)["rig"]]
        runs = []
        for seed in range(options.seeds):
            folder = os.path.join(options.output, "runs", f"{rig['name'].replace(' ', '_')}-{seed}")
            command = [program, "--threads", "1", verb, case, "-o", folder, "--resume"]
            for one in [*rig.get("set", []), *options.overrides, f"seed={900000001 + seed}", "output.pictures=false", "output.paraview=false"]:
                command += ["--set", one]
            for one in options.effect:
                command += ["--effect", one]
            done = subprocess.run(command, stdout=subprocess.DEVNULL, check=False)
            if done.returncode != 0:
                sys.exit(done.returncode)
            with open(os.path.join(folder, "observables.json"), encoding="utf-8") as file:
                runs.append(json.load(file))
        for wanted in plan["observable"]:
            name, floor = wanted["name"], 0.2 * wanted["tolerance"]
            values = [[v for v in run["values"] if v["name"] == name] for run in runs]
            profiles = [[p for p in run["profiles"] if p["name"] == name] for run in runs]
            if all(values):
                means, error = mean_and_error([[v[0]["value"]] for v in values], floor)
                text += ["", "[[measurement]]", f'observable = "{name}"', f'regime = "{rig["name"]}"', f"value = {means[0]:.9g}",
                         f'unit = "{values[0][0]["unit"]}"', f"uncertainty = {error:.4g}", f"repeats = {options.seeds}", 'instrument = "solver"']
            elif all(profiles):
                low, high = wanted.get("axis_range", [-math.inf, math.inf])
                first = profiles[0][0]
                keep = [i for i, x in enumerate(first["axis"]) if low <= x <= high and all(p[0]["value"][i] is not None for p in profiles)]
                means, error = mean_and_error([[p[0]["value"][i] for i in keep] for p in profiles], floor)
                file_name = f"{name}-{rig['name'].replace(' ', '_')}.csv"
                with open(os.path.join(options.output, file_name), "w", newline="", encoding="utf-8") as file:
                    writer = csv.writer(file)
                    writer.writerow([first["axis_name"], name])
                    writer.writerows([f"{first['axis'][i]:.9g}", f"{means[k]:.9g}"] for k, i in enumerate(keep))
                text += ["", "[[measurement]]", f'observable = "{name}"', f'regime = "{rig["name"]}"', f'data = "{file_name}"', f'axis_column = "{first["axis_name"]}"',
                         f'value_column = "{name}"', f'axis_unit = "{first["axis_unit"]}"', f'unit = "{first["unit"]}"', f"uncertainty = {error:.4g}",
                         f"repeats = {options.seeds}", 'instrument = "solver"']
    with open(os.path.join(options.output, "experiment.toml"), "w", encoding="utf-8") as file:
        file.write("\n".join(text) + "\n")
    print("wrote", os.path.join(options.output, "experiment.toml"))


if __name__ == "__main__":
    main()
