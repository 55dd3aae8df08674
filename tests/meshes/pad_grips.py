#!/usr/bin/env python3
"""Public meshes held between flat pads, in many headings: does what is held creep, is a tick flagged?

    cmake --build build --target pincer
    tests/meshes/pad_grips.py build/pincer MESHES OUT [--headings N] [--only PART]

MESHES  a directory of fandisk, rocker-arm, spot, stanford-bunny, suzanne and teapot (.obj), which pickup_parts.py
brings to 50 mm. Each is gripped between square pads of 10, 20 and 40 mm in N headings (default 12), nudged as it is
gripped; then it is shaken by 5 mm, or turned by a quarter about x, y or z, or neither, and rests for three seconds.
Pads press with some 15 N each, friction .8. A grip that falls, or goes by more than a millimetre while it should
rest, is `lost`: two places hold it that face each other too little. `creeps`: by more than 1e-6 um in its last second.
"""
import argparse
import csv
import json
import math
import pathlib
import subprocess

import pickup_parts

HALF_THICK, ROUNDING = 0.002, 0.0005  # of pads [m]
STIFFNESS, PRESS, HEIGHT = 5000, 15, 0.2  # [N/m, N, m]
REST, STILL = 3, 1e-12  # [s, m]
DEEDS = ("nudged", "shaken", "turned x", "turned y", "turned z")


def rotate(v, p):
    """p turned by the rotation vector v."""
    angle = math.sqrt(sum(c * c for c in v))
    if angle == 0:
        return list(p)
    a = [c / angle for c in v]
    cross = [a[(i + 1) % 3] * p[(i + 2) % 3] - a[(i + 2) % 3] * p[(i + 1) % 3] for i in range(3)]
    along = sum(x * y for x, y in zip(a, p))
    c, s = math.cos(angle), math.sin(angle)
    return [c * p[i] + s * cross[i] + (1 - c) * along * a[i] for i in range(3)]


def heading(k, n):
    """The first three look along the axes, the others evenly over the sphere."""
    if k < 3:
        return [(0, 0, 0), (0, 0, math.pi / 2), (0, math.pi / 2, 0)][k]
    z, around = 1 - 2 * (k - 2.5) / (n - 3), (k - 3) * math.pi * (3 - math.sqrt(5))
    return [math.acos(z) * c for c in (math.cos(around), math.sin(around), 0)]


def vertices_of(path):
    rows = [[float(x) for x in line.split()[1:4]] for line in open(path) if line.startswith("v ")]
    low, high = ([pick(r[i] for r in rows) for i in range(3)] for pick in (min, max))
    middle = [(a + b) / 2 for a, b in zip(low, high)]
    return rows, middle


def keyframes(deed, place):
    """Of the pad that is pressed at `place`, from the middle of what is held; where it ends and when."""
    at = lambda t, p, v=(0, 0, 0): {"time": round(t, 3), "position": [p[0], p[1], p[2] + HEIGHT], "rotation": list(v)}
    side = math.copysign(PRESS / STIFFNESS, place[0])
    frames = [at(0, [place[0] + side, 0, 0]), at(0.02, place), at(0.5, place)]
    if deed == "shaken":
        for k in range(10):
            way = 0.005 * (-1) ** k * (k < 9)
            frames.append(at(0.6 + 0.1 * k, [place[0] + 0.3 * way, 0.8 * way, -0.52 * way]))
    for k in range(1, 10) if deed.startswith("turned") else ():
        v = [math.radians(10 * k) * (axis == deed[-1]) for axis in "xyz"]
        frames.append(at(0.5 + 0.1 * k, rotate(v, place), v))
    return frames


