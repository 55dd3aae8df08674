#!/usr/bin/python3
"""Hands that hold: grasps.py PINCER ROBOTS [--seconds S] [--only NAME]

A plate carries an object between the fingers of a hand from ROBOTS, the hand closes, and the plate goes away. Printed for each: how far the object has gone by the
end since it was at rest (5 s before the middle of the run), computed tick by tick and with ticks that repeat left out, and ticks that were flagged. Bound: 1e-6 um.
"""
import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile

GRAVITY = 9.81


def box(*size):
    return {"shape": {"type": "box", "size": list(size)}}


def can(diameter, height):
    return {"shape": {"type": "cylinder", "radius": diameter / 2, "length": height}}


def mug(radius, height, wall=0.004, staves=12):
    """A hollow mug of staves, with a bottom and a handle along +y."""
    import math

    shapes, across = [{"shape": {"type": "cylinder", "radius": radius - wall, "length": wall}, "position": [0, 0, -height / 2 + wall / 2]}], 2 * math.tan(math.pi / staves) * radius
    for k in range(staves):
        a = 2 * math.pi * k / staves
        shapes.append({"shape": {"type": "box", "size": [wall, across, height]}, "position": [(radius - wall / 2) * math.cos(a), (radius - wall / 2) * math.sin(a), 0], "rotation": [0, 0, a]})
    for x, z, size in [(radius + 0.010, 0.02, [0.02, 0.01, 0.006]), (radius + 0.010, -0.02, [0.02, 0.01, 0.006]), (radius + 0.018, 0, [0.006, 0.01, 0.046])]:
        shapes.append({"shape": {"type": "box", "size": size}, "position": [x, 0, z]})
    return {"shapes": shapes}


OBJECTS = {
    "cube": (box(0.04, 0.04, 0.04), 0.064, 0.02),
    "can": (can(0.066, 0.1), 0.35, 0.05),
    "mug": (mug(0.035, 0.08), 0.25, 0.04),
    "part": ({"shape": {"type": "mesh", "file": "part.obj", "units": "m"}}, 0.15, 0.02),
}

ALLEGRO_OPEN = {**{f"{f}j{k}": 0.7 for f in ("ff", "mf") for k in (1, 2, 3)}, "thj0": 1.2, "thj1": 0.6, "thj2": 0.4, "thj3": 0.4}
ALLEGRO_CLOSES = {**{f"{f}j{k}": 0.5 for f in ("ff", "mf") for k in (1, 2, 3)}, "thj0": 0.1, "thj1": 0.2, "thj2": 0.5, "thj3": 0.5}

# Hand: file, placement, keys of the start, drives, where the object's centre is, which objects.
HANDS = {
    "franka": {"file": "franka_emika_panda/hand.xml", "position": [0, 0, 0.4], "rotation": [3.141592653589793, 0, 0], "start": {"finger_joint1": 0.04, "finger_joint2": 0.04},
               "drives": {"actuator8": [255, 0]}, "center": [0, 0, 0.2966], "hangs": 1, "objects": ["cube", "can", "mug", "part"]},
    "2f85": {"file": "robotiq_2f85/2f85.xml", "position": [0, 0, 0.4], "rotation": [3.141592653589793, 0, 0], "start": {},
             "drives": {"fingers_actuator": [0, 255]}, "center": [0, 0, 0.25], "hangs": 1, "objects": ["cube", "can", "mug", "part"]},
    "allegro": {"file": "wonik_allegro/right_hand.xml", "position": [0, 0, 0.2], "rotation": [0, 0, 0], "start": ALLEGRO_OPEN,
                "drives": {joint[:2] + "a" + joint[3]: [ALLEGRO_OPEN[joint], ALLEGRO_OPEN[joint] + more] for joint, more in ALLEGRO_CLOSES.items()},
                "center": [0.0, -0.018, 0.275], "hangs": -1, "objects": ["cube", "can", "mug", "part"]},
}


