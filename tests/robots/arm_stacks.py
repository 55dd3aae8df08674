#!/usr/bin/env python3
"""tests/robots/arm_stacks.py   writes tasks/scenes/files/arm_stacks.json: what each drive of the arm is told, so that it
picks ten boxes from the floor and stacks them.

The arm (arm.urdf, arm.xml): yaw about z, shoulder and elbow about y, roll along the forearm, pitch about y, turn along
the tool. With the tool downwards, roll is 0 and shoulder + elbow + pitch = pi, so that shoulder and elbow are those of
two rods in a plane. A position drive gives way by the torque that it bears over its stiffness: targets are further by
what gravity asks of it.
"""
import json
import math
import sys

SHOULDER = 0.4  # height [m]
UPPER, FORE, TOOL = 0.4, 0.35, 0.2  # rods, and from the wrist to the middle of the pads [m]
BOX, BOX_MASS = 0.04, 0.05  # [m], [kg]
STACK = 0.45, 0.0  # [m]
RELEASE = 20e-6  # gap under a box that is let go [m]
ABOVE = 0.08  # way that is straight down and up [m]
OPEN, GRIP = 0.015, -0.005  # of the fingers' coordinate, 0 where the pads are 40 mm apart [m]
STIFFNESS = 2e5  # of the arm's joints [N m/rad]
G = 9.81
JOINTS = ["yaw", "shoulder", "elbow", "roll", "pitch", "turn"]
# Of what the shoulder carries: mass [kg], and from which joint on it lies how far along the rod [m].
PARTS = [("upper", 4.0, 0.2), ("fore", 2.0, 0.15), ("fore", 0.5, 0.35), ("tool", 0.4, 0.0), ("tool", 0.6, 0.1),
         ("tool", 0.1, 0.18)]


def angles(x, y, z, heading):
    """Joint angles for pads at (x, y, z), tool down, fingers closing along the y axis of `heading`."""
    r, h = math.hypot(x, y), z + TOOL - SHOULDER
    elbow = math.acos((r * r + h * h - UPPER**2 - FORE**2) / (2 * UPPER * FORE))
    shoulder = math.atan2(r, h) - math.atan2(FORE * math.sin(elbow), UPPER + FORE * math.cos(elbow))
    yaw = math.atan2(y, x)
    return [yaw, shoulder, elbow, 0.0, math.pi - shoulder - elbow, yaw - heading]


def torques(q, load):
    """What gravity asks of each drive [N m], `load` [kg] between the pads."""
    x1, x2 = UPPER * math.sin(q[1]), FORE * math.sin(q[1] + q[2])
    about_shoulder = about_elbow = 0.0
    for rod, mass, along in PARTS + [("tool", load, TOOL)]:
        x = along * math.sin(q[1]) if rod == "upper" else x1 + (along / FORE * x2 if rod == "fore" else x2)
        about_shoulder += mass * G * x
        about_elbow += 0.0 if rod == "upper" else mass * G * (x - x1)
    return [0.0, -about_shoulder, -about_elbow, 0.0, 0.0, 0.0]


class Plan:
    def __init__(self):
        self.time, self.told, self.fingers = 0.0, [], []

    def to(self, duration, place, finger, load=0.0):
        self.time += duration
        q = angles(*place)
        self.told.append((self.time, [a + t / STIFFNESS for a, t in zip(q, torques(q, load))]))
        self.fingers.append((self.time, finger))


def boxes():
    """Places on the floor: x, y, heading."""
    for i in range(10):
        side, n = 1 - 2 * (i % 2), i // 2
        angle, radius = side * math.radians(28 + 20 * n), 0.4 + 0.03 * (n % 3)
        yield radius * math.cos(angle), radius * math.sin(angle), angle + math.radians(7 * n - 14)


def plan():
    p = Plan()
    home = (0.35, 0.0, 0.5, 0.0)
    p.to(0.0, home, OPEN)
    for i, (x, y, heading) in enumerate(boxes()):
        low, top = BOX / 2, BOX / 2 + BOX * i
        high = max(low, top) + ABOVE
        p.to(0.8, (x, y, low + ABOVE, heading), OPEN)
        p.to(0.4, (x, y, low, heading), OPEN)
        p.to(0.3, (x, y, low, heading), GRIP)
        p.to(0.4, (x, y, low + ABOVE, heading), GRIP, BOX_MASS)
        if high > low + ABOVE:
            p.to(0.5, (x, y, high, heading), GRIP, BOX_MASS)
        p.to(0.8, (*STACK, high, 0.0), GRIP, BOX_MASS)
        p.to(0.4, (*STACK, top + RELEASE, 0.0), GRIP, BOX_MASS)
        p.to(0.2, (*STACK, top + RELEASE, 0.0), GRIP, BOX_MASS)
        p.to(0.2, (*STACK, top + RELEASE, 0.0), OPEN)
        p.to(0.4, (*STACK, high, 0.0), OPEN)
    p.to(1.0, home, OPEN)
    return p


