"""The four tasks: a scene each, what is achieved, and what is to be achieved.

A task has two fingers that are moved in space; nothing else is asked of it by base.py.
"""

import numpy as np


def _finger(name, position, **more):
    return {"name": name, "radius": 0.008, "stiffness": 1500, "damping": 8, "position": position, **more}


def _quantities(body):
    """What an observation is made of, in its order: pose and velocity of the body, then places and forces of the fingers."""
    names = [
        f"{body}.{part}"
        for part in ("p_x", "p_y", "p_z", "q_w", "q_x", "q_y", "q_z", "v_x", "v_y", "v_z", "w_x", "w_y", "w_z")
    ]
    for finger in ("thumb", "index"):
        names += [f"{finger}.{part}" for part in ("target_x", "target_y", "target_z", "f_x", "f_y", "f_z")]
    return names


class Task:
    """What the tasks share: one body that matters, sensors, success within a tolerance."""

    body = ""
    goal_size = 3
    tolerance = 0.005  # of success, in the goal's unit
    seconds = 4.0  # until an episode is cut off

    def scene(self):
        """The scene as a dict."""
        raise NotImplementedError

    def achieved(self, sensors):
        """From rows of sensors (..., nsensor) the rows of what is achieved (..., goal_size)."""
        raise NotImplementedError

    def desired(self, random):
        """A goal, drawn by a numpy Generator."""
        raise NotImplementedError

    def lost(self, sensors):
        """True where the task can't be done any more: the body has left the fingers' reach."""
        raise NotImplementedError

    def distance(self, achieved, desired):
        return np.linalg.norm(np.asarray(achieved, dtype=np.float64) - np.asarray(desired, dtype=np.float64), axis=-1)

    def _scene(self, bodies, fingers, **more):
        return {
            "version": 1,
            "duration": 3600,
            "bodies": bodies,
            "fingers": fingers,
            "record": {"quantities": _quantities(self.body)},
            **more,
        }


class PinchLift(Task):
    """A cube on a floor is pinched, lifted, and held at a place in the air [m]."""

    body = "cube"

    def scene(self):
        return self._scene(
            [
                {"name": "floor", "shape": {"type": "half_space"}, "material": {"mu_s": 0.6}},
                {
                    "name": "cube",
                    "shape": {"type": "box", "size": [0.04, 0.04, 0.04]},
                    "mass": 0.1,
                    "position": [0, 0, 0.02],
                    "material": {"mu_s": 0.8, "torsion_radius": 0.004},
                },
            ],
            [_finger("thumb", [-0.035, 0, 0.02]), _finger("index", [0.035, 0, 0.02])],
        )

    def achieved(self, sensors):
        return sensors[..., 0:3]

    def desired(self, random):
        return np.array([random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), random.uniform(0.05, 0.1)])

    def lost(self, sensors):
        return np.any(np.abs(sensors[..., 0:2]) > 0.2, axis=-1)


class InHandRoll(Task):
    """A ball is rolled about z between two fingertips, to an angle [rad], and stays between them."""

    body = "ball"
    goal_size = 1
    tolerance = 0.02

    def scene(self):
        return self._scene(
            [
                {
                    "name": "ball",
                    "shape": {"type": "sphere", "radius": 0.02},
                    "mass": 0.05,
                    "position": [0, 0, 0.1],
                    "material": {"mu_s": 0.8, "torsion_radius": 0.004},
                }
            ],
            [_finger("thumb", [-0.026, 0, 0.1]), _finger("index", [0.026, 0, 0.1])],
            gravity=[0, 0, 0],
        )

    def achieved(self, sensors):
        return _turn(sensors)

    def desired(self, random):
        return np.array([random.choice([-1, 1]) * random.uniform(0.1, 0.4)])

    def lost(self, sensors):
        return np.any(np.abs(sensors[..., 0:3] - np.array([0, 0, 0.1])) > 0.05, axis=-1)


class PegInHole(Task):
    """A round peg, held over a square hole with 0.5 mm of play, is put to its bottom: the place of its middle [m]."""

    body = "peg"
    tolerance = 0.002

    def scene(self):
        walls = [
            ("west", [0.02, 0.061, 0.04], [-0.0205, 0, 0.02]),
            ("east", [0.02, 0.061, 0.04], [0.0205, 0, 0.02]),
            ("south", [0.021, 0.02, 0.04], [0, -0.0205, 0.02]),
            ("north", [0.021, 0.02, 0.04], [0, 0.0205, 0.02]),
        ]
        bodies = [{"name": "floor", "shape": {"type": "half_space"}, "material": {"mu_s": 0.4}}]
        bodies += [
            {
                "name": name,
                "shape": {"type": "box", "size": size},
                "static": True,
                "position": place,
                "material": {"mu_s": 0.1},
            }
            for name, size, place in walls
        ]
        bodies.append(
            {
                "name": "peg",
                "shape": {"type": "cylinder", "radius": 0.01, "length": 0.06},
                "mass": 0.06,
                "position": [0, 0, 0.08],
                "material": {"mu_s": 0.6, "torsion_radius": 0.003},
            }
        )
        return self._scene(bodies, [_finger("thumb", [-0.016, 0, 0.09]), _finger("index", [0.016, 0, 0.09])])

    def achieved(self, sensors):
        return sensors[..., 0:3]

    def desired(self, random):
        return np.array([0, 0, 0.03])  # the bottom is where it is

    def lost(self, sensors):
        return np.any(np.abs(sensors[..., 0:2]) > 0.1, axis=-1)


class CylinderTurn(Task):
    """A knob on a damped pivot is turned to an angle [rad]."""

    body = "knob"
    goal_size = 1
    tolerance = 0.02

    def scene(self):
        return self._scene(
            [
                {
                    "name": "knob",
                    "shape": {"type": "cylinder", "radius": 0.02, "length": 0.03},
                    "mass": 0.1,
                    "position": [0, 0, 0.1],
                    "material": {"mu_s": 0.8},
                }
            ],
            [_finger("thumb", [-0.022, 0, 0.1]), _finger("index", [0.022, 0, 0.1])],
            joints=[{"type": "pivot", "body": "knob", "axis": [0, 0, 1], "damping": 0.002}],
        )

    def achieved(self, sensors):
        return _turn(sensors)

    def desired(self, random):
        return np.array([random.choice([-1, 1]) * random.uniform(0.2, 0.8)])

    def lost(self, sensors):
        return np.zeros(sensors.shape[:-1], dtype=bool)  # the pivot keeps it


def _turn(sensors):
    """Angle about z of the body's quaternion, -pi .. pi [rad]."""
    w, x, y, z = (sensors[..., k] for k in range(3, 7))
    return np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))[..., None]


TASKS = {
    "PincerPinchLift-v0": PinchLift,
    "PincerInHandRoll-v0": InHandRoll,
    "PincerPegInHole-v0": PegInHole,
    "PincerCylinderTurn-v0": CylinderTurn,
}
