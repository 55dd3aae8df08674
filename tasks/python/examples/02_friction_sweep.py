# %% [markdown]
# # At which friction does a pinch slip?
# The scene `s4_pinch` holds a ball of 0.1 kg with 2 N from each side: it slips below mu = m g / (2 F) = 0.24525.

# %%
import pathlib
import tempfile

import numpy as np

import pincer

out = pathlib.Path(tempfile.mkdtemp())
sweep = pincer.sweep(
    "s4_pinch", {"sphere.material.mu_s": "0.2:0.3:41", "duration": 0.1}, measures=["sphere.p_z"], out=out
)
mu, height = sweep.table["sphere.material.mu_s"], sweep.table["sphere.p_z [m]"]

# %%
falls = height < 0.1 - 1e-9
slips_below = mu[~falls].min()
print(f"slips below {mu[falls].max():.4f}, holds from {slips_below:.4f}; exactly: {0.1 * 9.81 / (2 * 2):.5f}")
assert mu[falls].max() < 0.24525 <= slips_below
assert np.array_equal(pincer.read_sweep(out).table, sweep.table)  # kept there case by case

# %%
import matplotlib

matplotlib.use("Agg")  # leave it out in a notebook
import matplotlib.pyplot as plt

plt.plot(mu, 1e3 * (0.1 - height), "o-")
plt.axvline(0.24525, linestyle="--", label="m g / (2 F)")
plt.xlabel("friction coefficient")
plt.ylabel("fallen in 0.1 s [mm]")
plt.legend()
plt.savefig(out / "slip.png")
print(out / "slip.png")
