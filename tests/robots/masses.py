#!/usr/bin/python3
"""Compares robots' masses, places and inertias with MuJoCo's: masses.py PINCER MODULE ROBOT.xml...

MODULE: npm's @mujoco/mujoco, the file mujoco.js of it. Bounds: 1e-9 of the mass, 1e-9 m, 1e-9 of the largest moment; of bodies whose inertia is summed
from meshes 2e-7, as MuJoCo finds principal axes to 1e-7 only.
"""
import json
import os
import subprocess
import sys


def largest(a, b):
    return max((abs(x - y) for x, y in zip(a, b)), default=0.0)


def turn(a, b):
    return min(largest(a, b), largest(a, [-x for x in b]))


def compare(ours, theirs):
    scale = max(theirs["moments"])
    return {
        "mass": abs(ours["mass"] - theirs["mass"]) / max(theirs["mass"], 1e-12),
        "center": largest(ours["center"], theirs["center"]),
        "inertia": largest(ours["moments"] + ours["products"], theirs["moments"] + theirs["products"]) / scale,
        "place": largest(ours["position"], theirs["position"]),
        "turn": turn(ours["quaternion"], theirs["quaternion"]),
    }


def check(pincer, module, robot):
    ours = json.loads(subprocess.run([pincer, "import", robot, "--report", "json"], check=True, capture_output=True).stdout)
    script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "masses.mjs")
    theirs = json.loads(subprocess.run(["node", script, module, robot], check=True, capture_output=True).stdout)
    worst = {}
    for a, b in zip(ours["bodies"], theirs["bodies"], strict=True):
        assert b["name"] in ("", a["name"]), (a["name"], b["name"])  # what has no name gets one here
        for what, error in compare(a, b).items():
            worst[what] = max(worst.get(what, 0.0), error)
    extra = theirs["keyframes"][len(ours["keyframes"]):]  # a <size nkey> makes some without a name
    assert not any(keyframe["name"] for keyframe in extra)
    for a, b in zip(ours["keyframes"], theirs["keyframes"]):
        for x, y in zip(a["bodies"], b["bodies"], strict=True):
            worst["keyframes"] = max(worst.get("keyframes", 0.0), largest(x["position"], y["position"]), turn(x["quaternion"], y["quaternion"]))
    print(robot, " ".join(f"{what} {error:.1e}" for what, error in worst.items()))
    return all(error <= (2e-7 if what == "inertia" else 1e-9) for what, error in worst.items())


if __name__ == "__main__":
    pincer, module, *robots = sys.argv[1:]
    sys.exit(0 if all([check(pincer, module, robot) for robot in robots]) else 1)
