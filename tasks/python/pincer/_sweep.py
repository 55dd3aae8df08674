"""Sweeps: a scene for many values of its numbers, on threads or on a Dask cluster."""

import builtins
import itertools
import os

import numpy as np

from pincer import _core
from pincer._load import scene_text
from pincer._tables import Sweep


def sweep(
    scene, vary, *, measures=(), zip=False, threads=2, out=None, resume=False, client=None, chunk_size=None
):  # noqa: A002
    """Runs the scene once for every combination of values, and returns a Sweep.

    scene:    name of a built-in scene, path of a scene file, or a dict
    vary:     {"sphere.material.mu_s": values}: numbers, or "FROM:TO:N", "FROM:TO:N:log" as `pincer sweep --vary` has them; with zip=True taken
              in step in place of every combination
    measures: quantities at the end, or with ":min", ":max" over the whole run; none: those that the scene records
    threads:  of this process. No result depends on it
    out:      folder that keeps every finished case at once (sweep.db); resume=True goes on with what is there
    client:   a dask.distributed.Client: its workers run the cases, chunk_size at a time; what a worker takes with it when it dies is
              run again by another. The same table, byte by byte
    A case that can't be run has its error in the table. Raises InputError where none can.
    """
    name, text = scene_text(scene)
    paths = list(vary)
    lists = [
        _core.values_of(values) if isinstance(values, str) else [float(v) for v in np.atleast_1d(values)]
        for values in vary.values()
    ]
    points = _zipped(paths, lists) if zip else [list(point) for point in itertools.product(*lists)]
    job = (name, text, paths, points, list(measures))
    folder = "" if out is None else os.fspath(out)
    if client is None:
        return Sweep(_core.run_sweep(*job, [], threads, folder, resume))
    if resume:
        raise _core.InputError("sweep: resume is for threads; a Dask client runs all cases.")
    return _on_cluster(job, client, chunk_size, folder)


def _zipped(paths, lists):
    """The first values of all, the second ones, ..."""
    cases = max(len(values) for values in lists)
    for path, values in builtins.zip(paths, lists):
        if len(values) not in (1, cases):
            raise _core.InputError(
                f"sweep: {path} has {len(values)} values beside {cases}. Give as many, or one for all."
            )
    return [[values[0 if len(values) == 1 else k] for values in lists] for k in range(cases)]


def _run_cases(job, cases):
    """On a worker: some cases of the job, as rows."""
    from pincer import _core as core

    raw = core.run_sweep(*job, cases, 1, "", False)
    return list(zip(raw["case"], raw["values"], raw["state_hash"], raw["error"]))


def _on_cluster(job, client, chunk_size, folder):
    cases = list(range(len(job[3])))
    chunk = chunk_size or max(1, len(cases) // (8 * max(1, len(client.ncores()))))
    shared = client.scatter(job, broadcast=True)
    futures = [
        client.submit(_run_cases, shared, cases[k : k + chunk], pure=False, retries=5)
        for k in range(0, len(cases), chunk)
    ]
    rows = sorted(row for part in client.gather(futures) for row in part)
    if folder:
        name, text, paths, points, measures = job
        _core.write_sweep(folder, name, text, paths, points, measures, rows)
    raw = _core.sweep_table(*job)
    raw.update(
        case=[r[0] for r in rows],
        points=[job[3][r[0]] for r in rows],
        values=[r[1] for r in rows],
        state_hash=[r[2] for r in rows],
        error=[r[3] for r in rows],
    )
    return Sweep(raw)
