#!/usr/bin/env python3
"""Writes runs.csv and measured_*.csv of this example: a made-up drum whose true cause is known (rolling = 0.24). No simulation is behind it."""

import math
import os
import random

HERE = os.path.dirname(os.path.abspath(__file__))
XS = [-0.6, -0.45, -0.3, -0.15, 0.0, 0.15, 0.3, 0.45, 0.6]


def drum(rpm, sliding, restitution, rolling=0.0, fill=0.0, wall=0.0):
    """Surface height in mm at XS, and torque in mN m; every effect has its own pattern over position and speed."""
    v = rpm / 50.0
    slope = -18 - 14 * math.log(sliding / 0.2) / math.log(5) - 10 * v + 1.5 * restitution
    z = []
    for x in XS:
        height = slope * x - 3 * restitution * v * x * x
        height += rolling / 0.4 * (-7 * x * (1 - 0.4 * v) + 14.0 * (x * x - 0.15) * (1.2 - v))
        height += fill * (2.2 - 0.5 * x * x)
        height += wall * (4.0 * math.exp(-((x - 0.35) / 0.18) ** 2) * (0.4 + v))
        z.append(height)
    return z, 6 + 5 * sliding ** 0.5 + 2 * v + 1.4 * fill + 1.2 * rolling


def main():
    random.seed(20)
    header = ["rpm", "sliding", "restitution", "rolling", "fill_error", "wall", "status"] + [f"z({x:.2f})" for x in XS] + ["torque"]
    rows = []

    def run(sliding, restitution, rolling=0.0, fill=0.0, wall=0.0):
        for rpm in (20, 50):
            z, torque = drum(rpm, sliding, restitution, rolling, fill, wall)
            offset = random.gauss(0, 0.08)
            values = [f"{h + offset + random.gauss(0, 0.12):.3f}" for h in z] + [f"{torque + random.gauss(0, 0.08):.3f}"]
            rows.append([f"{rpm}", f"{sliding:.4g}", f"{restitution:.4g}", f"{rolling:.4g}", f"{fill:.4g}", f"{wall:.4g}", "complete"] + values)

    for i in range(24):
        run(0.2 * 5 ** ((i * 0.618 + 0.1) % 1), 0.2 + 0.6 * ((i * 0.7549 + 0.2) % 1))
    for block in ("rolling", "fill", "wall"):
        for i in range(14):
            t = 0.1 + 0.9 * (i + 0.5) / 14
            amplitude = {"rolling": 0.4 * t * t, "fill": (t if i % 2 else -t), "wall": t}[block]
            run(0.2 * 5 ** ((i * 0.5698 + 0.3) % 1), 0.2 + 0.6 * ((i * 0.618 + 0.5) % 1), **{block: amplitude})
    with open(os.path.join(HERE, "runs.csv"), "w", encoding="utf-8") as out:
        out.write("# A made-up campaign: see make_example.py\n" + ",".join(header) + "\n" + "\n".join(",".join(r) for r in rows) + "\n")
    for rpm in (20, 35, 50):
        z, torque = drum(rpm, 0.45, 0.5, rolling=0.24)
        with open(os.path.join(HERE, f"measured_{rpm}rpm.csv"), "w", encoding="utf-8") as out:
            out.write("x_over_R,z_mm\n" + "".join(f"{x:.2f},{h + random.gauss(0, 0.15):.3f}\n" for x, h in zip(XS, z)))
        print(rpm, "rpm: torque", round(torque + random.gauss(0, 0.1), 3), "mN m")


if __name__ == "__main__":
    main()
