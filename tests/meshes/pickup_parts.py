#!/usr/bin/env python3
"""Twelve detailed parts picked up by simulated hands: does a tick take 1 ms of its own, is one flagged?

    cmake --build build --target pincer thread_clock
    tests/meshes/pickup_parts.py build/pincer build/thread_clock.so MESHES OUT [PART ...] [--size MM] [--most N] [--seed N]

MESHES  a directory of fandisk, rocker-arm, spot, stanford-bunny, suzanne and teapot (.obj). Six more are made here.
Each is brought to 3,000 .. 12,000 triangles (--most) and 50 mm (--size) by pincer's own commands, then picked up in one
session of four frictions (--seed draws their order and the hand), five times over. The sessions are the same to the bit; a tick's time is the least of the five, in processor time of its
thread.
"""
import argparse
import math
import os
import pathlib
import sqlite3
import subprocess
import sys

REPLAYS = 5
LONGEST = 1000     # of a tick [us]
FEWEST = 3000      # triangles
FILES = ["fandisk", "rocker-arm", "spot", "stanford-bunny", "suzanne", "teapot"]


def write_obj(path, vertices, polygons):
    with open(path, "w") as out:
        out.writelines("v %.17g %.17g %.17g\n" % tuple(v) for v in vertices)
        out.writelines("f %s\n" % " ".join(str(i + 1) for i in p) for p in polygons)


def ring_solid(rings):
    """Closed rings of as many points each, one after the other around; the last joins the first."""
    n = len(rings[0])
    vertices = [p for ring in rings for p in ring]
    quads = []
    for k in range(len(rings)):
        a, b = k * n, (k + 1) % len(rings) * n
        quads += [(a + i, a + (i + 1) % n, b + (i + 1) % n, b + i) for i in range(n)]
    return vertices, [t for q in quads for t in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]


def bracket():
    """An angle of two plates."""
    outline = [(0, 0), (40, 0), (40, 8), (20, 8), (8, 8), (8, 20), (8, 40), (0, 40)]
    n = len(outline)
    vertices = [(x, y, z) for z in (0, 24) for x, y in outline]
    halves = [(0, 1, 2, 3), (0, 3, 4), (0, 4, 5), (0, 5, 6, 7)]
    faces = [tuple(reversed(h)) for h in halves] + [tuple(i + n for i in h) for h in halves]
    faces += [(i, (i + 1) % n, (i + 1) % n + n, i + n) for i in range(n)]
    return vertices, faces


def gear():
    """Twenty teeth about a bore."""
    outer, teeth = [], 20
    for i in range(teeth):
        for share, radius in ((0, 20), (0.28, 20), (0.42, 24), (0.62, 24), (0.76, 20)):
            angle = 2 * math.pi * (i + share) / teeth
            outer.append((radius * math.cos(angle), radius * math.sin(angle)))
    inner = [(8 * math.cos(2 * math.pi * i / len(outer)), 8 * math.sin(2 * math.pi * i / len(outer)))
             for i in range(len(outer))]
    return ring_solid([[(x, y, 0) for x, y in inner], [(x, y, 16) for x, y in inner],
                       [(x, y, 16) for x, y in outer], [(x, y, 0) for x, y in outer]][::-1])


def turned():
    """A spool with one row of quads from rim to rim."""
    profile = [(4, 0), (22, 0), (22, 6), (12, 12), (12, 24), (18, 30), (18, 36), (4, 36)]
    n = 256
    return ring_solid([[(r * math.cos(2 * math.pi * i / n), r * math.sin(2 * math.pi * i / n), z) for i in range(n)]
                       for r, z in profile])


def torus():
    n, m = 64, 48
    rings = []
    for k in range(m):
        a = 2 * math.pi * k / m
        r, z = 18 + 7 * math.cos(a), 7 * math.sin(a)
        rings.append([(r * math.cos(2 * math.pi * i / n), r * math.sin(2 * math.pi * i / n), z) for i in range(n)])
    return ring_solid(rings)


