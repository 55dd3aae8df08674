"""Rollouts: the same bits for any threads and chunks; outputs in place."""

import numpy as np
import pytest

import pincer


def controls_of(model, rows, steps, seed=1):
    random = np.random.default_rng(seed)
    first = np.concatenate([pincer.State(model).finger(k).target for k in range(model.nfinger)])
    return first + np.cumsum(random.normal(scale=2e-5, size=(rows, steps, model.ncontrol)), axis=1)


def test_threads_and_chunks_change_no_bit():
    model = pincer.load("pickup")
    start, controls = pincer.State(model), controls_of(pincer.load("pickup"), 12, 60)
    before = start.hash()
    wanted = pincer.rollout(model, start, controls, threads=1, final=True)
    assert start.hash() == before
    for threads, chunk in ((1, 5), (2, None), (2, 1), (7, 1), (7, 3), (7, 100)):
        got = pincer.rollout(model, start, controls, threads=threads, chunk_size=chunk, final=True)
        assert all(np.array_equal(a, b) for a, b in zip(got[:3], wanted[:3]))
        assert [s.hash() for s in got.final] == [s.hash() for s in wanted.final]
    half = pincer.rollout(model, start, controls[:, :25], threads=2, final=True)
    rest = pincer.rollout(model, half.final, controls[:, 25:], threads=2, final=True)
    assert np.array_equal(np.concatenate([half.state, rest.state], axis=1), wanted.state)
    assert [s.hash() for s in rest.final] == [s.hash() for s in wanted.final]


def test_a_row_is_what_steps_make():
    model = pincer.load("pickup")
    controls = controls_of(model, 2, 30)
    result = pincer.rollout(model, [pincer.State(model), pincer.State(model)], controls, threads=2, final=True)
    state, inputs = pincer.State(model), pincer.Inputs(model)
    for t in range(30):
        inputs.finger_position = controls[1, t].reshape(-1, 3)
        pincer.step(model, state, inputs=inputs)
        assert np.array_equal(
            result.state[1, t], np.concatenate([[state.time], state.position.ravel(), state.velocity.ravel()])
        )
        assert np.array_equal(result.sensordata[1, t], [state.measure(name) for name in model.sensors])
    assert state.hash() == result.final[1].hash()


def test_outputs_are_filled_in_place_and_shapes_checked(pinch):
    state, steps = np.zeros((3, 10, pinch.nstate)), 10
    status = np.full((3, steps), -1, dtype=np.int32)
    with pincer.Rollout(threads=2) as pool:
        result = pool.rollout(pinch, [pincer.State(pinch)] * 3, nstep=steps, out=(state, None, status))
        assert result.state is state and result.status is status and not status.any() and state[:, -1, 0].min() > 0
        for wrong in (
            dict(nstep=0),
            dict(),
            dict(controls=np.zeros((3, 4, 5))),
            dict(controls=np.zeros((2, 4, 6))),
            dict(nstep=10, out=(state[:, ::-1], None, None)),
            dict(nstep=10, out=(state.astype(np.float32), None, None)),
        ):
            with pytest.raises(pincer.InputError):
                pool.rollout(pinch, [pincer.State(pinch)] * 3, **wrong)
    with pytest.raises(pincer.InputError, match="closed"):
        pool.rollout(pinch, pincer.State(pinch), nstep=1)
    with pytest.raises(pincer.InputError, match="threads = 0"):
        pincer.Rollout(threads=0)


def test_each_row_may_have_a_model_of_its_own(pinch):
    models = []
    for mass in (0.05, 0.1, 0.3):
        import json

        scene = json.loads("\n".join(line for line in pinch.text.splitlines() if not line.lstrip().startswith("//")))
        scene["bodies"][0]["mass"] = mass
        models.append(pincer.load(scene))
    result = pincer.rollout(models, [pincer.State(m) for m in models], nstep=50, threads=2)
    heights = result.state[:, -1, 3]
    assert (
        heights[2] < heights[1] - 1e-4 and abs(heights[0] - heights[1]) < 1e-9
    )  # 0.3 kg are beyond the friction limit
    with pytest.raises(pincer.InputError, match="isn't one of its model"):
        pincer.rollout(models, [pincer.State(models[0])] * 3, nstep=5)
    with pytest.raises(pincer.InputError, match="differ in their numbers"):
        pincer.rollout([models[0], models[1], pincer.load("mug")], [pincer.State(m) for m in models], nstep=5)


def test_a_rollout_is_kept_as_robomimic_has_it(pinch, tmp_path):
    h5py = pytest.importorskip("h5py")
    result = pincer.rollout(pinch, [pincer.State(pinch)] * 2, nstep=5)
    pincer.save_rollout(str(tmp_path / "a.h5"), pinch, result)
    with h5py.File(tmp_path / "a.h5") as file:
        assert file["data"].attrs["total"] == 10 and sorted(file["data"]) == ["demo_0", "demo_1"]
        assert np.array_equal(file["data/demo_1/states"], result.state[1])
        assert np.array_equal(file["data/demo_0/obs/sphere.p_z"], result.sensordata[0, :, 0])
        assert file["data/demo_0/dones"][-1] and not file["data/demo_0/dones"][0]
