"""One environment, and many side by side, over the same core: both step the same states in the same way, to the bit.

An action is the velocity of both fingertips: 6 numbers from -1 to 1, in units of 0.15 m/s, held for 10 ticks (10 ms).
An observation is a dict, as goal environments have it: observation (25 numbers, tasks.py), achieved_goal, desired_goal.
"""

import numpy as np

import pincer
from pincer import _core
from pincer.env import spaces
from pincer.env.tasks import TASKS

SPEED = 0.15  # of a fingertip at action 1 [m/s]
TICKS = 10  # of 1 ms, that an action is held

try:
    import gymnasium

    _EnvBase, _VectorBase = gymnasium.Env, gymnasium.vector.VectorEnv
except ImportError:
    gymnasium = None
    _EnvBase = _VectorBase = object


def task_named(name):
    """The task of an environment's name; raises InputError with the names that there are."""
    if name not in TASKS:
        raise pincer.InputError(f'there is no environment "{name}". There are {", ".join(TASKS)}.')
    return TASKS[name]()


def generator(seed):
    """As gymnasium.utils.seeding.np_random: a Generator and the seed that it was made with."""
    if seed is not None and not (isinstance(seed, (int, np.integer)) and seed >= 0):
        raise pincer.InputError(f"seed = {seed!r} is no whole number from 0 on.")
    sequence = np.random.SeedSequence(None if seed is None else int(seed))
    return np.random.Generator(np.random.PCG64(sequence)), sequence.entropy


class Core:
    """Some rows of one task: states, goals, times."""

    def __init__(self, name, rows, reward_type, threads):
        if reward_type not in ("sparse", "dense"):
            raise pincer.InputError(
                f'reward_type = "{reward_type}": "sparse" (-1, 0 on success) or "dense" (minus the distance).'
            )
        self.task = task_named(name)
        self.reward_type = reward_type
        self.model = pincer.load(self.task.scene(), name=name)
        self.start = pincer.State(self.model)
        self.states = [self.start.copy() for _ in range(rows)]
        self.goals = np.zeros((rows, self.task.goal_size))
        self.randoms = [None] * rows
        self.steps = np.zeros(rows, dtype=np.int64)
        self.most_steps = round(self.task.seconds / (TICKS * self.model.tick))
        self.pool = _core.Pool(threads)
        self.sensors = np.tile([self.start.measure(name) for name in self.model.sensors], (rows, 1))
        self._at_start = self.sensors[0].copy()
        self._targets = np.tile(np.concatenate([self.start.finger(k).target for k in range(2)]), (rows, 1))
        self._first_targets = self._targets[0].copy()

    def spaces(self):
        """(observation space, action space) of one row."""

        def unbounded(size):
            return spaces.Box(-np.inf, np.inf, (size,), np.float64)

        observation = spaces.Dict(
            {
                "observation": unbounded(len(self.model.sensors)),
                "achieved_goal": unbounded(self.task.goal_size),
                "desired_goal": unbounded(self.task.goal_size),
            }
        )
        return observation, spaces.Box(-1.0, 1.0, (6,), np.float32)

    def reset(self, row, seed, options):
        """One row to the start, with a goal of its own: drawn, or options["goal"]."""
        if seed is not None or self.randoms[row] is None:
            self.randoms[row], _ = generator(seed)
        goal = (options or {}).get("goal")
        drawn = self.task.desired(self.randoms[row])
        self.goals[row] = drawn if goal is None else np.asarray(goal, dtype=np.float64).reshape(self.task.goal_size)
        self.states[row].restore(self.start)
        self.sensors[row] = self._at_start
        self._targets[row] = self._first_targets
        self.steps[row] = 0

    def step(self, actions, rows):
        """Steps these rows. Returns rewards, terminated and truncated of all rows; those of other rows mean nothing."""
        way = np.clip(np.asarray(actions, dtype=np.float64), -1, 1) * SPEED * self.model.tick
        ticks = np.arange(1, TICKS + 1)[None, :, None]
        controls = np.ascontiguousarray(self._targets[rows][:, None, :] + ticks * way[rows][:, None, :])
        sensors = np.empty((len(rows), TICKS, len(self.model.sensors)))
        status = np.empty((len(rows), TICKS), dtype=np.int32)
        self.pool.run([self.model], [self.states[r] for r in rows], TICKS, controls, None, sensors, status, 0)
        self._targets[rows] = controls[:, -1]
        self.sensors[rows] = sensors[:, -1]
        self.steps[rows] += 1
        broken = np.zeros(len(self.states), dtype=bool)
        broken[rows] = np.any(status & int(pincer.Status.STATE_NOT_FINITE), axis=1)
        self.sensors[broken] = self._at_start  # numbers that no space contains don't leave here; the episode ends
        achieved = self.task.achieved(self.sensors)
        return (self.reward(achieved, self.goals), self.task.lost(self.sensors) | broken, self.steps >= self.most_steps)

    def reward(self, achieved, desired):
        distance = self.task.distance(achieved, desired)
        return -distance if self.reward_type == "dense" else -(distance > self.task.tolerance).astype(np.float64)

    def observations(self):
        return {
            "observation": self.sensors.copy(),
            "achieved_goal": self.task.achieved(self.sensors).copy(),
            "desired_goal": self.goals.copy(),
        }

    def successes(self):
        return self.task.distance(self.task.achieved(self.sensors), self.goals) <= self.task.tolerance