def finger(name, deed, place, half, soft):
    x, y = HALF_THICK - ROUNDING, half - ROUNDING
    corners = [[i * x, j * y, k * y] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
    return {"name": name, "stiffness": STIFFNESS, "damping": 5, **({"patch_radius": 0.004} if soft else {}),
            "shape": {"type": "pad", "rounding": ROUNDING, "points": corners},
            "trajectory": {"keyframes": keyframes(deed, place)}}


def scene(part, units, rows, middle, turn, half, deed, soft):
    seen = [rotate(turn, [x - m for x, m in zip(row, middle)]) for row in rows]
    under = [p[0] for p in seen if abs(p[1]) < half and abs(p[2]) < half]
    if not under:
        return None
    fingers = [finger("left", deed, [min(under) - HALF_THICK + PRESS / STIFFNESS, 0, 0], half, soft),
               finger("right", deed, [max(under) + HALF_THICK - PRESS / STIFFNESS, 0, 0], half, soft)]
    start = rotate(turn, [-m for m in middle])
    body = {"name": "part", "shape": {"type": "mesh", "file": part.name, "units": units}, "mass": 0.1,
            "rotation": list(turn), "position": [start[0], start[1], start[2] + HEIGHT],
            "angular_velocity": [0.2, -0.1, 0.2], "material": {"mu_s": 0.8}}
    end = fingers[0]["trajectory"]["keyframes"][-1]["time"]
    return {"version": 1, "duration": end + REST, "bodies": [body], "fingers": fingers,
            "record": {"interval": 0.1, "quantities": ["part.p_x", "part.p_y", "part.p_z"]}}


def grip(pincer, out, content):
    """How far it goes in the last second [m], ticks flagged, and whether it is lost."""
    path, table = out / "grip.json", out / "grip.csv"
    path.write_text(json.dumps(content))
    words = [str(pincer), "sim", str(path), "--json", "--out", str(table)]
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(done.stdout + done.stderr)
    flagged = sum(json.loads(done.stdout)["status"].values())
    rows = [[float(x) for x in row[1:4]] for row in list(csv.reader(open(table)))[1:]]
    way = lambda since: max(math.dist(rows[since], row) for row in rows[since:])
    return way(-11), flagged, way(-10 * REST + 9) > 1e-3


def measure(pincer, out, part, units, headings):
    """One row, and whether all that holds rests unflagged."""
    rows, middle = vertices_of(part)
    count = {"grips": 0, "lost": 0, "creeps": 0, "flagged": 0}
    worst = 0
    for k in range(headings):
        for half in (0.005, 0.01, 0.02):
            deed = DEEDS[(k + round(half * 200)) % len(DEEDS)]
            content = scene(part, units, rows, middle, heading(k, headings), half, deed, soft=k % 2)
            if not content:
                continue
            way, flagged, lost = grip(pincer, out, content)
            count["grips"] += 1
            count["lost"] += lost
            count["flagged"] += flagged * (not lost)
            count["creeps"] += way > STILL and not lost
            worst = max(worst, 0 if lost else way)
    return "%5d %5d %6d %8d %10.2e" % (*count.values(), 1e6 * worst), count["creeps"] == count["flagged"] == 0


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("pincer", "meshes", "out"):
        words.add_argument(name, type=lambda word: pathlib.Path(word).resolve())
    words.add_argument("--headings", type=int, default=12)
    words.add_argument("--only", choices=pickup_parts.FILES)
    given = words.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    pickup_parts.FEWEST, pickup_parts.MOST = 1000, 4000
    print("%-15s %5s %5s %6s %8s %10s" % ("part", "grips", "lost", "creeps", "flagged", "worst, um"))
    all_rest = True
    for name in [given.only] if given.only else pickup_parts.FILES:
        part, units, _ = pickup_parts.prepared(given.pincer, given.meshes, given.out, name)
        row, rests = measure(given.pincer, given.out, part, units, given.headings)
        all_rest = all_rest and rests
        print("%-15s %s" % (name, row), flush=True)
    raise SystemExit(0 if all_rest else 1)


if __name__ == "__main__":
    main()
