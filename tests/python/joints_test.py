"""Joints, drives and robots' files: readable, settable, told what to do; the same bits as scenes that say so."""

import json
import math
import pickle
import subprocess

import numpy as np
import pytest

import pincer
from conftest import SOURCE

ROBOT = str(SOURCE / "tasks/scenes/files/gripper.xml")
GRIP = str(SOURCE / "tasks/scenes/files/robot_grip.json")
JOINTED = ["cabinet_door", "jaws_gripper", "three_finger_hand", "cylinder_on_pivot", "worm_clamp", GRIP, ROBOT]


def chain(links, rng):
    """Boxes that hang on each other by pivots and sliders in any direction, from the world."""
    bodies, joints, place = [], [], np.array([0.0, 0.0, 1.0])
    for k in range(links):
        place = place + rng.normal(scale=0.1, size=3)
        bodies.append(
            {
                "name": f"b{k}",
                "shape": {"type": "box", "size": rng.uniform(0.02, 0.1, 3)},
                "mass": rng.uniform(0.1, 1),
                "position": place,
                "rotation": rng.uniform(-1, 1, 3),
            }
        )
        joint = {"name": f"j{k}", "type": rng.choice(["pivot", "slider"]), "body": f"b{k}", "point": place + 0.03}
        joint["axis"] = rng.normal(size=3)
        if k:
            joint["to"] = f"b{k - 1}"
        joints.append(joint)
    return {"version": 1, "duration": 1, "bodies": bodies, "joints": joints}


def settable(model):
    """Names of the joints that a caller may place: none that follows another or is one of a loop."""
    names = []
    for name in model.joints:
        try:
            joint = pincer.State(model).joint(name)
            joint.velocity = joint.velocity
            names.append(name)
        except pincer.InputError as error:
            assert "follows" in str(error) or "loop" in str(error)
    return names


@pytest.mark.parametrize("scene", JOINTED, ids=lambda s: s.split("/")[-1])
def test_joints_are_read_as_quantities_are(scene):
    model = pincer.load(scene)
    state = pincer.State(model)
    pincer.step(model, state, nstep=150)
    assert len(model.joints) == model.njoint == len(state.joint_position) > 0
    for k, name in enumerate(model.joints):
        assert state.joint_position[k] == state.joint(name).position == state.measure(f"{name}.position")
        assert state.joint_velocity[k] == state.joint(k).velocity == state.measure(f"{name}.velocity")


@pytest.mark.parametrize("scene", JOINTED, ids=lambda s: s.split("/")[-1])
def test_a_joint_that_is_set_is_there_and_stays_there(scene):
    model = pincer.load(scene)
    for name in settable(model):
        state = pincer.State(model)
        joint = state.joint(name)
        before, rate = joint.position, 0.25
        joint.velocity = rate
        joint.position = before + 1e-4 if joint.position < 0.01 else before - 1e-4
        set_to = joint.position
        assert abs(set_to - before) > 0.99e-4 and abs(joint.velocity - rate) < 1e-12
        pincer.step(model, state)  # no joint is torn apart, whatever pushes meanwhile
        assert abs(joint.position - set_to) < 2 * rate * model.tick


@pytest.mark.parametrize("seed", range(12))
def test_links_go_along_as_the_coordinates_say(seed):
    """A joint is turned by q about, or moved by q along its axis: all beyond it goes by that motion, all before it stays."""
    rng = np.random.default_rng(seed)
    scene = chain(int(rng.integers(1, 7)), rng)
    model = pincer.load(scene)
    state = pincer.State(model)
    for k in rng.permutation(model.njoint):
        at = pincer.State(model)
        joint, q = at.joint(int(k)), rng.uniform(-0.5, 0.5)
        axis = np.array(scene["joints"][k]["axis"]) / np.linalg.norm(scene["joints"][k]["axis"])
        origin = np.array(scene["joints"][k]["point"])
        pivots = scene["joints"][k]["type"] == "pivot"
        before = at.position.copy()
        joint.position = q
        for b in range(model.nbody):
            wanted = before[b, :3]
            if b >= k and pivots:
                r = wanted - origin
                along = axis * (axis @ r)
                wanted = origin + along + math.cos(q) * (r - along) + math.sin(q) * np.cross(axis, r)
            elif b >= k:
                wanted = wanted + q * axis
            assert np.allclose(at.position[b, :3], wanted, rtol=0, atol=1e-12), (b, k, pivots)
        joint.velocity = 0.7  # what hangs on it moves as one rigid body
        for b in range(model.nbody):
            v, w = at.velocity[b, :3], at.velocity[b, 3:]
            moves = 0.7 * axis if b >= k else 0 * axis
            assert np.allclose(w, moves if pivots else 0, rtol=0, atol=1e-12)
            assert np.allclose(v, np.cross(moves, at.position[b, :3] - origin) if pivots else moves, rtol=0, atol=1e-12)
    assert state.hash() == pincer.State(model).hash()