def marched(inside, low, high, cells):
    """The surface inside(x, y, z) = 0 by tetrahedra; negative within."""
    step = [(h - l) / cells for l, h in zip(low, high)]
    n = cells + 1
    place = lambda i, j, k: tuple(l + s * c for l, s, c in zip(low, step, (i, j, k)))
    value = [inside(*place(i, j, k)) or 1e-9 for k in range(n) for j in range(n) for i in range(n)]
    index = lambda i, j, k: (k * n + j) * n + i
    vertices, number, faces = [], {}, []
    points = {}

    def cut(a, b):
        key = (a, b) if a < b else (b, a)
        if key not in number:
            pa, pb = points[key[0]], points[key[1]]
            t = value[key[0]] / (value[key[0]] - value[key[1]])
            t = min(max(t, 0.1), 0.9)  # no slivers
            number[key] = len(vertices)
            vertices.append(tuple(u + t * (w - u) for u, w in zip(pa, pb)))
        return number[key]

    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    tetrahedra = [(0, 5, 1, 6), (0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6)]
    for k in range(cells):
        for j in range(cells):
            for i in range(cells):
                at = [index(i + a, j + b, k + c) for a, b, c in corners]
                signs = [value[c] < 0 for c in at]
                if all(signs) or not any(signs):
                    continue
                for c, (a, b, d) in zip(at, corners):
                    points[c] = place(i + a, j + b, k + d)
                for t in tetrahedra:
                    ids = [at[c] for c in t]
                    within = [c for c in range(4) if value[ids[c]] < 0]
                    without = [c for c in range(4) if value[ids[c]] >= 0]
                    if not within or not without:
                        continue
                    if len(within) == 2:
                        (a, b), (c, d) = within, without
                        loop = [cut(ids[a], ids[c]), cut(ids[b], ids[c]), cut(ids[b], ids[d]), cut(ids[a], ids[d])]
                    else:
                        lone, others = (within[0], without) if len(within) == 1 else (without[0], within)
                        loop = [cut(ids[lone], ids[o]) for o in others]
                    p = [vertices[v] for v in loop]
                    u, w = [[p[q][x] - p[0][x] for x in range(3)] for q in (1, 2)]
                    normal = (u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0])
                    out = sum(normal[x] * (sum(points[ids[q]][x] for q in without) / len(without) -
                                           sum(points[ids[q]][x] for q in within) / len(within)) for x in range(3))
                    loop = loop if out > 0 else loop[::-1]
                    faces += [(loop[0], loop[q], loop[q + 1]) for q in range(1, len(loop) - 1)]
    return vertices, faces


def mug():
    """A cup with a handle, its edges rounded."""
    def inside(x, y, z):
        r = math.hypot(x, y)
        body = max(r - 16, abs(z) - 20)
        hollow = max(r - 13, -16 - z)
        handle = math.hypot(math.hypot(x - 17, z) - 10, y) - 3
        return min(max(body, -hollow), max(handle, -max(r - 14.5, abs(z) - 19)))
    return marched(inside, (-18, -18, -22), (32, 18, 22), 56)


def scan():
    """A lumpy stone with the noise of a scanner, 30 um."""
    seed = 12345

    def noise():
        nonlocal seed
        seed = (1103515245 * seed + 12345) % 2**31
        return seed / 2**31 - 0.5
    n, m = 72, 70
    vertices = [(0, 0, -16), (0, 0, 16)]
    for k in range(1, m):
        for i in range(n):
            a, b = 2 * math.pi * i / n, math.pi * k / m - math.pi / 2
            d = (math.cos(a) * math.cos(b), math.sin(a) * math.cos(b), math.sin(b))
            lump = 1 + 0.06 * math.sin(5 * d[0] + 1) * math.sin(4 * d[1]) + 0.04 * math.sin(7 * d[2] + 3 * d[0])
            vertices.append(tuple(s * lump * c + 0.06 * noise() for s, c in zip((24, 19, 16), d)))
    at = lambda k, i: 2 + (k - 1) * n + i % n
    faces = []
    for i in range(n):
        faces += [(0, at(1, i + 1), at(1, i)), (1, at(m - 1, i), at(m - 1, i + 1))]
        for k in range(1, m - 1):
            faces += [(at(k, i), at(k, i + 1), at(k + 1, i + 1)), (at(k, i), at(k + 1, i + 1), at(k + 1, i))]
    return vertices, faces


MADE = {"bracket": (bracket, 4), "gear": (gear, 1), "turned": (turned, 0), "torus": (torus, 0), "mug": (mug, 0),
        "scan": (scan, 0)}  # and how often each is subdivided


def run(*command, preload=None):
    surroundings = dict(os.environ, LD_PRELOAD=str(preload)) if preload else None
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, env=surroundings)
    return done.returncode, done.stdout + done.stderr


