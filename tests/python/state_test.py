"""States: values with live views, the same bits as the program's, nothing that bites."""

import copy
import gc
import json
import pickle
import subprocess

import numpy as np
import pytest

import pincer

SCENES = [
    "s1_tumbling_box",
    "s2_slide_to_roll",
    "s3_incline_stick",
    "s3_incline_slide",
    "s4_pinch",
    "s4_pinch_098",
    "s5_lift",
    "s7_bounce",
    "pickup",
    "roll_between_fingers",
    "turn_ball",
    "turn_knob",
    "slide_plate_out",
    "pull_card",
    "stacking",
    "peg_in_hole",
    "egg",
    "pen_spin",
    "two_jaw_gripper",
    "mug",
    "conveyed_ball",
    "pushed_cube",
]


@pytest.mark.parametrize("name", SCENES)
def test_the_bits_are_those_of_the_program(name, program):
    model = pincer.load(name)
    ticks = min(model.ticks, 600)
    duration = ticks * model.tick
    said = subprocess.run(
        [program, "sim", name, "--json", "--duration", repr(round(duration, 9))], stdout=subprocess.PIPE, check=False
    )
    state = pincer.State(model)
    pincer.step(model, state, nstep=ticks)
    result = json.loads(said.stdout)
    assert state.hash() == result["state_hash"]
    assert result["bodies"][0]["p_WB"] == state.position[0, :3].tolist()
    one_by_one = pincer.State(model)
    for _ in range(ticks):
        pincer.step(model, one_by_one)
    assert one_by_one.hash() == state.hash()


def test_a_view_follows_its_state_and_outlives_it(pinch):
    state = pincer.State(pinch)
    position = state.position
    assert position.shape == (1, 7) and position.base is not None and not position.flags.writeable
    row = state.body("sphere").position
    state.body("sphere").position = [0, 0, 0.2]
    assert position[0, 2] == 0.2 and row[2] == 0.2
    address = position.__array_interface__["data"][0]
    pincer.step(pinch, state, nstep=50)
    assert state.position.__array_interface__["data"][0] == address
    last = position.copy()
    del state
    gc.collect()
    assert np.array_equal(position, last) and row[2] == last[0, 2]
    with pytest.raises(ValueError):
        position[0, 0] = 1


def test_a_copy_is_a_snapshot(pinch):
    state = pincer.State(pinch)
    pincer.step(pinch, state, nstep=20)
    snapshot, before = state.copy(), state.hash()
    forces = state.contacts["force"].copy()
    pincer.step(pinch, state, nstep=30)
    assert snapshot.hash() == before != state.hash()
    assert np.array_equal(snapshot.contacts["force"], forces)
    after = state.hash()
    view = state.position
    state.restore(snapshot)
    assert state.hash() == before and view[0, 2] == snapshot.position[0, 2]
    pincer.step(pinch, state, nstep=30)
    assert state.hash() == after
    for made in (copy.copy(snapshot), copy.deepcopy(snapshot)):
        assert made.hash() == before
    state.reset()
    assert state.hash() == pincer.State(pinch).hash()


@pytest.mark.parametrize("name", ["s4_pinch", "pickup", "two_jaw_gripper", "mug", "turn_ball"])
def test_a_pickled_state_goes_on_with_the_same_bits(name):
    model = pincer.load(name)
    state = pincer.State(model)
    pincer.step(model, state, nstep=200)
    back = pickle.loads(pickle.dumps(state))
    assert back.hash() == state.hash() and back.model.bodies == model.bodies
    pincer.step(model, state, nstep=200)
    pincer.step(back.model, back, nstep=200)
    assert back.hash() == state.hash()


def test_a_pickle_of_another_build_is_refused(pinch):
    state = pincer.State(pinch)
    model, data = state.__getstate__()
    for changed, why in (
        (data.replace(b"pincer state", b"pincer stale", 1), "another build"),
        (data[:-9], "cut off"),
        (data + b"x", "longer"),
    ):
        with pytest.raises(pincer.InputError, match=why):
            pincer.State.__new__(pincer.State).__setstate__((model, changed))
    with pytest.raises(pincer.InputError, match="another model"):
        pincer.State.__new__(pincer.State).__setstate__((pincer.load("mug"), data))


def test_inputs_move_fingers_forces_and_gravity(pinch):
    state, inputs = pincer.State(pinch), pincer.Inputs(pinch)
    assert np.isnan(inputs.finger_position).all() and np.isnan(inputs.gravity).all()
    pincer.step(pinch, state, inputs=inputs)
    untold = pincer.State(pinch)
    pincer.step(pinch, untold)
    assert state.hash() == untold.hash()
    inputs.gravity = [0, 0, 0]
    free = pincer.load(
        {"version": 1, "duration": 1, "bodies": [{"name": "b", "shape": {"type": "sphere", "radius": 0.01}, "mass": 2}]}
    )
    state, inputs = pincer.State(free), pincer.Inputs(free)
    inputs.gravity = 0
    inputs.body_force[0, 0] = 4  # a = 2 m/s^2, exact for a constant force
    pincer.step(free, state, nstep=1000, inputs=inputs)
    assert abs(state.velocity[0, 0] - 2) < 1e-12 and state.velocity[0, 2] == 0
    assert abs(state.position[0, 0] - 1) < 1e-12
    view = inputs.body_force
    inputs.clear()
    assert not view.any() and np.isnan(inputs.gravity).all()