class GraspEnv(_EnvBase):
    """One task with Gymnasium's calls: reset(seed=, options=), step(action), render(), close()."""

    metadata = {"render_modes": ["rgb_array"], "render_fps": 50}

    def __init__(self, task="PincerPinchLift-v0", *, render_mode=None, reward_type="sparse", width=480, height=360):
        """task: a name of pincer.env.TASKS; reward_type: "sparse" or "dense"."""
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise pincer.InputError(f'render_mode = "{render_mode}": None or "rgb_array".')
        self._core = Core(task, 1, reward_type, threads=1)
        self.render_mode = render_mode
        self.observation_space, self.action_space = self._core.spaces()
        self._size, self._renderer = (width, height), None
        self._begun = False
        if gymnasium is None:
            self.spec = None

    @property
    def unwrapped(self):
        return self

    @property
    def np_random(self):
        if self._core.randoms[0] is None:
            self._core.randoms[0], _ = generator(None)
        return self._core.randoms[0]

    @np_random.setter
    def np_random(self, value):
        self._core.randoms[0] = value

    @property
    def task(self):
        return self._core.task

    @property
    def state(self):
        """The pincer.State that is stepped."""
        return self._core.states[0]

    @property
    def model(self):
        return self._core.model

    def reset(self, *, seed=None, options=None):
        """options: {"goal": numbers} in place of a drawn goal. Returns (observation, info)."""
        self._core.reset(0, seed, options)
        self._begun = True
        return self._observation(), self._info()

    def step(self, action):
        """Returns (observation, reward, terminated, truncated, info)."""
        if not self._begun:
            raise pincer.InputError("step before reset: call reset() first.")
        action = np.asarray(action)
        if action.shape != (6,):
            raise pincer.InputError(f"an action has 6 numbers, velocities of two fingertips; got shape {action.shape}.")
        reward, terminated, truncated = self._core.step(action[None], np.array([0]))
        return self._observation(), float(reward[0]), bool(terminated[0]), bool(truncated[0]), self._info()

    def compute_reward(self, achieved_goal, desired_goal, info):
        """As step's; also of rows of goals (hindsight)."""
        reward = self._core.reward(np.asarray(achieved_goal), np.asarray(desired_goal))
        return float(reward) if np.ndim(reward) == 0 else reward

    def compute_terminated(self, achieved_goal, desired_goal, info):
        """Reaching the goal doesn't end an episode; losing the body does, which goals don't tell."""
        return False

    def compute_truncated(self, achieved_goal, desired_goal, info):
        """The time does, which goals don't tell."""
        return False

    def render(self):
        """uint8 (height, width, 3) with render_mode "rgb_array", else None."""
        if self.render_mode is None:
            return None
        if self._renderer is None:
            self._renderer = pincer.Renderer(self._core.model, *self._size)
        return self._renderer.render(self._core.states[0])

    def close(self):
        self._renderer = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
        return False

    def _observation(self):
        return {name: rows[0] for name, rows in self._core.observations().items()}

    def _info(self):
        return {"is_success": bool(self._core.successes()[0]), "time": float(self._core.states[0].time)}
