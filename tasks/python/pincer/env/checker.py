"""Checks that an environment keeps Gymnasium's contract (docs/python.md writes it out). Each check raises AssertionError that names what is wrong."""

import numpy as np

from pincer.env.vector import AutoresetMode


def _same(a, b):
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(_same(a[name], b[name]) for name in a)
    return np.array_equal(np.asarray(a), np.asarray(b))


def _check_step(env, returned):
    observation, reward, terminated, truncated, info = returned
    assert env.observation_space.contains(observation), "step: the observation isn't in observation_space"
    assert isinstance(reward, float) and np.isfinite(reward), f"step: reward {reward!r} is no finite float"
    assert isinstance(terminated, bool) and isinstance(truncated, bool), "step: terminated and truncated are bools"
    assert isinstance(info, dict), "step: info is a dict"
    wanted = env.compute_reward(observation["achieved_goal"], observation["desired_goal"], info)
    assert reward == wanted, f"step: reward {reward} isn't compute_reward's {wanted}"


def _trace(env, seed, actions):
    """All that an environment says after reset(seed) to these actions."""
    said = [env.reset(seed=seed)]
    for action in actions:
        said.append(env.step(action))
    return said


def check_env(make, steps=40):
    """make: a function without arguments that makes the environment."""
    env = make()
    try:
        env.step(np.zeros(env.action_space.shape, dtype=env.action_space.dtype))
        raise AssertionError("step before reset doesn't raise")
    except AssertionError:
        raise
    except Exception:  # any other: it refuses
        pass
    observation, info = env.reset(seed=3)
    assert env.observation_space.contains(observation), "reset: the observation isn't in observation_space"
    assert isinstance(info, dict), "reset: info is a dict"
    env.action_space.seed(5)
    actions = [env.action_space.sample() for _ in range(steps)]
    assert all(env.action_space.contains(action) for action in actions), "action_space.sample isn't in the space"
    first = _trace(env, 3, actions)
    for returned in first[1:]:
        _check_step(env, returned)
    again, other = _trace(env, 3, actions), _trace(make(), 3, actions)
    for a, b, c in zip(first, again, other):
        assert all(
            _same(x, y) and _same(x, z) for x, y, z in zip(a, b, c)
        ), "the same seed and actions give another episode"
    goal = first[0][0]["desired_goal"]
    assert not _same(env.reset()[0]["desired_goal"], goal) or _same(
        env.reset(seed=4)[0]["desired_goal"], goal
    ), "reset() without a seed repeats"
    held = first[1][0]["observation"].copy()
    env.step(actions[0])
    assert _same(first[1][0]["observation"], held), "an observation that was returned changes later"
    _check_truncation(make())


def _check_truncation(env):
    """Nothing done: in the end the time is up, which is truncation and no termination."""
    env.reset(seed=1)
    still = np.zeros(env.action_space.shape, dtype=env.action_space.dtype)
    for _ in range(100_000):
        _, _, terminated, truncated, _ = env.step(still)
        if terminated or truncated:
            assert truncated and not terminated, "an episode that runs out of time is truncated, not terminated"
            return
    raise AssertionError("an episode doesn't end in 100,000 steps")


def check_vector_env(make, make_single, steps=30):
    """make(num_envs, autoreset_mode) and make_single(): rows are the single environment's, and begin anew as their mode says."""
    rows = 3
    env, single = make(rows, AutoresetMode.NEXT_STEP), make_single()
    assert env.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP, "metadata['autoreset_mode']"
    env.action_space.seed(2)
    actions = [env.action_space.sample() for _ in range(steps)]
    observations, infos = env.reset(seed=10)
    assert env.observation_space.contains(observations), "reset: observations aren't in observation_space"
    assert isinstance(infos, dict), "reset: infos is a dict"
    trace = [env.step(action) for action in actions]
    for row in range(rows):
        begin, _ = single.reset(seed=10 + row)
        assert _same(
            begin, {name: values[row] for name, values in observations.items()}
        ), "rows don't begin as single environments do"
        for action, (rows_seen, rewards, terminated, truncated, _) in zip(actions, trace):
            seen, reward, *ends, _ = single.step(action[row])
            assert _same(
                seen, {name: values[row] for name, values in rows_seen.items()}
            ), "a row differs from the single environment"
            assert reward == rewards[row] and ends == [terminated[row], truncated[row]], "a row's reward or end differs"
    for mode in AutoresetMode:
        _check_autoreset(make(2, mode), mode)


def _check_autoreset(env, mode):
    """Both rows run out of time at once; then the mode shows."""
    env.reset(seed=[1, 2])
    still = np.zeros(env.action_space.shape, dtype=env.action_space.dtype)
    begin = env.reset(seed=[1, 2])[0]
    for _ in range(100_000):
        observations, rewards, terminated, truncated, infos = env.step(still)
        if truncated.any():
            break
    assert truncated.all() and not terminated.any(), "rows run out of time"
    if mode is AutoresetMode.SAME_STEP:
        assert (
            infos["_final_obs"].all() and infos["_final_info"].all()
        ), "SAME_STEP: final_obs and final_info of ended rows"
        final = {name: np.stack([row[name] for row in infos["final_obs"]]) for name in observations}
        assert env.observation_space.contains(final), "SAME_STEP: final_obs isn't in the space"
        assert _same(
            observations["observation"], begin["observation"]
        ), "SAME_STEP: the observation is of the new beginning"
        return
    if mode is AutoresetMode.NEXT_STEP:
        observations, rewards, terminated, truncated, _ = env.step(still + 1)
        assert _same(
            observations["observation"], begin["observation"]
        ), "NEXT_STEP: the step after an end begins anew, whatever the action"
        assert (
            not rewards.any() and not terminated.any() and not truncated.any()
        ), "NEXT_STEP: the beginning has reward 0 and no end"
        return
    try:
        env.step(still)
        raise AssertionError("DISABLED: a row that has ended is stepped")
    except AssertionError:
        raise
    except Exception:
        pass
    mask = np.array([True, False])
    observations, _ = env.reset(options={"reset_mask": mask})
    assert _same(observations["observation"][0], begin["observation"][0]), "DISABLED: a masked row begins anew"
