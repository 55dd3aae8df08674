# %% [markdown]
# # Where is a mesh held best?
# The pawn is pinched from opposite sides at many heights and headings. For each, how much can be hung on it before it slips?

# %%
import numpy as np

import pincer

pawn = pincer.load("pawn")
text = "\n".join(line for line in pawn.text.splitlines() if not line.lstrip().startswith("//"))
import json

body = next(b for b in json.loads(text)["bodies"] if b["name"] == "pawn")
heights, headings, squeeze = np.linspace(0.006, 0.04, 9), np.radians([0, 45, 90]), 0.003


def pinched(height, heading):
    """The pawn without a floor or weight, held by two fingers that face each other."""
    side = np.array([np.cos(heading), np.sin(heading), 0])
    fingers = [{"name": name, "stiffness": 1000, "damping": 20,
                "trajectory": {"keyframes": [{"time": 0, "position": sign * 0.04 * side + [0, 0, height]},
                                             {"time": 0.3, "position": sign * 0.008 * side + [0, 0, height]}]}}
               for name, sign in (("thumb", -1.0), ("index", 1.0))]
    return pincer.load({"version": 1, "duration": 2, "gravity": [0, 0, 0], "bodies": [{**body, "position": [0, 0, 0], "rotation": [0, 0, 0]}],
                        "fingers": fingers}, name="tasks/scenes/pawn-pinched.json")


def holds(height, heading):
    """The weight that makes it slip [N], by pulling harder and harder; 0: it wasn't caught."""
    model = pinched(height, heading)
    state, inputs = pincer.State(model), pincer.Inputs(model)
    pincer.step(model, state, nstep=500)
    if not (state.finger("thumb").touching and state.finger("index").touching):
        return 0.0
    start = state.position[0, 2]
    for pull in np.arange(0.5, 40, 0.5):
        inputs.body_force[0, 2] = -pull
        pincer.step(model, state, nstep=30, inputs=inputs)
        if abs(state.position[0, 2] - start) > 0.012:
            return float(pull)
    return 40.0


# %%
grid = np.array([[holds(height, heading) for heading in headings] for height in heights])
for height, row in zip(heights, grid):
    print(f"{1e3 * height:5.1f} mm  " + "  ".join(f"{newtons:5.1f} N" for newtons in row))
best = heights[grid.mean(axis=1).argmax()]
print(f"held best at {1e3 * best:.0f} mm")
assert grid.max() > 2 and grid.std() > 0.1
# It is a body of revolution: the heading makes no difference, but for the facets of its mesh.
assert np.abs(grid - grid[:, :1]).max() <= 2
