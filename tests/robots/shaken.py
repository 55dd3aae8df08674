#!/usr/bin/python3
"""A hand that is shaken holds on: PYTHONPATH=build/python shaken.py ROBOTS [--object NAME] [--shake SD] [--every SECONDS] [--seconds S] [--seed N]

The Allegro of grasps.py closes on an object, the plate goes away, and then each joint's target is its own plus a normal deviate of SD [rad], drawn anew every so often.
Forces are in balance where those of the contacts on the object are m (dv/dt - g). Printed: how far from that they are in the worst tick, ticks without an answer, how
far the object goes, its creep from 5 to 10 s afterwards, and if all sleeps then. A tick that an impact cuts shows the forces of its last part, and isn't judged. Fails where another one that
was answered is off by more than 1e-9 N.
"""
import argparse
import json
import os
import sys
import tempfile

import grasps
import numpy
import pincer


def force_on(state, thing):
    contacts = state.contacts
    return contacts["force"][contacts["other_body"] == thing].sum(axis=0) - contacts["force"][contacts["body"] == thing].sum(axis=0)


def shaken(name, arguments):
    hand = grasps.HANDS["allegro"]
    hand["path"] = os.path.abspath(os.path.join(arguments.robots, hand["file"]))
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.json")
        with open(path, "w") as file:
            json.dump(grasps.scene_of(folder, "allegro", name, 10, 1.0), file)
        model = pincer.load(path)
    state, random = pincer.State(model), numpy.random.default_rng(arguments.seed)
    thing, mass, tick = model.bodies.index("thing"), grasps.OBJECTS[name][1], model.tick
    pincer.step(model, state, round(4 / tick))
    inputs = pincer.Inputs(model)
    inputs.motion_position[:] = [*state.body("plate").position]
    inputs.motion_velocity[:] = 0
    closed = numpy.zeros(model.ndrive)
    for drive, target in grasps.ALLEGRO_CLOSED.items():
        closed[model.drives.index(f"hand_{drive}")] = target
    inputs.drive_target[:] = closed
    start, worst, far, flagged, cut = state.body("thing").position[:3].copy(), 0.0, 0.0, 0, 0
    ticks, every = round(arguments.seconds / tick), round(arguments.every / tick)
    for k in range(ticks):
        if k % every == 0:
            inputs.drive_target[:] = closed + random.normal(0, arguments.shake, model.ndrive)
        before = state.body("thing").velocity[:3].copy()
        report = pincer.step(model, state, 1, inputs)
        now = state.body("thing")
        far = max(far, float(numpy.linalg.norm(now.position[:3] - start)))
        if int(report.status) != 0:
            flagged += 1
            continue
        if report.parts > 1:
            cut += 1
            continue
        off = force_on(state, thing) - mass * ((now.velocity[:3] - before) / tick + numpy.array([0, 0, grasps.GRAVITY]))
        worst = max(worst, float(numpy.linalg.norm(off)))
    inputs.drive_target[:] = closed
    pincer.step(model, state, round(5 / tick), inputs)
    settled = state.body("thing").position[:3].copy()
    report = pincer.step(model, state, round(5 / tick), inputs)
    speed = max(float(numpy.abs(state.body(body).velocity).max()) for body in model.bodies)
    creep = float(numpy.linalg.norm(state.body("thing").position[:3] - settled))
    print(f"allegro, a {name}, targets shaken by {arguments.shake} rad every {arguments.every} s for {arguments.seconds} s: forces off by {worst:.1e} N at most, "
          f"{flagged} of {ticks} ticks flagged, {cut} cut, went {far * 1e3:.2f} mm, then creeps by {creep * 1e6:.1e} um in 5 s, "
          f"{'asleep' if report.asleep else f'not asleep: something moves by {speed:.1e}'}", flush=True)
    return worst <= 1e-9


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("robots")
    parser.add_argument("--object", default="", choices=["", *grasps.OBJECTS])
    parser.add_argument("--shake", type=float, default=0.025)
    parser.add_argument("--every", type=float, default=0.02)
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    names = [arguments.object] if arguments.object else list(grasps.OBJECTS)
    sys.exit(0 if all([shaken(name, arguments) for name in names]) else 1)


if __name__ == "__main__":
    main()
