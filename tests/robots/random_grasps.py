#!/usr/bin/python3
"""Random grasps that hold a weight or don't: PYTHONPATH=build/python random_grasps.py ROBOTS [--hand NAME] [--grasps N] [--seed S] [--seconds T]

A hand closes on an object (ball, box, cylinder of random size, pose and mass) without gravity; then the object weighs something, into a random direction, for T.
Held is what went less than 20 mm and ends below 1 um/s; beside it, how far the object is at the end from where it was after 30 s (or after half of T). An object stays if it went less than STAYS, and is let go if it went more than GOES.

Beside it stands the limit of the wrench cones: the largest share of the weight that forces within the cones of closed contacts bear, before the weight comes and where
the object ends. Jaws press with what their drive gives (the sum of both is measured: the coupling bears the difference), so that theirs is a number; of a hand whose
fingers may press as they like it says only which weights no force bears at all. Fails where, by more than MARGIN, an object stays or rests whose limit there is below
its weight, or jaws let go what their limit allows.
"""
import argparse
import math
import os
import sys

import numpy
import pincer
import pushes
from scipy.optimize import linprog

TICK, SIDES, MARGIN, STAYS, GOES = 0.002, 64, 0.05, 1e-9, 1e-6
FRANKA = {"file": "franka_emika_panda/hand.xml", "center": (0, 0, 0.1), "spread": (0.004, 0, 0.004), "drives": {"actuator8": (255, 0, 0)}, "least": 2,
          "start": {"finger_joint1": 0.04, "finger_joint2": 0.04}, "masses": (0.02, 0.25)}
# Its file, URDF, has no drives: some that give a fingertip 15 N. Two fingers stand against the third.
BARRETT = {"file": "barrett_hand/bhand_model.urdf", "center": (0, 0, 0.13), "spread": (0.01, 0.01, 0.015), "least": 3, "masses": (0.05, 0.5), "drives": {
    **{f"drive_finger_{f}_med": (-1.0, -2.3, -1.7) for f in (1, 2, 3)}, **{f"drive_finger_{f}_dist": (-0.2, -0.78, -0.3) for f in (1, 2, 3)},
    "drive_finger_1_prox": (0, -0.3, 0), "drive_finger_2_prox": (0, 0, 0.3)}, "drive": {"type": "position", "stiffness": 4, "damping": 0.2, "force": [-1.5, 1.5], "target": 0}}
# A model of Shadow takes longer to build than a grasp to close: it serves some poses of its object.
HANDS = {"franka": FRANKA, "shadow": {**pushes.HANDS["shadow"], "least": 3, "masses": (0.05, 0.5), "poses": 10}, "barrett": BARRETT}


def draw_object(name, random):
    kind, shape = pushes.draw_object(random)
    if name == "franka" and kind == "cylinder":
        shape["length"] = random.uniform(0.03, 0.06)
    return kind, shape


def load(name, hand, path, random):
    kind, shape = draw_object(name, random)
    mass = float(numpy.exp(random.uniform(*numpy.log(hand["masses"]))))
    turn = pushes.draw_turn(random)
    place = numpy.array(hand["center"]) + random.uniform(-1, 1, 3) * hand["spread"]
    drives = [{"name": f"hand_{drive}", "joint": f"hand_{drive.removeprefix('drive_')}_joint", **hand["drive"]} for drive in hand["drives"]] if "drive" in hand else []
    return kind, mass, pincer.load({"version": 1, "duration": 1, "tick": TICK, "gravity": [0, 0, 0], "drives": drives,
                                    "robots": [{"name": "hand", "file": path, "start": hand.get("start", {})}],
                                    "bodies": [{"name": "thing", "shape": shape, "mass": mass, "position": list(place), "rotation": list(turn), "material": {"mu_s": 0.36}}]})


def draw_pose(hand, random):
    turn = pushes.draw_turn(random)
    angle = numpy.linalg.norm(turn)
    place = numpy.array(hand["center"]) + random.uniform(-1, 1, 3) * hand["spread"]
    return [*place, math.cos(angle / 2), *(turn / angle * math.sin(angle / 2))]


def close(hand, model, pose, random):
    """The state, its inputs and the object's number, once the hand holds it without gravity; or None. `pose`: where it starts, None: where the model has it."""
    state, inputs, thing = pincer.State(model), pincer.Inputs(model), model.bodies.index("thing")
    inputs.drive_target[:] = 0
    drives = [(model.drives.index(f"hand_{drive}"), *ends) for drive, ends in hand["drives"].items()]
    start = state.body("thing").position.copy() if pose is None else pose
    targets = [random.uniform(low, high) for _, _, low, high in drives]
    for d, opened, _, _ in drives:
        inputs.drive_target[d] = opened
    pincer.step(model, state, round(0.6 / TICK), inputs)  # the hand opens, through the object if it must
    state.body("thing").position = start
    state.body("thing").velocity = numpy.zeros(6)
    pincer.step(model, state, 1, inputs)
    if any(c["gap"] < -1e-5 for c in pushes.touches(state, thing)):
        return None
    for n in range(1, 101):
        for (d, opened, _, _), target in zip(drives, targets):
            inputs.drive_target[d] = opened + (target - opened) * n / 100
        pincer.step(model, state, round(0.012 / TICK), inputs)
    pincer.step(model, state, round(1 / TICK), inputs)
    links = {c["other_body"] if c["body"] == thing else c["body"] for c in pushes.touches(state, thing) if c["pushes"]}
    if len(links) < hand["least"] or numpy.linalg.norm(state.body("thing").velocity[:3]) > 1e-4:
        return None
    return state, inputs, thing


