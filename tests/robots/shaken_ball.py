#!/usr/bin/python3
"""Where a shaken hand lets go: shaken_ball.py build/pincer [--lean FACTOR] [--damping FACTOR] [--mass KG] [--tick S] [--ramps] [--seeds N]

The scene three_finger_hand, its drives' targets off by normal deviates of --shake [rad], drawn anew every 0.1 s once the ball is held: jumps within 1 ms, or with --ramps
straight lines. --lean scales how far the fingers lean outwards, so how hard they press: 0.8 to 1.1. Printed: what each tip presses with unshaken, and the runs in which the
ball goes below 100 mm.
"""
import argparse
import copy
import json
import os
import random
import subprocess
import tempfile

HELD, EVERY, JUMP, LEAN = 1.2, 0.1, 0.001, -0.17764  # [s], [s], [s], [rad]
SCENE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tasks/scenes/three_finger_hand.json")


def read_scene():
    with open(SCENE) as file:
        return json.loads("\n".join(line for line in file.read().split("\n") if not line.strip().startswith("//")))


def value_at(keyframes, time):
    before = [k for k in keyframes if k["time"] <= time] or keyframes[:1]
    after = [k for k in keyframes if k["time"] > time]
    if not after or before[-1]["time"] > time:
        return before[-1]["value"]
    a, b = before[-1], after[0]
    return a["value"] + (b["value"] - a["value"]) * (time - a["time"]) / (b["time"] - a["time"])


def shaken(arguments, seed, shake):
    scene, deviates = read_scene(), random.Random(seed)
    scene["expect"], scene["bodies"][1]["mass"] = [], arguments.mass
    scene["tick"] = arguments.tick
    scene["record"] = {"interval": 0.002, "quantities": ["ball.p_z", "ball|tip0.normal_force"]}
    for drive in scene["drives"]:
        drive["damping"] *= arguments.damping
        told = copy.deepcopy(drive["trajectory"]["keyframes"])
        keyframes = [k for k in told if k["time"] < HELD] + [{"time": HELD - JUMP, "value": value_at(told, HELD - JUMP)}]
        for n in range(round((scene["duration"] - HELD) / EVERY) + 1):
            time, off = HELD + n * EVERY, deviates.gauss(0, shake)
            keyframes.append({"time": round(time, 6), "value": value_at(told, time) + off})
            end = time + EVERY - JUMP
            if not arguments.ramps:
                keyframes.append({"time": round(end, 6), "value": value_at(told, end) + off})
        if "lean" in drive["name"]:
            for k in keyframes:
                k["value"] += (arguments.lean - 1) * LEAN * (k["time"] >= 0.5)
        drive["trajectory"]["keyframes"] = keyframes
    return scene


def rows_of(pincer, scene):
    with tempfile.TemporaryDirectory() as folder:
        path, table = os.path.join(folder, "scene.json"), os.path.join(folder, "rows.csv")
        with open(path, "w") as file:
            json.dump(scene, file)
        subprocess.run([pincer, "sim", path, "--out", table], check=True, stdout=subprocess.DEVNULL)
        with open(table) as file:
            return [[float(v) for v in line.split(",")] for line in file.read().split("\n")[1:] if line]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("pincer")
    parser.add_argument("--shake", type=float, default=0.01)
    parser.add_argument("--lean", type=float, default=1)
    parser.add_argument("--damping", type=float, default=1)
    parser.add_argument("--mass", type=float, default=0.08)
    parser.add_argument("--tick", type=float, default=0.001)
    parser.add_argument("--ramps", action="store_true")
    parser.add_argument("--seeds", type=int, default=20)
    arguments = parser.parse_args()
    force = rows_of(arguments.pincer, shaken(arguments, 1, 0))[-1][2]
    lost = [seed for seed in range(1, arguments.seeds + 1) if min(row[1] for row in rows_of(arguments.pincer, shaken(arguments, seed, arguments.shake))) < 0.1]
    print(f"each tip presses with {force:.2f} N; shaken by {arguments.shake} rad: lost {len(lost)} of {arguments.seeds}, seeds {lost}")


if __name__ == "__main__":
    main()