def test_a_pendulum_swings_from_where_it_is_set():
    """Energy: (I + m l^2) w^2 / 2 = m g l (1 - cos q), for any start; and it is the same motion as of a scene that starts so."""
    for q in (0.1, 1.0, -2.0, 3.0):
        scene = {
            "version": 1,
            "duration": 1,
            "bodies": [
                {
                    "name": "bob",
                    "shape": {"type": "box", "size": [0.02, 0.02, 0.3]},
                    "mass": 0.4,
                    "position": [0, 0, -0.15],
                }
            ],
            "joints": [{"name": "pin", "type": "pivot", "body": "bob", "point": [0, 0, 0], "axis": [1, 0, 0]}],
        }
        model = pincer.load(scene)
        state = pincer.State(model)
        state.joint("pin").position = q
        inertia = 0.4 * (0.02**2 + 0.3**2) / 12 + 0.4 * 0.15**2
        height = -0.15 * math.cos(q)
        for _ in range(1000):
            pincer.step(model, state)
            angle, rate = state.joint("pin").position, state.joint("pin").velocity
            energy = 0.5 * inertia * rate**2 + 0.4 * 9.81 * -0.15 * math.cos(angle)
            assert abs(energy - 0.4 * 9.81 * height) < 2e-5 * 0.4 * 9.81 * 0.3  # second order in the tick
            assert abs(state.position[0, 2] + 0.15 * math.cos(angle)) < 1e-12


def test_what_cannot_be_placed_is_said():
    model = pincer.load(GRIP)
    state = pincer.State(model)
    before = state.hash()
    left, right = state.joint("hand_left_slide"), state.joint("hand_right_slide")
    for act, why in (
        (lambda: setattr(right, "position", 0.02), "follows joint"),
        (lambda: setattr(left, "position", 0.05), r"out of range \[0, 0.04\]"),
        (lambda: setattr(left, "position", float("nan")), "isn't finite"),
        (lambda: setattr(left, "velocity", float("inf")), "isn't finite"),
        (lambda: setattr(state.body("hand_left"), "position", [0, 0, 0]), "Set its joints"),
        (lambda: setattr(state.body("hand_left"), "velocity", [0] * 6), "Set its joints"),
        (lambda: setattr(state.body("hand_palm"), "position", [0, 0, 0]), "carries a tree"),
        (lambda: state.joint("hand_left_slid"), "Did you mean"),
        (lambda: state.joint(2), "out of range"),
    ):
        with pytest.raises(pincer.InputError, match=why):
            act()
        assert state.hash() == before
    with pytest.raises(ValueError):
        state.joint_position[0] = 1
    left.position = left.position  # where the engine has it is never out of range


def grip_told(value):
    scene = {
        "version": 1,
        "duration": 0.5,
        "combination": "maximum",
        "robots": [{"name": "hand", "file": "gripper.xml", "keyframe": "open", "drives": {"grip": value}}],
        "bodies": [
            {
                "name": "cube",
                "shape": {"type": "box", "size": [0.04, 0.04, 0.04]},
                "mass": 0.1,
                "position": [0, 0, 0.208],
            }
        ],
    }
    return pincer.load(scene, name=GRIP)


def test_drives_are_told_by_inputs_as_by_the_scene():
    said, model = grip_told(37), grip_told(200)
    assert model.drives == ["hand_grip"] and model.ndrive == 1
    a, b, inputs = pincer.State(said), pincer.State(model), pincer.Inputs(model)
    assert np.isnan(inputs.drive_target).all()
    inputs.drive_target[model.drives.index("hand_grip")] = 37
    pincer.step(said, a, nstep=300)
    pincer.step(model, b, nstep=300, inputs=inputs)
    assert a.hash() == b.hash()
    inputs.clear()
    untold, without = pincer.State(model), pincer.State(model)
    pincer.step(model, untold, nstep=50, inputs=inputs)
    pincer.step(model, without, nstep=50)
    assert untold.hash() == without.hash() != b.hash()
    inputs.drive_target = float("inf")
    assert pincer.Status.INPUT_NOT_FINITE in pincer.step(model, untold, inputs=inputs).status


def test_rollouts_tell_drives_and_keep_joints():
    model = pincer.load(GRIP)
    steps, rows = 60, 5
    controls = np.full((rows, steps, model.ncontrol), np.nan)
    assert model.ncontrol == 3 * model.nfinger + model.ndrive == 1
    controls[:, :, 0] = np.linspace(0, 255, rows)[:, None]
    controls[0] = np.nan
    wanted = pincer.rollout(model, pincer.State(model), controls, threads=1)
    for threads, chunk in ((2, None), (7, 1), (7, 100)):
        got = pincer.rollout(model, pincer.State(model), controls, threads=threads, chunk_size=chunk)
        assert all(np.array_equal(a, b) for a, b in zip(got[:3], wanted[:3]))
    for row in range(rows):
        state, inputs = pincer.State(model), pincer.Inputs(model)
        for t in range(steps):
            inputs.drive_target = controls[row, t]
            pincer.step(model, state, inputs=inputs)
            parts = [
                [state.time],
                state.position.ravel(),
                state.velocity.ravel(),
                state.joint_position,
                state.joint_velocity,
            ]
            assert np.array_equal(wanted.state[row, t], np.concatenate(parts))
    assert len(set(wanted.state[:, -1, -3].tolist())) == rows  # each told something else


def test_a_robots_file_is_a_model(program, tmp_path):
    model = pincer.load(ROBOT)
    assert model.joints == ["left_slide", "right_slide"] and model.drives == ["grip"] and "left" in model.bodies
    assert isinstance(model.remarks, str)
    state = pincer.State(model)
    pincer.step(model, state, nstep=model.ticks)
    said = subprocess.run([program, "sim", ROBOT, "--json"], stdout=subprocess.PIPE, check=True).stdout
    assert json.loads(said)["state_hash"] == state.hash()
    back = pickle.loads(pickle.dumps(state))
    pincer.step(back.model, back, nstep=100)
    pincer.step(model, state, nstep=100)
    assert back.hash() == state.hash()
    broken = tmp_path / "broken.xml"
    broken.write_text("<mujoco><worldbody><body><joint type='screw'/></body></worldbody></mujoco>")
    with pytest.raises(pincer.InputError, match="broken.xml:1"):
        pincer.load(broken)
