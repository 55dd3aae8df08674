# %% [markdown]
# # Friction from a recorded slip
# A block slides down an incline of 30 degrees; its place was recorded with noise of 0.2 mm. Which friction explains it?
# Every candidate is one row of a rollout, all run in parallel.

# %%
import numpy as np

import pincer

ANGLE, TRUE_MU, TICKS = np.radians(30), 0.37, 500


def incline(mu):
    g = 9.81
    return pincer.load(
        {
            "version": 1,
            "duration": 1,
            "gravity": [g * np.sin(ANGLE), 0, -g * np.cos(ANGLE)],
            "bodies": [
                {"name": "floor", "shape": {"type": "half_space"}},
                {
                    "name": "block",
                    "shape": {"type": "box", "size": [0.04, 0.04, 0.02]},
                    "mass": 0.2,
                    "position": [0, 0, 0.01],
                    "material": {"mu_s": mu},
                },
            ],
            "pairs": [{"bodies": ["floor", "block"], "material": {"mu_s": mu}}],
        }
    )


def ways(mus):
    """Of the block along the incline [m], a row per friction."""
    models = [incline(mu) for mu in mus]
    result = pincer.rollout(models, [pincer.State(m) for m in models], nstep=TICKS)
    assert not result.status.any()
    return result.state[:, :, 1 + 7]  # x of the second body


# %% The recording: stands for your own.
random = np.random.default_rng(1)
recorded = ways([TRUE_MU])[0] + random.normal(scale=2e-4, size=TICKS)

# %% Three rounds of 21 candidates, each around the best one of the last.
low, high = 0.1, 0.57
for _ in range(3):
    mus = np.linspace(low, high, 21)
    errors = np.sqrt(np.mean((ways(mus) - recorded) ** 2, axis=1))
    best = mus[errors.argmin()]
    low, high = best - (mus[1] - mus[0]), best + (mus[1] - mus[0])
print(f"mu = {best:.4f} explains it best, to {1e3 * errors.min():.3f} mm; it was {TRUE_MU}")
# mu moves the block by g cos t^2/2 = 1.06 m per unit at the end: 0.2 mm in each of 500 samples leave some 2e-5.
assert abs(best - TRUE_MU) < 5e-4 and errors.min() < 2.2e-4
