#!/usr/bin/python3
"""Grasps of grasps.py beside MuJoCo: held.py PINCER MODULE ROBOTS [--only NAME] [--seconds S]

MODULE: npm's @mujoco/mujoco, the file mujoco.js of it (tests/robots/run fetches it). Both run the same scene; MuJoCo with elliptic cones, implicitfast, 100 iterations
and a tolerance of 1e-12, at two settings: ticks of 1 ms with impratio 1000, and of 2 ms with 10. Printed for each grasp and setting: how fast the object goes from the
middle of the run to its end, how deep it overlaps the hand (MuJoCo's), and the processor's time that a simulated second takes: pincer's with its start, each tick
computed; MuJoCo's is WebAssembly, so that its time is an upper bound.
Fails where pincer's object goes faster than 1e-6 um/s.
"""
import argparse
import json
import math
import os
import resource
import subprocess
import sys
import tempfile

import grasps

SETTINGS = [(0.001, 1000), (0.002, 10)]  # tick [s], impratio


def creep(rows, seconds):
    """From the middle of the run to its end [m/s]; of what fell, nothing."""
    first, last = min(rows, key=lambda row: abs(row[0] - seconds / 2)), rows[-1]
    way = math.dist(first[1:], last[1:])
    return way / (last[0] - first[0]) if rows[0][3] - last[3] < 0.05 else None


def said(speed):
    return "lost" if speed is None else f"creep {speed * 1e6:.2g} um/s"


def pincers(pincer, scene, folder):
    began = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    rows, _ = grasps.run(pincer, scene, folder, True)
    return creep(rows, scene["duration"]), resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - began


def mujocos(module, scene_path, seconds, tick, impratio):
    script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "held.mjs")
    done = subprocess.run(["node", script, module, scene_path, str(tick), str(impratio), str(seconds)], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("pincer")
    parser.add_argument("module")
    parser.add_argument("robots")
    parser.add_argument("--only", default="")
    parser.add_argument("--seconds", type=float, default=10)
    arguments = parser.parse_args()
    good = True
    for hand_name, hand in grasps.HANDS.items():
        hand["path"] = os.path.abspath(os.path.join(arguments.robots, hand["file"]))
        for object_name in hand["objects"]:
            if arguments.only not in f"{hand_name}-{object_name}":
                continue
            with tempfile.TemporaryDirectory() as folder:
                scene = grasps.scene_of(folder, hand_name, object_name, arguments.seconds, 1)
                speed, taken = pincers(arguments.pincer, scene, folder)
                good = good and speed is not None and speed <= 1e-12
                print(f"{hand_name} {object_name}: pincer {said(speed)}, {1e3 * taken / arguments.seconds:.0f} ms a second", flush=True)
                for tick, impratio in SETTINGS:
                    theirs = mujocos(os.path.abspath(arguments.module), os.path.join(folder, "scene.json"), arguments.seconds, tick, impratio)
                    print(f"  MuJoCo, {tick * 1e3:g} ms, impratio {impratio}: {said(creep(theirs['rows'], arguments.seconds))}, {theirs['deepest'] * 1e6:.0f} um deep, "
                          f"{1e3 * theirs['seconds'] / arguments.seconds:.0f} ms a second", flush=True)
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
