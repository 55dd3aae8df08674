"""Types of pincer's names; shapes, units and frames are in the docstrings (help(pincer.State)) and in docs/python.md."""

import enum
from os import PathLike
from typing import Any, Mapping, NamedTuple, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Scene = Union[str, "PathLike[str]", Mapping[str, Any]]

__version__: str

class InputError(ValueError): ...

class Status(enum.IntFlag):
    OK = 0
    SOLVER_NOT_CONVERGED = 1
    CONTACTS_DROPPED = 2
    STATE_NOT_FINITE = 4
    INPUT_NOT_FINITE = 8
    IMPACTS_CUT = 16
    TOLERANCE_NOT_MET = 32
    BUDGET_SPENT = 64

class Model:
    @property
    def name(self) -> str: ...
    @property
    def text(self) -> str: ...
    @property
    def description(self) -> str: ...
    @property
    def bodies(self) -> list[str]: ...
    @property
    def fingers(self) -> list[str]: ...
    @property
    def driven(self) -> list[str]: ...
    @property
    def sensors(self) -> list[str]: ...
    @property
    def masses(self) -> list[float]: ...
    @property
    def tick(self) -> float: ...
    @property
    def duration(self) -> float: ...
    @property
    def ticks(self) -> int: ...
    @property
    def nbody(self) -> int: ...
    @property
    def nfinger(self) -> int: ...
    @property
    def ncontrol(self) -> int: ...
    @property
    def nstate(self) -> int: ...
    @property
    def nsensor(self) -> int: ...

class Body:
    position: Floats
    velocity: Floats
    @property
    def index(self) -> int: ...
    @property
    def name(self) -> str: ...

class Finger:
    target: Floats
    @property
    def index(self) -> int: ...
    @property
    def name(self) -> str: ...
    @property
    def position(self) -> Floats: ...
    @property
    def velocity(self) -> Floats: ...
    @property
    def touching(self) -> bool: ...
    @property
    def slips(self) -> bool: ...
    @property
    def body(self) -> int: ...
    @property
    def place(self) -> Floats: ...
    @property
    def normal(self) -> Floats: ...
    @property
    def force(self) -> Floats: ...
    @property
    def user_force(self) -> Floats: ...
    @property
    def normal_force(self) -> float: ...
    @property
    def tangential_force(self) -> float: ...
    @property
    def torsion(self) -> float: ...
    @property
    def gap(self) -> float: ...
    @property
    def pressure(self) -> Floats: ...

class State:
    def __init__(self, model: Model) -> None: ...
    @property
    def model(self) -> Model: ...
    @property
    def time(self) -> float: ...
    @property
    def tick(self) -> int: ...
    @property
    def position(self) -> Floats: ...
    @property
    def velocity(self) -> Floats: ...
    @property
    def contacts(self) -> np.ndarray: ...
    def body(self, name: Union[str, int]) -> Body: ...
    def finger(self, name: Union[str, int]) -> Finger: ...
    def measure(self, quantity: str) -> float: ...
    def hash(self) -> str: ...
    def copy(self) -> State: ...
    def restore(self, snapshot: State) -> None: ...
    def reset(self) -> None: ...

class Inputs:
    finger_position: Floats
    finger_velocity: Floats
    finger_rotation: Floats
    finger_force: Floats
    body_force: Floats
    motion_position: Floats
    motion_velocity: Floats
    gravity: Floats
    def __init__(self, model: Model) -> None: ...
    def clear(self) -> None: ...

class StepReport(NamedTuple):
    status: Status
    ok: bool
    remedies: tuple[str, ...]
    ticks: int
    contacts: int
    parts: int
    asleep: bool

class Camera:
    def __init__(
        self,
        target: Optional[ArrayLike] = None,
        distance: Optional[float] = None,
        yaw: Optional[float] = None,
        pitch: Optional[float] = None,
    ) -> None: ...

class Renderer:
    def __init__(self, model: Model, width: int = 640, height: int = 480) -> None: ...
    def render(self, state: State, camera: Optional[Camera] = None, forces: bool = True) -> NDArray[np.uint8]: ...

class RolloutResult(NamedTuple):
    state: Floats
    sensordata: Floats
    status: NDArray[np.int32]
    final: Optional[list[State]] = None

Outputs = tuple[Optional[Floats], Optional[Floats], Optional[NDArray[np.int32]]]

class Rollout:
    def __init__(self, threads: Optional[int] = None) -> None: ...
    def __enter__(self) -> Rollout: ...
    def __exit__(self, *_: object) -> None: ...
    def close(self) -> None: ...
    def rollout(
        self,
        model: Union[Model, Sequence[Model]],
        states: Union[State, Sequence[State]],
        controls: Optional[ArrayLike] = None,
        *,
        nstep: Optional[int] = None,
        out: Optional[Outputs] = None,
        chunk_size: Optional[int] = None,
        final: bool = False
    ) -> RolloutResult: ...

class Session:
    path: str
    info: np.ndarray
    trials: np.ndarray
    responses: np.ndarray
    events: np.ndarray
    readings: np.ndarray
    samples: np.ndarray
    state: str
    warning: str
    def frame(self, name: str = "trials") -> Any: ...

class Sweep:
    what: str
    parameters: list[str]
    measures: list[str]
    table: np.ndarray
    def frame(self) -> Any: ...

def load(scene: Scene, *, name: str = "scene") -> Model: ...
def step(model: Model, state: State, nstep: int = 1, inputs: Optional[Inputs] = None) -> StepReport: ...
def remedies(status: int) -> list[str]: ...
def rollout(
    model: Union[Model, Sequence[Model]],
    states: Union[State, Sequence[State]],
    controls: Optional[ArrayLike] = None,
    *,
    nstep: Optional[int] = None,
    out: Optional[Outputs] = None,
    threads: Optional[int] = None,
    chunk_size: Optional[int] = None,
    final: bool = False
) -> RolloutResult: ...
def save_rollout(path: str, model: Model, result: RolloutResult, controls: Optional[ArrayLike] = None) -> None: ...
def render(
    model: Model,
    state: State,
    width: int = 640,
    height: int = 480,
    camera: Optional[Camera] = None,
    *,
    forces: bool = True
) -> NDArray[np.uint8]: ...
def sweep(
    scene: Scene,
    vary: Mapping[str, Union[str, ArrayLike]],
    *,
    measures: Sequence[str] = (),
    zip: bool = False,
    threads: int = 2,
    out: Union[None, str, "PathLike[str]"] = None,
    resume: bool = False,
    client: Any = None,
    chunk_size: Optional[int] = None
) -> Sweep: ...
def read_session(path: Union[str, "PathLike[str]"], *, stride: int = 1) -> Session: ...
def read_sweep(directory: Union[str, "PathLike[str]"]) -> Sweep: ...
def version_text() -> str: ...
