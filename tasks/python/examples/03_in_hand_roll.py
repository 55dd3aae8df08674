# %% [markdown]
# # A ball rolled between two fingertips
# Tips that don't turn, going round the ball's middle by phi, turn it by (R + r)/R phi, if nothing slips.

# %%
import numpy as np

import pincer

R, r, way = 0.02, 0.008, 0.004
model = pincer.load("roll_between_fingers")  # its fingers follow the trajectories of the scene; here they follow us
state = pincer.State(model)
thumb, index, ball = state.finger("thumb"), state.finger("index"), state.body("ball")

# %%
thumb.target, index.target = [-0.026, 0, 0.1], [0.026, 0, 0.1]
pincer.step(model, state, nstep=300)
angles, slipped = [], False
for y in np.linspace(0, way, 201)[1:]:
    thumb.target, index.target = [-0.026, y, 0.1], [0.026, -y, 0.1]
    pincer.step(model, state, nstep=10)
    slipped |= thumb.slips or index.slips
    w, _, _, z = ball.position[3:]
    angles.append(2 * np.arctan2(z, w))
pincer.step(model, state, nstep=500)

# %%
w, _, _, z = ball.position[3:]
turned, exact = 2 * np.arctan2(abs(z), w), (R + r) / R * np.arcsin(way / (R + r))
print(f"turned by {turned:.7f} rad; exactly {exact:.7f} rad")
assert not slipped and abs(turned - exact) < 1e-6