def scene_of(folder, hand_name, object_name, seconds, friction):
    hand = HANDS[hand_name]
    shape, mass, below = OBJECTS[object_name]
    center = list(hand["center"])
    center[2] -= hand["hangs"] * max(0, below - 0.02)  # tall things are held near their tops
    if object_name == "part":
        with open(os.path.join(folder, "part.obj"), "w") as part:
            part.write(wedge())
    ramp = lambda ends: {"keyframes": [{"time": 0, "value": ends[0]}, {"time": 0.3, "value": ends[0]}, {"time": 1.3, "value": ends[1]}]}
    under = [center[0], center[1], center[2] - below - 0.002]
    thing = {"name": "thing", **shape, "mass": mass, "position": center}
    for part in thing.get("shapes", [thing]):
        part["material"] = {"mu_s": friction}
    return {
        "version": 1, "duration": seconds, "tick": 0.002, "combination": "maximum",
        "robots": [{"name": "hand", "file": hand["path"], "position": hand["position"], "rotation": hand["rotation"], "start": hand["start"],
                    "drives": {name: ramp(ends) for name, ends in hand["drives"].items()}}],
        "bodies": [thing,
                   {"name": "plate", "shape": {"type": "box", "size": [0.02, 0.02, 0.004]}, "trajectory": {"keyframes": [
                       {"time": 0, "position": under}, {"time": 2, "position": under}, {"time": 3, "position": [under[0], under[1], under[2] - 0.15]}]}}],
        "record": {"interval": 1, "quantities": ["thing.p_x", "thing.p_y", "thing.p_z", "thing.v_z"]},
    }


def wedge():
    """A part that is neither round nor square: an L of 40 mm, extruded."""
    outline = [(-0.02, -0.02), (0.02, -0.02), (0.02, 0.0), (0.0, 0.0), (0.0, 0.02), (-0.02, 0.02)]
    lines = [f"v {x} {y} {z}" for z in (-0.02, 0.02) for x, y in outline]
    n = len(outline)
    for k in range(n):
        a, b = k + 1, (k + 1) % n + 1
        lines += [f"f {a} {b} {b + n}", f"f {a} {b + n} {a + n}"]
    for a, b, c in [(1, 2, 3), (1, 3, 4), (1, 4, 5), (1, 5, 6)]:
        lines += [f"f {c} {b} {a}", f"f {a + n} {b + n} {c + n}"]
    return "\n".join(lines) + "\n"


def run(pincer, scene, folder, awake):
    path, out = os.path.join(folder, "scene.json"), os.path.join(folder, "out.csv")
    with open(path, "w") as file:
        json.dump(scene, file)
    command = [pincer, "sim", path, "--out", out, "--json"] + (["--awake"] if awake else [])
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(done.stderr[-2000:] or done.stdout[-2000:])
    with open(out) as file:
        rows = [[float(x) for x in row] for row in csv.reader(line for line in file if line[0] in "-0123456789")]
    return rows, json.loads(done.stdout)


def creep(rows, settled):
    held = [row for row in rows if row[0] >= settled]
    return max(max(abs(row[k] - held[0][k]) for k in (1, 2, 3)) for row in held)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("pincer")
    parser.add_argument("robots")
    parser.add_argument("--seconds", type=float, default=600)
    parser.add_argument("--only", default="")
    parser.add_argument("--friction", type=float, default=1.0)
    arguments = parser.parse_args()
    good = True
    for hand_name, hand in HANDS.items():
        hand["path"] = os.path.abspath(os.path.join(arguments.robots, hand["file"]))
        for object_name in hand["objects"]:
            if arguments.only not in f"{hand_name}-{object_name}":
                continue
            with tempfile.TemporaryDirectory() as folder:
                scene = scene_of(folder, hand_name, object_name, arguments.seconds, arguments.friction)
                for awake in (True, False):
                    rows, result = run(arguments.pincer, scene, folder, awake)
                    dropped = rows[-1][3] - scene["bodies"][0]["position"][2]
                    moved = creep(rows, min(30, arguments.seconds / 2)) * 1e6
                    print(f"{hand_name} holds a {object_name}, {'awake' if awake else 'asleep'}: creep {moved:.1e} um, {dropped * 1e3:+.3f} mm since the start, {json.dumps(result.get('flags', result.get('status', {})))}", flush=True)
                    good = good and moved <= 1e-6 and abs(dropped) < 0.03
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
