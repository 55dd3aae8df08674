"""Many environments side by side, stepped on threads, with Gymnasium's vector calls and its three ways to begin anew."""

import enum

import numpy as np

import pincer
from pincer.env import spaces
from pincer.env.base import Core, _VectorBase

try:
    from gymnasium.vector import AutoresetMode
except ImportError:

    class AutoresetMode(enum.Enum):
        """When a row that has ended begins anew."""

        NEXT_STEP = "NextStep"
        SAME_STEP = "SameStep"
        DISABLED = "Disabled"


class GraspVectorEnv(_VectorBase):
    """num_envs rows of one task.

    autoreset_mode, as Gymnasium defines it:
      NEXT_STEP  the step after an end ignores that row's action, begins anew, and returns reward 0 and no end
      SAME_STEP  the step of an end returns the new beginning; the last observation and info are info["final_obs"] and info["final_info"]
      DISABLED   nothing begins by itself: reset(options={"reset_mask": bools}) begins the rows of the mask
    """

    def __init__(
        self,
        task="PincerPinchLift-v0",
        num_envs=1,
        *,
        autoreset_mode=AutoresetMode.NEXT_STEP,
        reward_type="sparse",
        threads=1,
    ):
        if num_envs < 1:
            raise pincer.InputError(f"num_envs = {num_envs} is out of range [1, inf).")
        self.num_envs = num_envs
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {"render_modes": [], "render_fps": 50, "autoreset_mode": self.autoreset_mode}
        self.render_mode, self.spec, self.closed = None, None, False
        self._core = Core(task, num_envs, reward_type, threads)
        self.single_observation_space, self.single_action_space = self._core.spaces()
        self.observation_space = spaces.batch(self.single_observation_space, num_envs)
        self.action_space = spaces.batch(self.single_action_space, num_envs)
        self._ended = np.zeros(num_envs, dtype=bool)
        self._begun = np.zeros(num_envs, dtype=bool)

    @property
    def unwrapped(self):
        return self

    def reset(self, *, seed=None, options=None):
        """seed: of the first row, the others' follow by one; or a list with one (or None) per row. Returns (observations, infos)."""
        options = dict(options or {})
        mask = options.pop("reset_mask", None)
        mask = np.ones(self.num_envs, dtype=bool) if mask is None else np.asarray(mask)
        if mask.shape != (self.num_envs,) or mask.dtype != bool or not mask.any():
            raise pincer.InputError(f"reset_mask needs {self.num_envs} bools, one of them True at least.")
        if not (mask | self._begun).all():
            raise pincer.InputError("reset: the first one begins all rows; a reset_mask is for later.")
        for row in np.flatnonzero(mask):
            self._core.reset(row, self._seed_of(row, seed), options)
        self._ended &= ~mask
        self._begun |= mask
        return self._core.observations(), self._infos(mask)

    def step(self, actions):
        """actions (num_envs, 6). Returns (observations, rewards, terminations, truncations, infos)."""
        actions = np.asarray(actions)
        if actions.shape != (self.num_envs, 6):
            raise pincer.InputError(f"actions has shape {actions.shape}; ({self.num_envs}, 6) is needed.")
        if not self._begun.all():
            raise pincer.InputError("step before reset: call reset() first.")
        if self.autoreset_mode is AutoresetMode.DISABLED and self._ended.any():
            raise pincer.InputError(
                f"rows {np.flatnonzero(self._ended).tolist()} have ended. Reset them by reset(options={{'reset_mask': ...}})."
            )
        begins = self._ended.copy()  # in NEXT_STEP only
        rewards, terminated, truncated = self._core.step(actions, np.flatnonzero(~begins))
        for values in (rewards, terminated, truncated):
            values[begins] = 0
        for row in np.flatnonzero(begins):
            self._core.reset(row, None, None)
        self._ended = terminated | truncated
        infos = self._infos(np.ones(self.num_envs, dtype=bool))
        if self.autoreset_mode is AutoresetMode.SAME_STEP and self._ended.any():
            infos = self._begin_ended(infos)
        return self._core.observations(), rewards, terminated, truncated, infos

    def close(self, **_):
        self.closed = True

    def render(self):
        return None

    def _seed_of(self, row, seed):
        if seed is None or isinstance(seed, (int, np.integer)):
            return None if seed is None else int(seed) + int(row)
        if len(seed) != self.num_envs:
            raise pincer.InputError(f"{len(seed)} seeds for {self.num_envs} rows.")
        return seed[row]

    def _begin_ended(self, infos):
        """SAME_STEP: ended rows begin anew; what they ended with goes into infos, by row."""
        ended, last = self._ended.copy(), self._core.observations()
        final_obs = np.full(self.num_envs, None, dtype=object)
        for row in np.flatnonzero(ended):
            final_obs[row] = {name: values[row] for name, values in last.items()}
            self._core.reset(row, None, None)
        self._ended[:] = False
        final_info = {name: values for name, values in infos.items() if not name.startswith("_")}
        final_info.update({f"_{name}": ended for name in tuple(final_info)})
        return {
            **self._infos(np.ones(self.num_envs, dtype=bool)),
            "final_obs": final_obs,
            "_final_obs": ended,
            "final_info": final_info,
            "_final_info": ended,
        }

    def _infos(self, mask):
        times = np.array([state.time for state in self._core.states])
        return {"is_success": self._core.successes(), "_is_success": mask.copy(), "time": times, "_time": mask.copy()}