def limit(model, state, thing, weight, jaws):
    """The largest s, at most 1000, for which forces within the cones bear s times `weight` [N], and jaws press as they do."""
    columns, press, pressed = [], [], 0.0
    center = state.body("thing").position[:3]
    for c in pushes.touches(state, thing):
        if not c["pushes"] and abs(c["gap"]) > 1e-10:
            continue
        sign = -1.0 if c["body"] == thing else 1.0  # the normal leads out of what is touched; the force is on what touches
        into, link = sign * c["normal"], model.bodies[c["other_body"] if c["body"] == thing else c["body"]]
        side = numpy.array([0, -1.0 if "left" in link else 1.0 if "right" in link else 0, 0])  # the way each jaw closes, in the frame of the hand
        pressed += sign * float(c["force"] @ side)
        t1 = numpy.cross(into, [1, 0, 0] if abs(into[0]) < 0.8 else [0, 1, 0])
        t1 /= numpy.linalg.norm(t1)
        for angle in 2 * numpy.pi * numpy.arange(SIDES) / SIDES:
            f = into + c["mu"] * (numpy.cos(angle) * t1 + numpy.sin(angle) * numpy.cross(into, t1))
            columns.append([*f, *(numpy.cross(c["place"] - center, f) / 0.03)])
            press.append(float(f @ side))
    if not columns:
        return 0.0
    n = len(columns)
    rows, right = numpy.hstack([numpy.array(columns).T, [[w] for w in (*weight, 0, 0, 0)]]), numpy.zeros(6)
    if jaws:
        rows, right = numpy.vstack([rows, [*press, 0]]), numpy.append(right, pressed)
    # Loads may be off by 1e-7 N: the round-off of what the engine calls at rest.
    solved = linprog([0] * n + [-1], A_ub=numpy.vstack([rows, -rows]), b_ub=numpy.concatenate([right, -right]) + 1e-7, bounds=[(0, None)] * n + [(0, 1000)])
    return float(solved.x[-1]) if solved.status == 0 else 0.0


def hold(model, state, inputs, thing, weight, seconds):
    start, flagged, ticks = state.body("thing").position[:3].copy(), 0, round(seconds / TICK)
    settled = round(min(30, seconds / 2) / TICK)
    inputs.body_force[:] = 0
    inputs.body_force[thing][:3] = weight
    way, there, tick = 0.0, start, 0
    while tick < ticks:
        if tick == settled:
            there = state.body("thing").position[:3].copy()
        # After that it is looked at twice a second; of such a stretch one flag is counted.
        count = 1 if tick < settled else min(250, ticks - tick)
        tick += count
        flagged += int(pincer.step(model, state, count, inputs).status) != 0
        way = float(numpy.linalg.norm(state.body("thing").position[:3] - start))
        if way > 0.02:
            break
    crept = float(numpy.linalg.norm(state.body("thing").position[:3] - there))
    return way, crept, float(numpy.linalg.norm(state.body("thing").velocity[:3])), flagged


def judge(name, hand, path, arguments):
    random = numpy.random.default_rng(arguments.seed)
    jaws, counts, draws, flags, wrong, went, creep = name == "franka", {"held": 0, "moves": 0, "lost": 0}, 0, 0, 0, [], []
    while sum(counts.values()) < arguments.grasps and draws < arguments.draws:
        is_new = draws % hand.get("poses", 1) == 0
        draws += 1
        if is_new:
            kind, mass, model = load(name, hand, path, random)
        grasp, direction = close(hand, model, None if is_new else draw_pose(hand, random), random), random.normal(size=3)
        if grasp is None:
            continue
        state, inputs, thing = grasp
        weight = direction / numpy.linalg.norm(direction) * mass * 9.81
        first = limit(model, state, thing, weight, jaws)
        way, crept, speed, flagged = hold(model, state, inputs, thing, weight, arguments.seconds)
        result = "lost" if way > 0.02 else "moves" if speed > 1e-6 else "held"
        last = limit(model, state, thing, weight, jaws) if result == "held" else None
        off = (way < STAYS and first < 1 - MARGIN) or (last is not None and last < 1 - MARGIN) or (jaws and way > GOES and first > 1 + MARGIN)
        counts[result], flags, wrong = counts[result] + 1, flags + flagged, wrong + off
        went += [way] if first > 1 + MARGIN else []
        creep += [crept] if result == "held" else []
        print(f"{name} {sum(counts.values())} of {draws} draws, {kind} of {mass * 1e3:.0f} g: {result}, bears {first:.3g} times its weight"
              f"{f', at the end {last:.3g} times' if last is not None else ''}, went {way * 1e3:.3g} mm, crept {crept * 1e6:.2g} um, {speed * 1e6:.2g} um/s, {flagged} flagged{', AGAINST ITS LIMIT' if off else ''}",
              flush=True)
    print(f"{name}: {counts} in {draws} draws; {len(went)} whose limit is above their weight went {max(went, default=0) * 1e3:.3g} mm at most; {flags} ticks flagged; "
          f"what is held crept {max(creep, default=0) * 1e6:.2g} um at most, {sum(c == 0 for c in creep)} nothing; "
          f"{wrong} against their limit", flush=True)
    return wrong == 0 and sum(counts.values()) == arguments.grasps


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("robots")
    parser.add_argument("--hand", default="")
    parser.add_argument("--grasps", type=int, default=32)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--draws", type=int, default=4000)
    arguments = parser.parse_args()
    good = True
    for name, hand in HANDS.items():
        if arguments.hand in name:
            good = judge(name, hand, os.path.abspath(os.path.join(arguments.robots, hand["file"])), arguments) and good
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
