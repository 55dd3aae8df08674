"""Scripted policies: what a learner may imitate or beat. Each is a function of an observation that returns an action."""

import numpy as np

from pincer.env.base import SPEED, TICKS

_STEP = SPEED * TICKS * 1e-3  # that a finger goes at action 1 [m]


def _towards(observation, targets):
    """The action that takes the devices nearest to `targets` (thumb, index; 3 numbers each)."""
    sensors = observation["observation"]
    devices = np.concatenate([sensors[13:16], sensors[19:22]])
    return np.clip((np.concatenate(targets) - devices) / _STEP, -1, 1).astype(np.float32)


def pinch_lift(squeeze=0.004):
    """Closes on the cube until it presses, then carries it to the goal. squeeze: by which devices go past the cube's sides [m]."""
    reach = 0.02 + 0.008 - squeeze

    def act(observation):
        cube, goal = observation["achieved_goal"], observation["desired_goal"]
        presses = np.abs(observation["observation"][[16, 22]]).min() > 0.8 * 1500 * squeeze
        middle = cube + np.clip(goal - cube, -0.006, 0.006) if presses or cube[2] > 0.021 else np.array([0, 0, 0.02])
        # What the springs sag by is made up for by aiming that much past the goal.
        return _towards(observation, [middle + [-reach, 0, 0], middle + [reach, 0, 0]])

    return act


def _turn_between(radius, squeeze):
    """Moves the fingertips past each other, along y, until what is between them has turned by the goal."""
    arm = radius + 0.008

    def act(observation):
        turned, goal = observation["achieved_goal"][0], observation["desired_goal"][0]
        sensors = observation["observation"]
        thumb_y = sensors[14]
        # Rolling on two tips that don't turn: angle = (R + r)/R 2 asin(y/(R + r)) for the knob, half of it per finger's way round.
        ahead = np.clip(goal - turned, -0.1, 0.1) * radius
        way = np.clip(thumb_y - 0.5 * ahead, -0.8 * arm, 0.8 * arm)
        x = np.sqrt(arm**2 - way**2) - squeeze
        return _towards(observation, [np.array([-x, way, 0.1]), np.array([x, -way, 0.1])])

    return act


def in_hand_roll():
    return _turn_between(0.02, 0.002)


def cylinder_turn():
    return _turn_between(0.02, 0.003)


def peg_in_hole():
    """Lowers the peg into the hole, then lets go of it."""

    def act(observation):
        peg = observation["achieved_goal"]
        sensors = observation["observation"]
        height = 0.5 * (sensors[15] + sensors[21])
        if peg[2] > 0.052 and height > 0.06:
            return _towards(observation, [np.array([-0.014, 0, height - _STEP]), np.array([0.014, 0, height - _STEP])])
        return _towards(observation, [np.array([-0.03, 0, height]), np.array([0.03, 0, height])])

    return act


SCRIPTED = {
    "PincerPinchLift-v0": pinch_lift,
    "PincerInHandRoll-v0": in_hand_roll,
    "PincerPegInHole-v0": peg_in_hole,
    "PincerCylinderTurn-v0": cylinder_turn,
}