def must(*command):
    code, text = run(*command)
    if code not in (0, 1):
        sys.exit(" ".join(str(c) for c in command) + "\n" + text)
    return text


def triangles_of(path):
    return sum(1 for line in open(path) if line.startswith("f "))


def prepared(asked, name):
    """The part's file, of few enough triangles and enough."""
    pincer = asked.pincer
    part, raw, fine = (asked.out / (name + end) for end in (".obj", "-raw.obj", "-fine.obj"))
    if name in MADE:
        make, levels = MADE[name]
        write_obj(raw, *make())
        if levels:
            must(pincer, "mesh", "subdivide", raw, fine, "--units", "mm", "--levels", levels)
            raw = fine
    else:
        must(pincer, "mesh", "convert", "--repair", "--fill-holes", "200", asked.meshes / (name + ".obj"), raw,
             "--size", asked.size / 1000)
        if triangles_of(raw) < FEWEST:
            must(pincer, "mesh", "subdivide", raw, fine)
            raw = fine
    units = "mm" if name in MADE else "m"
    if triangles_of(raw) > asked.most:
        said = must(pincer, "mesh", "simplify", raw, part, "--units", units, "--triangles", asked.most)
        said = said.splitlines()[0].split("; ")[-1]
    else:
        part.write_bytes(raw.read_bytes())
        said = "as it is"
    return part, units, said


def ticks_of(session):
    rows = sqlite3.connect(session).execute("SELECT trial, tick, tick_us, status FROM sample ORDER BY trial, tick")
    return {(trial, tick): (us, status) for trial, tick, us, status in rows}


def measure(asked, name):
    part, units, said = prepared(asked, name)
    least, flagged, over_once = {}, {}, 0
    for replay in range(REPLAYS):
        directory = asked.out / ("%s-%d" % (name, replay))
        run("rm", "-rf", directory)
        code, text = run(asked.pincer, "run", "sphere-pickup", "--object", part, "--size", asked.size / 1000, "--repetitions", 1,
                         "--seed", asked.seed, "--condition", "cld+force", "--sample-rate", 1000, "--no-report",
                         "--out", directory, preload=asked.clock)
        if code != 0:
            return "%-15s refused: %s" % (name, text.strip().splitlines()[0]), False
        for key, (us, status) in ticks_of(directory / "session.db").items():
            least[key] = min(us, least.get(key, us))
            over_once += us > LONGEST
            if status:
                flagged[key] = status
        if replay + 1 < REPLAYS:
            run("rm", "-rf", directory)
    times = sorted(least.values())
    over = sum(us > LONGEST for us in times)
    first = min(flagged, default=None)
    row = "%-15s %6d %9d %8.1f %8.1f %8.1f %6d %6d %8d  %s%s" % (
        name, triangles_of(part), len(times), times[len(times) // 2], times[int(0.999 * len(times))], times[-1], over,
        over_once, len(flagged), said, "  first flag: trial %d tick %d status %d" % (*first, flagged[first]) if first else "")
    return row, over == 0 and not flagged


def asked_for():
    known = FILES + list(MADE)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("pincer", "clock", "meshes", "out"):
        parser.add_argument(name, type=lambda word: pathlib.Path(word).resolve())
    parser.add_argument("parts", nargs="*", metavar="PART", help="of " + ", ".join(known) + " (default: all)")
    parser.add_argument("--size", type=float, default=50, help="[mm] (default 50)")
    parser.add_argument("--most", type=int, default=12000, help="triangles (default 12,000)")
    parser.add_argument("--seed", type=int, default=1, help="of the session (default 1)")
    asked = parser.parse_args()
    for part in asked.parts:
        if part not in known:
            parser.error("%s is no part; these are: %s" % (part, ", ".join(known)))
    asked.parts = asked.parts or known
    asked.out.mkdir(parents=True, exist_ok=True)
    return asked


def main():
    asked = asked_for()
    print("%-15s %6s %9s %8s %8s %8s %6s %6s %8s" % ("part", "tri.", "ticks", "median", "p99.9", "worst", "> 1 ms",
                                                     "once", "flagged"))
    kept = True
    for name in asked.parts:
        row, is_kept = measure(asked, name)
        kept = kept and is_kept
        print(row, flush=True)
    sys.exit(0 if kept else 1)


if __name__ == "__main__":
    main()