def test_a_target_is_reached_evenly_and_held(pinch):
    model = pincer.load("roll_between_fingers")
    state = pincer.State(model)
    thumb = state.finger("thumb")
    start = thumb.target.copy()
    thumb.target = start + [0, 0.001, 0]
    pincer.step(model, state, nstep=10)
    assert np.allclose(thumb.target, start + [0, 0.001, 0], rtol=0, atol=1e-17)
    half = pincer.State(model)
    half.finger("thumb").target = start + [0, 0.0005, 0]
    pincer.step(model, half, nstep=5)
    assert abs(half.finger("thumb").velocity[1] - thumb.velocity[1]) < 1e-9  # locked along y: it goes as its device
    for _ in range(5):
        pincer.step(model, state)
    assert np.array_equal(thumb.target, start + [0, 0.001, 0]) and thumb.velocity[1] == 0
    thumb.target = None
    pincer.step(model, state)
    assert thumb.target[1] == 0


def test_contacts_balance_the_weight(pinch):
    state = pincer.State(pinch)
    pincer.step(pinch, state, nstep=2000)
    contacts = state.contacts
    assert contacts.dtype.names[0] == "id" and len(contacts) == 2 and (contacts["body"] == 0).all()
    assert sorted(contacts["finger"]) == [0, 1] and contacts["pushes"].all() and not contacts["slips"].any()
    assert np.allclose(-contacts["force"].sum(axis=0), [0, 0, 0.981], atol=1e-9)
    finger = state.finger("left")
    assert finger.touching and not finger.slips and abs(finger.normal_force - 2) < 1e-9 and finger.body == 0
    assert abs(state.measure("left.normal_force") - 2) < 1e-9


def test_what_is_wrong_is_said(pinch, tmp_path, program):
    with pytest.raises(pincer.InputError, match='Did you mean "s4_pinch"'):
        pincer.load("s4_pinsh")
    scene = tmp_path / "a.json"
    scene.write_text(
        '{"version": 1, "duration": 1,\n "bodies": [{"mass": -1, "shape": {"type": "sphere", "radius": 1}}]}'
    )
    with pytest.raises(pincer.InputError) as error:
        pincer.load(scene)
    said = subprocess.run([program, "sim", str(scene)], stderr=subprocess.PIPE, text=True, check=False).stderr
    assert str(error.value) in said
    state = pincer.State(pinch)
    with pytest.raises(pincer.InputError, match="isn't in this scene"):
        state.body("spere")
    with pytest.raises(pincer.InputError, match="out of range"):
        state.finger(2)
    with pytest.raises(pincer.InputError, match="another model"):
        pincer.step(pincer.load("s4_pinch"), state)
    with pytest.raises(pincer.InputError, match="nstep = 0"):
        pincer.step(pinch, state, nstep=0)
    with pytest.raises(pincer.InputError, match="no rotation"):
        state.body("sphere").position = [0, 0, 0, 0, 0, 0, 0]
    with pytest.raises(pincer.InputError, match="isn't finite"):
        state.finger("left").target = [0, float("nan"), 0]
    with pytest.raises(pincer.InputError, match="isn't finite"):
        pincer.load({"version": 1, "duration": float("inf"), "bodies": []})
    for thing in (state, pinch, pincer.Inputs(pinch), state.body("sphere"), state.finger("left")):
        with pytest.raises(AttributeError):
            thing.no_such_thing = 1


def test_a_broken_state_ends_the_steps_and_says_so(pinch):
    state, inputs = pincer.State(pinch), pincer.Inputs(pinch)
    inputs.body_force[0] = 1e300
    report = pincer.step(pinch, state, nstep=100, inputs=inputs)
    assert pincer.Status.STATE_NOT_FINITE in report.status and report.ticks < 100 and not report.ok
    assert report.remedies and list(report.remedies) == pincer.remedies(report.status)
    assert pincer.step(pinch, pincer.State(pinch)).status == pincer.Status.OK


def test_random_states_and_inputs_never_crash():
    """Whatever a script writes into a state: an InputError, a flag, or a state that goes on."""
    random = np.random.default_rng(5)
    model = pincer.load("pickup")
    for _ in range(40):
        state, inputs = pincer.State(model), pincer.Inputs(model)
        for table in (
            inputs.finger_position,
            inputs.finger_force,
            inputs.body_force,
            inputs.finger_rotation,
            inputs.finger_velocity,
        ):
            if table.size and random.random() < 0.5:
                table.flat[random.integers(table.size)] = random.choice(
                    [np.inf, -np.inf, np.nan, 1e308, 1e-320, -3.0, 0.1]
                )
        try:
            state.body(int(random.integers(model.nbody))).position = random.normal(size=7) * 10.0 ** random.integers(
                -3, 4
            )
        except pincer.InputError:
            pass
        report = pincer.step(model, state, nstep=20, inputs=inputs)
        assert report.ticks == 20 or pincer.Status.STATE_NOT_FINITE in report.status
