# %% [markdown]
# # Pinch and lift
# Two fingertips close on a cube, lift it by 60 mm, and hold it. Does it creep?

# %%
import pincer

model = pincer.load(
    {
        "version": 1,
        "duration": 10,
        "bodies": [
            {"name": "floor", "shape": {"type": "half_space"}},
            {
                "name": "cube",
                "shape": {"type": "box", "size": [0.04, 0.04, 0.04]},
                "mass": 0.1,
                "position": [0, 0, 0.02],
                "material": {"mu_s": 0.8, "torsion_radius": 0.004},
            },
        ],
        "fingers": [{"name": "thumb", "position": [-0.035, 0, 0.02]}, {"name": "index", "position": [0.035, 0, 0.02]}],
    }
)
state = pincer.State(model)
thumb, index, cube = state.finger("thumb"), state.finger("index"), state.body("cube")


# %% Moves both devices, evenly, within `seconds`.
def move(x, z, seconds):
    thumb.target, index.target = [-x, 0, z], [x, 0, z]
    report = pincer.step(model, state, nstep=round(seconds / model.tick))
    assert report.ok, report.remedies


# %%
move(0.023, 0.02, 0.3)  # 5 mm into the cube: 5 N on springs of 1000 N/m
move(0.023, 0.08, 1.0)
move(0.023, 0.08, 0.5)  # held: what the lift left swinging dies out
height = cube.position[2]
print(f"lifted by {1e3 * (height - 0.02):.3f} mm; each finger presses with {thumb.normal_force:.3f} N")
print(f"the fingers carry {thumb.force[2] + index.force[2]:.4f} N; the cube weighs {0.1 * 9.81:.4f} N")

# %% A grasp that must not creep: ten seconds later it is where it was.
move(0.023, 0.08, 10)
crept = cube.position[2] - height
print(f"crept by {1e9 * crept:.3f} nm in 10 s")
assert height > 0.078 and abs(crept) < 1e-9 and not thumb.slips
