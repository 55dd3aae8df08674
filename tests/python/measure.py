"""Prints the figures of docs/python.md: PYTHONPATH=build/python /usr/bin/python3 tests/python/measure.py"""

import json
import os
import statistics
import time

import pincer


def scene_of(name):
    """A built-in scene as a dict, its comments left out."""
    return json.loads(
        "\n".join(line for line in pincer.load(name).text.splitlines() if not line.lstrip().startswith("//"))
    )


def best_of(repetitions, work):
    """Least time of several [s]: what else runs on the machine only adds."""
    times = []
    for _ in range(repetitions):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times), statistics.median(times)


def main():
    model = pincer.load({**scene_of("s4_pinch"), "solver": {"sleep": False}})
    state, ticks = pincer.State(model), 50_000
    pincer.step(model, state, 1000)

    def one_by_one():
        step = pincer.step
        for _ in range(ticks):
            step(model, state)

    each, _ = best_of(7, one_by_one)
    together, _ = best_of(7, lambda: pincer.step(model, state, ticks))
    print(
        f"S4, awake: a tick of many in a call {1e6 * together / ticks:.2f} us, a call each {1e6 * each / ticks:.2f} us, "
        f"so a call costs {1e6 * (each - together) / ticks:.2f} us"
    )
    print(
        f"  steps per second from Python, one thread: {ticks / each:,.0f} (nstep=1), {ticks / together:,.0f} (nstep={ticks})"
    )
    rows, steps = 64, 5000
    states = [pincer.State(model) for _ in range(rows)]
    rates = {}
    for threads in (1, 2):
        with pincer.Rollout(threads) as pool:
            least, _ = best_of(5, lambda: pool.rollout(model, states, nstep=steps))
        rates[threads] = rows * steps / least
        print(f"  rollout {rows} x {steps}, {threads} threads: {rates[threads]:,.0f} steps per second")
    print(
        f"  two threads do {rates[2] / rates[1]:.2f} x the work of one ({len(os.sched_getaffinity(0))} processors; load {os.getloadavg()[0]:.1f})"
    )
    least, _ = best_of(3, lambda: pincer.load("s4_pinch"))
    snapshot, _ = best_of(100, state.copy)
    print(f"  load {1e6 * least:.0f} us, State.copy {1e6 * snapshot:.1f} us")


main()
