#!/usr/bin/python3
"""Six pushes on grasps that a search finds: PYTHONPATH=build/python pushes.py ROBOTS [--hand NAME] [--grasps N] [--seed S]

The protocol of DexGraspBench: an object of 100 g, no gravity, ticks of 4 ms, friction 0.6 with a torsion radius of 20 mm; after the hand has closed on it, a
force of 1 N for 2 s along each of +-x, +-y, +-z of the world, each from the closed grasp. Held is what moved by less than 5 cm and 15 degrees.

The search draws an object, its pose before the palm and where the fingers close to; a grasp is what rests (below 1 mm/s) with three links or more on it. Printed for
each hand: how many draws that took, grasps that held all six pushes, the largest way while pushed (of those that held), how far the object is off its place when
half a second has gone by without a push, ticks without an answer. Fails where something that rests lies deeper than 10 um in something else.
"""
import argparse
import math
import os
import sys

import numpy
import pincer

TICK, MASS, FORCE, OBJECTS = 0.004, 0.1, 1.0, 6
SHADOW_FINGERS = ("FF", "MF", "RF", "LF")
# Drives: open, and the range that closed targets are drawn from. Where objects are drawn: middle and half widths [m].
HANDS = {
    "shadow": {"file": "shadow_hand/right_hand.xml", "center": (0.34, -0.005, 0.055), "spread": (0.02, 0.02, 0.012), "drives": {
        **{f"rh_A_{f}J3": (0.1, 0.7, 1.5) for f in SHADOW_FINGERS}, **{f"rh_A_{f}J0": (0.2, 1.0, 2.6) for f in SHADOW_FINGERS},
        "rh_A_THJ5": (0.0, -0.3, 0.6), "rh_A_THJ4": (1.2, 0.9, 1.2), "rh_A_THJ2": (0.0, 0.0, 0.6), "rh_A_THJ1": (0.0, 0.3, 1.3)}},
    "allegro": {"file": "wonik_allegro/right_hand.xml", "center": (0.05, 0.0, 0.055), "spread": (0.02, 0.02, 0.015), "drives": {
        **{f"{f}a1": (0.3, 0.8, 1.6) for f in ("ff", "mf", "rf")}, **{f"{f}a2": (0.3, 0.8, 1.7) for f in ("ff", "mf", "rf")},
        **{f"{f}a3": (0.3, 0.6, 1.6) for f in ("ff", "mf", "rf")}, "tha0": (1.2, 0.9, 1.35), "tha1": (0.2, 0.3, 1.1), "tha2": (0.2, 0.3, 1.4), "tha3": (0.2, 0.3, 1.4)}},
}


def draw_object(random):
    kind = random.integers(3)
    if kind == 0:
        return "ball", {"type": "sphere", "radius": random.uniform(0.02, 0.035)}
    if kind == 1:
        return "box", {"type": "box", "size": list(random.uniform(0.03, 0.055, 3))}
    return "cylinder", {"type": "cylinder", "radius": random.uniform(0.015, 0.03), "length": random.uniform(0.05, 0.1)}


def draw_turn(random):
    axis = random.normal(size=3)
    return axis / numpy.linalg.norm(axis) * random.uniform(0, math.pi)


def models_of(path, random):
    """The hand with one of OBJECTS things each, drawn as well."""
    models = []
    for _ in range(OBJECTS):
        kind, shape = draw_object(random)
        # The hand's surfaces have friction 1, and two that touch the geometric mean.
        models.append((kind, pincer.load({"version": 1, "duration": 1, "tick": TICK, "gravity": [0, 0, 0], "robots": [{"name": "hand", "file": path}], "bodies": [
            {"name": "thing", "shape": shape, "mass": MASS, "position": [0, 0, 1], "material": {"mu_s": 0.36, "torsion_radius": 0.02}}]})))
    return models


def touches(state, thing):
    return [c for c in state.contacts if thing in (c["body"], c["other_body"])]


