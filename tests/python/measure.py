"""Prints the figures of docs/python.md: PYTHONPATH=build/python /usr/bin/python3 tests/python/measure.py

Times of the process on its processors, which what else runs on the machine hardly changes; and of the clock, which it does.
"""

import json
import os
import time

import pincer


def scene_of(name):
    """A built-in scene as a dict, its comments left out."""
    lines = pincer.load(name).text.splitlines()
    return json.loads("\n".join(line for line in lines if not line.lstrip().startswith("//")))


def least(repetitions, work):
    """Least time on the processors and on the clock [s]: what else runs only adds."""
    on_processors, on_clock = [], []
    for _ in range(repetitions):
        processors, clock = time.process_time(), time.perf_counter()
        work()
        on_processors.append(time.process_time() - processors)
        on_clock.append(time.perf_counter() - clock)
    return min(on_processors), min(on_clock)


def one_by_one(model, state, ticks):
    step = pincer.step
    for _ in range(ticks):
        step(model, state)


def main():
    model = pincer.load({**scene_of("s4_pinch"), "solver": {"sleep": False}})
    state, ticks = pincer.State(model), 20_000
    pincer.step(model, state, 1000)
    each, _ = least(25, lambda: one_by_one(model, state, ticks))
    together, _ = least(25, lambda: pincer.step(model, state, ticks))
    print(
        f"S4, awake, per tick: {1e6 * together / ticks:.2f} us of many in a call, {1e6 * each / ticks:.2f} us of a call each;"
    )
    print(
        f"  a call costs {1e6 * (each - together) / ticks:.2f} us, State.copy {1e6 * least(200, state.copy)[0]:.1f} us"
    )
    print(f"  steps per second, one thread: {ticks / each:,.0f} (nstep=1), {ticks / together:,.0f} (nstep={ticks})")
    rows, steps, work, clock = 64, 2000, {}, {}
    states = [pincer.State(model) for _ in range(rows)]
    for threads in (1, 2):
        with pincer.Rollout(threads) as pool:
            work[threads], clock[threads] = least(9, lambda: pool.rollout(model, states, nstep=steps))
        print(f"  rollout {rows} x {steps}, {threads} threads: {rows * steps / clock[threads]:,.0f} steps per second")
    processors = len(os.sched_getaffinity(0))
    print(
        f"  two threads: {clock[1] / clock[2]:.2f} x as fast by the clock; work for the same steps {work[2] / work[1]:.2f} x"
    )
    print(f"  ({processors} processors, load {os.getloadavg()[0]:.1f})")


main()
