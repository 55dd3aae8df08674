# %% [markdown]
# # A task for learning: random and scripted
# `pincer.env` has Gymnasium's calls; it works without Gymnasium.

# %%
import numpy as np

import pincer.env

TASK = "PincerPinchLift-v0"


def episode(env, policy, seed):
    """Success, and the steps that it took."""
    observation, info = env.reset(seed=seed)
    for steps in range(1, 10_000):
        observation, reward, terminated, truncated, info = env.step(policy(observation))
        if info["is_success"] or terminated or truncated:
            return info["is_success"], steps


# %%
env = pincer.env.make(TASK)
env.action_space.seed(0)
policies = {"random": lambda: lambda observation: env.action_space.sample(), "scripted": pincer.env.SCRIPTED[TASK]}
rates = {}
for name, make_policy in policies.items():
    outcomes = [episode(env, make_policy(), seed) for seed in range(5)]
    rates[name] = np.mean([success for success, _ in outcomes])
    print(f"{name}: {100 * rates[name]:.0f} % succeed, {np.mean([steps for _, steps in outcomes]):.0f} steps")
assert rates["scripted"] == 1 and rates["random"] <= 0.2

# %% Sixteen at once, on two threads; ended ones begin anew by themselves.
many = pincer.env.make_vec(TASK, 16, threads=2)
observations, infos = many.reset(seed=0)
many.action_space.seed(0)
for _ in range(20):
    observations, rewards, terminated, truncated, infos = many.step(many.action_space.sample())
print("observations:", {name: values.shape for name, values in observations.items()})
assert observations["observation"].shape == (16, 25)
