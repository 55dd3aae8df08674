# %% [markdown]
# # Where is a mesh held best?
# A chess pawn is pinched from opposite sides with 3 N, at several heights and headings. How hard can it be pulled down before it slips?

# %%
import json

import numpy as np

import pincer

SQUEEZE = 3.0  # [N]
text = "\n".join(line for line in pincer.load("pawn").text.splitlines() if not line.lstrip().startswith("//"))
pawn = next(body for body in json.loads(text)["bodies"] if body["name"] == "pawn")


def pinch(height, heading):
    """Model and state of the pawn, weightless, between two fingers that press with SQUEEZE; None where they don't meet it."""
    side = np.array([np.cos(heading), np.sin(heading), 0])
    fingers = [
        {"name": name, "stiffness": 600, "damping": 10, "position": sign * 0.04 * side + [0, 0, height]}
        for name, sign in (("thumb", -1.0), ("index", 1.0))
    ]
    model = pincer.load(
        {"version": 1, "duration": 10, "gravity": [0, 0, 0], "bodies": [pawn], "fingers": fingers}, name="pawn"
    )
    state = pincer.State(model)
    thumb, index = state.finger("thumb"), state.finger("index")
    for distance in np.arange(0.04, 0, -1e-4):
        thumb.target, index.target = -distance * side + [0, 0, height], distance * side + [0, 0, height]
        pincer.step(model, state, nstep=10)
        if min(thumb.normal_force, index.normal_force) > SQUEEZE:
            return model, state
    return None


def holds(height, heading):
    """The pull [N] at which it slips, to 0.1 N; 10: it holds that much, as where the fingers are under a flare."""
    pinched = pinch(height, heading)
    if pinched is None:
        return 0.0
    model, state = pinched
    inputs = pincer.Inputs(model)
    for pull in np.arange(0.1, 10, 0.1):
        inputs.body_force[0, 2] = -pull
        pincer.step(model, state, nstep=30, inputs=inputs)
        if state.finger("thumb").slips and state.finger("index").slips:
            return float(pull)
    return 10.0


# %%
heights, headings = np.linspace(0.008, 0.036, 8), np.radians([0, 90])
grid = np.array([[holds(height, heading) for heading in headings] for height in heights])
for height, row in zip(heights, grid):
    print(f"{1e3 * height:5.1f} mm  " + "  ".join(f"{newtons:5.1f} N" for newtons in row))
best = heights[grid.mean(axis=1).argmax()]
print(f"held best at {1e3 * best:.0f} mm; on a plain rod it would be 2 mu F = {2 * 0.6 * SQUEEZE:.1f} N")
assert grid.max() > 2 and grid.std() > 0.1
assert np.abs(grid[:, 0] - grid[:, 1]).max() <= 0.3  # a body of revolution is held alike from all sides
