"""Sessions and sweeps as NumPy's structured arrays."""

import os

import numpy as np

from pincer import _core


def _structured(columns):
    """One structured array of named columns of the same length."""
    if not columns:
        return np.empty(0, dtype=[])
    arrays = {name: np.asarray(values) for name, values in columns.items()}
    table = np.empty(len(next(iter(arrays.values()))), dtype=[(name, array.dtype) for name, array in arrays.items()])
    for name, array in arrays.items():
        table[name] = array
    return table


def _frame(table):
    try:
        import pandas
    except ImportError:
        raise ImportError(
            "frame() needs pandas (Debian: python3-pandas). Without it use the structured array itself."
        ) from None
    return pandas.DataFrame({name: table[name] for name in table.dtype.names or ()})


class Session:
    """What a session keeps (docs/experiments.md): structured arrays, SI units, times on the session's clock.

    trials, responses, events, readings, samples: one row per trial, answer, event, reading, kept tick
    survey: one row per question that a person was asked
    columns: one row per column of a session's tables: table, column, unit, description, levels
    Trials, participants, runs and places in an order count from 1, as in `pincer export`.
    info: one row: task, seed, version, commit, compiler, flags, ...; state: "complete", "running", "aborted: ..."
    warning: sentences if the session isn't whole; else empty
    """

    __slots__ = ("path", "info", "trials", "responses", "events", "readings", "samples", "survey", "columns", "state", "warning")

    def __init__(self, path, tables):
        self.path = path
        for name in ("info", "trials", "responses", "events", "readings", "samples", "survey", "columns"):
            setattr(self, name, _structured(tables[name]))
        self.state, self.warning = tables["state"], tables["warning"]

    def frame(self, name="trials"):
        """A table as a pandas DataFrame."""
        return _frame(getattr(self, name))

    def __repr__(self):
        return f"<pincer.Session {self.path}: {len(self.trials)} trials, {len(self.samples)} samples, {self.state}>"


def read_session(path, *, stride=1):
    """A session's tables. stride: every stride-th sample of each trial. Raises InputError for what is no session, or damaged."""
    return Session(os.fspath(path), _core.read_session(os.fspath(path), stride))


class Sweep:
    """The table of a sweep.

    table: structured array, one row per finished case: "case", a field per parameter and per measure, "state_hash", "error"
    parameters, measures: the names of these fields
    """

    __slots__ = ("what", "parameters", "measures", "table")

    def __init__(self, raw):
        self.what, self.parameters, self.measures = raw["what"], raw["parameters"], raw["measures"]
        rows = len(raw["case"])
        points = np.asarray(raw["points"], dtype=np.float64).reshape(rows, len(self.parameters))
        values = np.asarray(raw["values"], dtype=np.float64).reshape(rows, len(self.measures))
        columns = {"case": np.asarray(raw["case"], dtype=np.int64)}
        columns.update(zip(self.parameters, points.T))
        columns.update(zip(self.measures, values.T))
        columns["state_hash"] = np.asarray(raw["state_hash"], dtype="U16")
        columns["error"] = np.asarray(raw["error"], dtype=str if rows else "U1")
        self.table = _structured(columns)

    def frame(self):
        """The table as a pandas DataFrame."""
        return _frame(self.table)

    def __repr__(self):
        return f"<pincer.Sweep of {self.what}: {len(self.table)} cases>"


def read_sweep(directory):
    """The table of a sweep that `pincer sweep --out` or pincer.sweep(out=) keeps there, finished or not. Raises InputError."""
    return Sweep(_core.read_sweep(os.fspath(directory)))
