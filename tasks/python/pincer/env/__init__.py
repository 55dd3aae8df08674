"""Tasks for learning, with Gymnasium's calls (docs/python.md has the contract). Works without Gymnasium; with it, registers there.

    env = pincer.env.make("PincerPinchLift-v0")
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
"""

from pincer.env.base import GraspEnv
from pincer.env.checker import check_env, check_vector_env
from pincer.env.policies import SCRIPTED
from pincer.env.tasks import TASKS
from pincer.env.vector import AutoresetMode, GraspVectorEnv

__all__ = [
    "AutoresetMode",
    "GraspEnv",
    "GraspVectorEnv",
    "SCRIPTED",
    "TASKS",
    "check_env",
    "check_vector_env",
    "make",
    "make_vec",
]


def make(task, **options):
    """An environment by its name; options are GraspEnv's."""
    return GraspEnv(task, **options)


def make_vec(task, num_envs=1, **options):
    """num_envs environments side by side; options are GraspVectorEnv's."""
    return GraspVectorEnv(task, num_envs, **options)


def _register():
    try:
        import gymnasium
    except ImportError:
        return
    for name in TASKS:
        if name not in gymnasium.registry:
            gymnasium.register(
                name,
                entry_point="pincer.env:GraspEnv",
                vector_entry_point="pincer.env:GraspVectorEnv",
                kwargs={"task": name},
            )


_register()
