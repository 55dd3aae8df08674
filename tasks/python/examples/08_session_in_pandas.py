# %% [markdown]
# # A session in pandas
# `pincer run` leaves a session: every trial, every kept tick. Here a simulated participant picks up spheres.

# %%
import pathlib
import subprocess
import sys
import tempfile

import pincer

PINCER = sys.argv[1] if len(sys.argv) > 1 else "build/pincer"
out = pathlib.Path(tempfile.mkdtemp()) / "session"
subprocess.run(
    [PINCER, "run", "sphere-pickup", "--repetitions", "1", "--friction", "0.9", "--seed", "7", "--out", str(out)],
    stdout=subprocess.DEVNULL,
    check=True,
)

# %%
session = pincer.read_session(out / "session.db")
print(session)
print("made by", session.info["version"][0], "of commit", session.info["commit_id"][0] or "?")

# %% One row per trial, one per tick that was kept.
trials, samples = session.frame("trials"), session.frame("samples")
print(trials.iloc[:, :8].to_string())
highest = (
    samples.groupby("trial")["object_z_m"].max()
    if "object_z_m" in samples
    else samples.groupby("trial").max(numeric_only=True).iloc[:, 0]
)
print(highest.to_string())
assert len(trials) == len(session.trials) > 0 and len(samples) > 100