def closed_grasp(hand, models, random):
    """A model and its state with the object held, or None."""
    kind, model = models[random.integers(len(models))]
    state, inputs = pincer.State(model), pincer.Inputs(model)
    drives = [(model.drives.index(f"hand_{name}"), *ends) for name, ends in hand["drives"].items()]
    targets = [random.uniform(low, high) for _, _, low, high in drives]
    inputs.drive_target[:] = 0
    for d, opened, _, _ in drives:
        inputs.drive_target[d] = opened
    pincer.step(model, state, 150, inputs)  # the hand opens
    thing = model.bodies.index("thing")
    turn = draw_turn(random)
    angle = numpy.linalg.norm(turn)
    place = numpy.array(hand["center"]) + random.uniform(-1, 1, 3) * hand["spread"]
    state.body("thing").position = [*place, math.cos(angle / 2), *(turn / angle * math.sin(angle / 2))]
    pincer.step(model, state, 1, inputs)
    if any(c["gap"] < -1e-3 for c in touches(state, thing)):
        return None
    for n in range(1, 101):
        for (d, opened, _, _), target in zip(drives, targets):
            inputs.drive_target[d] = opened + (target - opened) * n / 100
        pincer.step(model, state, 3, inputs)
    pincer.step(model, state, 250, inputs)
    links = {c["other_body"] if c["body"] == thing else c["body"] for c in touches(state, thing) if c["pushes"]}
    if len(links) < 3 or numpy.linalg.norm(state.body("thing").velocity[:3]) > 1e-3:
        return None
    return kind, model, state, inputs, thing


def turned_by(a, b):
    return 2 * math.degrees(math.acos(min(1.0, abs(float(numpy.dot(a[3:], b[3:]))))))


def pushes(model, closed, inputs, thing, count):
    """The largest way [m] and turn [degrees] in six pushes, and how far it is off half a second after each [m]."""
    start = closed.body("thing").position.copy()
    way = turn = off = 0.0
    for axis in range(3):
        for sign in (1, -1):
            state = closed.copy()
            inputs.body_force[:] = 0
            inputs.body_force[thing] = [sign * FORCE * (k == axis) for k in range(3)] + [0] * (inputs.body_force.shape[1] - 3)
            for _ in range(round(2 / TICK)):
                step(model, state, inputs, thing, count)
                way = max(way, float(numpy.linalg.norm(state.body("thing").position[:3] - start[:3])))
                turn = max(turn, turned_by(state.body("thing").position, start))
                if way > 0.05 or turn > 15:
                    return way, turn, math.nan
            inputs.body_force[:] = 0
            for _ in range(round(0.5 / TICK)):
                step(model, state, inputs, thing, count)
            off = max(off, float(numpy.linalg.norm(state.body("thing").position[:3] - start[:3])))
    return way, turn, off


def step(model, state, inputs, thing, count):
    report = pincer.step(model, state, 1, inputs)
    count["ticks"] += 1
    if int(report.status) != 0:
        count["flagged"] += 1
    count["rested"] += bool(report.asleep)
    if not report.asleep:
        return  # gaps of what moves are those of the middle of the tick, where it would be if nothing were in its way
    contacts = state.contacts
    deep = contacts["gap"][(contacts["body"] == thing) | (contacts["other_body"] == thing)]
    if len(deep):
        count["overlap"] = max(count["overlap"], -float(deep.min()))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("robots")
    parser.add_argument("--hand", default="")
    parser.add_argument("--grasps", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--draws", type=int, default=4000)
    arguments = parser.parse_args()
    good = True
    for name, hand in HANDS.items():
        if arguments.hand not in name:
            continue
        random = numpy.random.default_rng(arguments.seed)
        models = models_of(os.path.abspath(os.path.join(arguments.robots, hand["file"])), random)
        found, draws, held, ways, offs, count = 0, 0, 0, [], [], {"ticks": 0, "flagged": 0, "rested": 0, "overlap": 0.0}
        while found < arguments.grasps and draws < arguments.draws:
            draws += 1
            grasp = closed_grasp(hand, models, random)
            if grasp is None:
                continue
            found += 1
            kind, *rest = grasp
            way, turn, off = pushes(*rest, count)
            is_held = way <= 0.05 and turn <= 15
            held += is_held
            if is_held:
                ways.append(way)
                offs.append(off)
            print(f"{name} {found} of {draws} draws, {kind}: {'held' if is_held else 'lost'}, {way * 1e3:.2f} mm, {turn:.2f} degrees, then off {off * 1e6:.3g} um", flush=True)
        print(f"{name}: {held} of {found} grasps hold six pushes; {draws} draws; way while pushed: median {numpy.median(ways) * 1e3:.2f} mm, most {max(ways) * 1e3:.2f} mm; "
              f"off afterwards: median {numpy.median(offs) * 1e6:.3g} um; {count['flagged']} of {count['ticks']} ticks flagged, {count['rested']} at rest, "
              f"deepest overlap at rest {count['overlap'] * 1e6:.3g} um", flush=True)
        good = good and found == arguments.grasps and count["overlap"] <= 10e-6
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
