"""Time and memory: a step's price, a million steps, threads, Ctrl-C."""

import os
import resource
import signal
import subprocess
import sys
import threading
import time
import tracemalloc

import pytest

import pincer


def measured_overhead(repetitions):
    """By how much step(nstep=1) takes longer than one of many ticks in a call [s], of S4: least of several."""
    model = pincer.load({**scene_of("s4_pinch"), "solver": {"sleep": False}})
    state = pincer.State(model)
    step, ticks, differences = pincer.step, 20000, []
    for _ in range(repetitions):
        start = time.process_time()
        for _ in range(ticks):
            step(model, state)
        between = time.process_time()
        step(model, state, ticks)
        differences.append((between - start - (time.process_time() - between)) / ticks)
    return min(differences)


def scene_of(name):
    import json

    return json.loads(
        "\n".join(line for line in pincer.load(name).text.splitlines() if not line.lstrip().startswith("//"))
    )


def test_a_step_costs_little_more_than_in_cpp():
    overhead = measured_overhead(7)
    print(f"step from Python costs {1e6 * overhead:.2f} us more")
    assert overhead < 2e-6  # 1 us on a quiet machine, measured by tests/python/measure.py; this one shares its cores


def flat_memory(steps):
    model = pincer.load("s4_pinch")
    state, inputs = pincer.State(model), pincer.Inputs(model)

    def some(count):
        for _ in range(count):
            report = pincer.step(model, state, inputs=inputs)
            view = state.position
            report.status, view[0, 0], state.body("sphere").position, state.finger("left").force, state.contacts
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    some(2000)
    tracemalloc.start()
    some(500)
    before, rss = tracemalloc.get_traced_memory()[0], some(1)
    tracemalloc.stop()
    later = some(steps)
    tracemalloc.start()
    some(500)
    after = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    return after - before, 1024 * (later - rss)


def test_memory_stays_flat():
    traced, resident = flat_memory(20_000)
    assert abs(traced) < 20_000 and resident < 2_000_000  # a leaked float per step would be 480 kB traced


@pytest.mark.long
def test_memory_stays_flat_over_a_million_steps():
    traced, resident = flat_memory(1_000_000)
    assert abs(traced) < 20_000 and resident < 2_000_000


def test_models_states_and_renderers_are_let_go():
    def some(count):
        for _ in range(count):
            model = pincer.load("pickup")
            state = pincer.State(model)
            pincer.step(model, state, 5)
            state.copy(), state.position
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    before = some(30)
    assert some(120) - before < 4000  # [kB]; a state with its scratch has some 200 kB


def test_threads_step_states_of_one_model_at_once():
    model = pincer.load("pickup")
    hashes = []

    def work():
        state = pincer.State(model)
        for _ in range(20):
            pincer.step(model, state, 10)
        hashes.append(state.hash())

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(hashes) == 4 and len(set(hashes)) == 1


def test_one_state_in_two_threads_is_refused(pinch):
    model = pincer.load({**scene_of("s4_pinch"), "solver": {"sleep": False}})
    state, errors = pincer.State(model), []
    thread = threading.Thread(target=lambda: pincer.step(model, state, 2_000_000))
    thread.start()
    time.sleep(0.1)
    try:
        pincer.step(model, state)
    except pincer.InputError as error:
        errors.append(str(error))
    thread.join()
    assert errors and "another thread" in errors[0]
    twice = pincer.State(pinch)
    with pytest.raises(pincer.InputError, match="twice"):
        pincer._core.Pool(1).run([pinch], [twice, twice], 1, None, None, None, None, 0)
    pincer.step(pinch, twice)  # it was given back


def test_control_c_ends_a_long_step_and_a_rollout():
    for call in ("pincer.step(model, state, 10**9)", "pool.run([model], [state], 10**9, None, None, None, None, 0)"):
        code = (
            "import pincer, signal\nmodel = pincer.load('mug')\nstate = pincer.State(model)\npool = pincer._core.Pool(2)\nprint('go', flush=True)\n"
            f"try:\n    {call}\nexcept KeyboardInterrupt:\n    print('ended', state.tick > 0)\n"
        )
        env = {**os.environ, "PYTHONPATH": os.path.dirname(os.path.dirname(pincer.__file__))}
        child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, env=env)
        assert child.stdout.readline() == "go\n"
        time.sleep(0.3)
        child.send_signal(signal.SIGINT)
        assert child.communicate(timeout=20)[0] == "ended True\n"
