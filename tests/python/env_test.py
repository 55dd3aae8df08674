"""The environments keep Gymnasium's contract, and each task can be done by its scripted policy."""

import numpy as np
import pytest

import pincer
import pincer.env

TASKS = list(pincer.env.TASKS)


@pytest.mark.parametrize("task", TASKS)
def test_keeps_the_contract(task):
    pincer.env.check_env(lambda: pincer.env.make(task))
    pincer.env.check_env(lambda: pincer.env.make(task, reward_type="dense"), steps=5)


@pytest.mark.parametrize("task", TASKS)
def test_rows_are_the_single_environment_and_begin_anew(task):
    pincer.env.check_vector_env(
        lambda n, mode: pincer.env.make_vec(task, n, autoreset_mode=mode, threads=2), lambda: pincer.env.make(task)
    )


@pytest.mark.parametrize("task", TASKS)
def test_the_scripted_policy_succeeds(task):
    env = pincer.env.make(task)
    for seed in range(5):
        observation, _ = env.reset(seed=seed)
        policy, succeeded = pincer.env.SCRIPTED[task](), False
        while not succeeded:
            observation, reward, terminated, truncated, info = env.step(policy(observation))
            succeeded = info["is_success"]
            assert succeeded or not (terminated or truncated), (
                task,
                seed,
                observation["achieved_goal"],
                observation["desired_goal"],
            )
        assert reward == 0


def test_the_checker_finds_what_is_wrong():
    class Wrong(pincer.env.GraspEnv):
        def step(self, action):
            observation, reward, terminated, truncated, info = super().step(action)
            return self.broken(observation, reward, terminated, truncated, info)

    def wrong(broken):
        env = Wrong()
        env.broken = broken
        return env

    for broken, what in (
        (lambda o, r, e, t, i: (o, np.float64(np.nan), e, t, i), "finite float"),
        (lambda o, r, e, t, i: (o["observation"], r, e, t, i), "observation_space"),
        (lambda o, r, e, t, i: (o, r, int(e), t, i), "bools"),
        (lambda o, r, e, t, i: (o, r - 1, e, t, i), "compute_reward"),
    ):
        with pytest.raises(AssertionError, match=what):
            pincer.env.check_env(lambda broken=broken: wrong(broken))


def test_goals_and_mistakes():
    env = pincer.env.make("PincerPinchLift-v0")
    observation, _ = env.reset(seed=1, options={"goal": [0, 0, 0.07]})
    assert observation["desired_goal"].tolist() == [0, 0, 0.07]
    goals = np.array([[0, 0, 0.02], [0, 0, 0.2]])
    assert env.compute_reward(np.zeros((2, 3)) + [0, 0, 0.02], goals, {}).tolist() == [0, -1]
    for make in (
        lambda: pincer.env.make("Pincer-v7"),
        lambda: pincer.env.make(TASKS[0], render_mode="human"),
        lambda: pincer.env.make(TASKS[0], reward_type="x"),
        lambda: env.step(np.zeros(3)),
        lambda: env.reset(seed=-1),
    ):
        with pytest.raises(pincer.InputError):
            make()


def test_renders():
    with pincer.env.make("PincerPinchLift-v0", render_mode="rgb_array", width=160, height=120) as env:
        env.reset(seed=1)
        try:
            picture = env.render()
        except RuntimeError as error:
            pytest.skip(f"no OpenGL here: {error}")
        assert picture.shape == (120, 160, 3) and picture.dtype == np.uint8 and picture.std() > 5
