"""Many states stepped in parallel; names and shapes as in MuJoCo's rollout."""

import os
from typing import NamedTuple, Optional

import numpy as np

from pincer import _core


class RolloutResult(NamedTuple):
    """What came of a rollout.

    state:      (nbatch, nstep, nstate) time [s], then x, y, z [m] and qw, qx, qy, qz of each body, then v [m/s] and w [rad/s] of each,
                then the coordinates of model.joints, then their rates
    sensordata: (nbatch, nstep, nsensor) the quantities of model.sensors
    status:     (nbatch, nstep) int32, flags of pincer.Status; after a state that isn't finite the row repeats its last values
    final:      the states after the last tick, to go on from; None unless they were asked for
    """

    state: np.ndarray
    sensordata: np.ndarray
    status: np.ndarray
    final: Optional[list] = None


class Rollout:
    """A pool of threads that is kept between rollouts.

    with pincer.Rollout(threads=2) as pool:
        result = pool.rollout(model, states, controls)
    """

    __slots__ = ("_pool",)

    def __init__(self, threads=None):
        """threads: 1 to 256; None: one per processor that this process may use."""
        threads = len(os.sched_getaffinity(0)) if threads is None else threads
        if not 1 <= threads <= 256:
            raise _core.InputError(f"rollout: threads = {threads} is out of range [1, 256].")
        self._pool = _core.Pool(threads)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Ends the threads."""
        self._pool = None

    def rollout(self, model, states, controls=None, *, nstep=None, out=None, chunk_size=None, final=False):
        """As pincer.rollout, on these threads."""
        if self._pool is None:
            raise _core.InputError("rollout: the pool is closed. Make another pincer.Rollout.")
        models = list(model) if isinstance(model, (list, tuple)) else [model]
        controls, nbatch, nstep = _shapes(models, states, controls, nstep)
        if len(models) not in (1, nbatch):
            raise _core.InputError(f"rollout: {len(models)} models for {nbatch} rows. Give one, or one per row.")
        copies = [s.copy() for s in (states if isinstance(states, (list, tuple)) else [states] * nbatch)]
        result = _outputs(models, nbatch, nstep, out)
        self._pool.run(models, copies, nstep, controls, result.state, result.sensordata, result.status, chunk_size or 0)
        return result._replace(final=copies) if final else result


def rollout(model, states, controls=None, *, nstep=None, out=None, threads=None, chunk_size=None, final=False):
    """Steps nbatch states nstep ticks each, in parallel, and returns what came of every tick as a RolloutResult.

    model:      a Model, or a list of nbatch models with the same bodies, fingers and sensors
    states:     a State that all rows begin with, or a list of nbatch; they stay as they are
    controls:   (nbatch, nstep, ncontrol) or (nstep, ncontrol): places of all fingers' devices [m], x, y, z each, then what each drive
                is told; NaN: as the scene says; None: all follow the scene
    nstep:      ticks; needed without controls
    out:        (state, sensordata, status), each filled in place or None; C-contiguous, float64 (status: int32)
    threads:    None: one per processor. Neither threads nor chunk_size (rows that a thread takes at once) change a bit
    final:      also return the states after the last tick
    """
    with Rollout(threads) as pool:
        return pool.rollout(model, states, controls, nstep=nstep, out=out, chunk_size=chunk_size, final=final)


def _shapes(models, states, controls, nstep):
    """controls as an array of three axes, or None; rows; ticks."""
    nbatch = len(states) if isinstance(states, (list, tuple)) else None
    if controls is None:
        if nstep is None:
            raise _core.InputError("rollout: without controls it needs nstep, the number of ticks.")
        if nstep < 1:
            raise _core.InputError(f"rollout: nstep = {nstep} is out of range [1, inf).")
        return None, (len(models) if nbatch is None else nbatch), nstep
    controls = np.ascontiguousarray(controls, dtype=np.float64)
    wanted = models[0].ncontrol
    if controls.ndim not in (2, 3) or controls.shape[-1] != wanted or controls.shape[-2] < 1:
        raise _core.InputError(
            f"rollout: controls has shape {controls.shape}; (nbatch, nstep, {wanted}) or (nstep, {wanted}) is needed."
        )
    if nstep is not None and nstep != controls.shape[-2]:
        raise _core.InputError(
            f"rollout: nstep = {nstep}, but controls has {controls.shape[-2]} steps. Leave nstep out."
        )
    if nbatch is None:
        nbatch = controls.shape[0] if controls.ndim == 3 else len(models)
    if controls.ndim == 3 and controls.shape[0] != nbatch:
        raise _core.InputError(f"rollout: controls has {controls.shape[0]} rows for {nbatch} states.")
    if controls.ndim == 2:
        controls = np.ascontiguousarray(np.broadcast_to(controls, (nbatch, *controls.shape)))
    return controls, nbatch, controls.shape[1]


def _outputs(models, nbatch, nstep, out):
    """The arrays to fill: those of `out`, checked, and new ones."""
    sizes = {(m.nstate, m.nsensor, m.ncontrol) for m in models}
    if len(sizes) != 1:
        raise _core.InputError("rollout: the models differ in their numbers of bodies, fingers or recorded quantities.")
    nstate, nsensor, _ = sizes.pop()
    wanted = [
        ((nbatch, nstep, nstate), np.float64),
        ((nbatch, nstep, nsensor), np.float64),
        ((nbatch, nstep), np.int32),
    ]
    given = (None, None, None) if out is None else tuple(out)[:3]
    arrays = []
    for (shape, kind), array, name in zip(wanted, given, ("state", "sensordata", "status")):
        if array is None:
            array = np.empty(shape, dtype=kind)
        elif array.shape != shape or array.dtype != kind or not array.flags.c_contiguous or not array.flags.writeable:
            raise _core.InputError(
                f"rollout: out's {name} has shape {array.shape} and type {array.dtype}; it needs {shape}, "
                f"{np.dtype(kind)}, C-contiguous and writeable."
            )
        arrays.append(array)
    return RolloutResult(*arrays)


def save_rollout(path, model, result, controls=None):
    """Writes a rollout as an HDF5 file with robomimic's groups: data/demo_0, ... each with states, actions, obs/<sensor>, dones.

    Needs h5py. Attributes: data has "total" and "env_args" (JSON: the scene); each demo has "num_samples" and "model_file" (the scene's text).
    """
    import json

    try:
        import h5py
    except ImportError:
        raise ImportError("save_rollout needs h5py (Debian: python3-h5py).") from None
    nbatch, nstep = result.status.shape
    with h5py.File(path, "w") as file:
        data = file.create_group("data")
        data.attrs["total"] = nbatch * nstep
        data.attrs["env_args"] = json.dumps({"env_name": model.name, "type": 3, "env_kwargs": {"tick": model.tick}})
        for row in range(nbatch):
            demo = data.create_group(f"demo_{row}")
            demo.attrs["num_samples"] = nstep
            demo.attrs["model_file"] = model.text
            demo["states"] = result.state[row]
            if controls is not None:
                demo["actions"] = np.broadcast_to(controls, (nbatch, nstep, model.ncontrol))[row]
            demo["dones"] = np.arange(1, nstep + 1) == nstep
            demo["status"] = result.status[row]
            for k, name in enumerate(model.sensors):
                demo[f"obs/{name}"] = result.sensordata[row, :, k]
