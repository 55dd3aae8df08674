"""pincer: multi-finger manipulation physics.

    import pincer
    model = pincer.load("s4_pinch")
    state = pincer.State(model)
    pincer.step(model, state, nstep=100)
    print(state.body("sphere").position, state.contacts["force"])

SI units and radians; the world's z axis points up; quaternions are w, x, y, z. How to: docs/python.md.
"""

from pincer._core import (
    Body,
    Camera,
    Finger,
    InputError,
    Inputs,
    Joint,
    Model,
    Renderer,
    State,
    Status,
    StepReport,
    __version__,
    remedies,
    step,
    version_text,
)
from pincer._load import load
from pincer._render import render
from pincer._rollout import Rollout, RolloutResult, rollout, save_rollout
from pincer._sweep import sweep
from pincer._tables import Session, Sweep, read_session, read_sweep

__all__ = [
    "Body",
    "Camera",
    "Finger",
    "InputError",
    "Inputs",
    "Joint",
    "Model",
    "Renderer",
    "Rollout",
    "RolloutResult",
    "Session",
    "State",
    "Status",
    "StepReport",
    "Sweep",
    "__version__",
    "load",
    "read_session",
    "read_sweep",
    "remedies",
    "render",
    "rollout",
    "save_rollout",
    "step",
    "sweep",
    "version_text",
]