def number(value, digits=9):
    return round(value, digits) + 0.0


def keyframes(points):
    """Without those in the middle of a rest."""
    kept = [k for n, k in enumerate(points)
            if n == 0 or n + 1 == len(points) or not points[n - 1][1] == k[1] == points[n + 1][1]]
    return {"keyframes": [{"time": number(t, 3), "value": number(v)} for t, v in kept]}


def drive(name, joint, stiffness, damping, points, **more):
    return {"name": name, "joint": f"arm_{joint}", "type": "position", "stiffness": stiffness, "damping": damping,
            **more, "trajectory": keyframes(points)}


def expectations(end):
    found = []
    for i in range(10):
        for quantity, value, because in [("p_x", STACK[0], "it is let go over the others"), ("p_y", STACK[1], "likewise"),
                                         ("p_z", BOX / 2 + BOX * i, "it stands on the others")]:
            found.append({"quantity": f"box{i}.{quantity}", "time": "end", "value": number(value), "tolerance": 1e-6,
                          "because": because})
        found.append({"quantity": f"box{i}.speed", "time": "end", "value": 0, "tolerance": 1e-12, "because": "it rests"})
    for i, (_, _, heading) in enumerate(boxes()):
        found.append({"quantity": f"box{i}.rotation", "time": "end", "value": number(abs(heading)), "tolerance": 1e-3,
                      "because": "it was turned to the stack's heading, 0"})
    found.append({"quantity": "box9.p_x", "time": number(end - 1, 3), "value": STACK[0], "tolerance": 1e-6,
                  "because": "it doesn't creep"})
    return found


def scene():
    p = plan()
    start = {joint: number(q) for joint, q in zip(JOINTS, p.told[0][1])}
    bodies = [{"name": "floor", "shape": {"type": "half_space"}, "static": True, "material": {"mu_s": 0.5}}]
    for i, (x, y, heading) in enumerate(boxes()):
        bodies.append({"name": f"box{i}", "shape": {"type": "box", "size": [BOX] * 3}, "mass": BOX_MASS,
                       "position": [number(x), number(y), BOX / 2], "rotation": [0, 0, number(heading)],
                       "material": {"mu_s": 0.5}})
    damping = [4000, 4000, 2000, 400, 400, 200]
    drives = [drive(joint, joint, STIFFNESS, damping[k], [(t, q[k]) for t, q in p.told])
              for k, joint in enumerate(JOINTS)]
    drives.append(drive("grip", "left", 4000, 80, p.fingers, force=[-60, 60]))
    return {"version": 1, "description": "An arm of six joints stacks ten boxes", "duration": number(p.time + 1, 3),
            "robots": [{"name": "arm", "file": "arm.urdf", "start": start | {"left": OPEN}}], "bodies": bodies,
            "drives": drives, "camera": {"yaw": 0.6, "pitch": 0.3, "distance": 1.8, "target": [0.2, 0, 0.3]},
            "record": {"interval": 0.05, "quantities": ["box0.p_z", "box9.p_x", "box9.p_y", "box9.p_z"]},
            "expect": expectations(p.time)}


def written(scene):
    """One line per entry of a list, so that a change of one shows as one."""
    lines = []
    for key, value in scene.items():
        if isinstance(value, list):
            inner = ",\n".join("    " + json.dumps(v) for v in value)
            lines.append(f'  "{key}": [\n{inner}\n  ]')
        else:
            lines.append(f'  "{key}": {json.dumps(value)}')
    head = ("// An arm from a URDF file picks ten boxes from the floor and stacks them. What its drives are told is computed by\n"
            "// tests/robots/arm_stacks.py, by the arm's inverse kinematics; arm.xml is the same arm in MJCF.\n")
    return head + "{\n" + ",\n".join(lines) + "\n}\n"


if __name__ == "__main__":
    sys.stdout.write(written(scene()))
