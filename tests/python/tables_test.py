"""Sessions in NumPy and pandas; pictures."""

import subprocess

import numpy as np
import pytest

import pincer


@pytest.fixture(scope="module")
def session(program, tmp_path_factory):
    out = tmp_path_factory.mktemp("session")
    subprocess.run(
        [
            program,
            "run",
            "sphere-pickup",
            "--repetitions",
            "1",
            "--friction",
            "0.9",
            "--condition",
            "cld+force",
            "--seed",
            "7",
            "--out",
            str(out / "a"),
        ],
        stdout=subprocess.DEVNULL,
        check=True,
    )
    return out / "a/session.db"


def test_a_session_is_read(session, program, tmp_path):
    read = pincer.read_session(session)
    assert read.state == "complete" and read.warning == "" and len(read.trials) == 1
    assert read.info["task"][0] == "sphere-pickup" and read.info["version"][0] == pincer.__version__
    subprocess.run([program, "export", str(session), "--out", str(tmp_path)], stdout=subprocess.DEVNULL, check=True)
    rows = (
        [line.split(",") for line in (tmp_path / "sample.csv").read_text().splitlines()]
        if (tmp_path / "sample.csv").exists()
        else None
    )
    if rows:
        assert list(read.samples.dtype.names) == rows[0] and len(read.samples) == len(rows) - 1
    assert (np.diff(read.samples["time_s"]) > 0).all()
    assert len(pincer.read_session(session, stride=10).samples) == -(-len(read.samples) // 10)
    with pytest.raises(pincer.InputError, match="stride"):
        pincer.read_session(session, stride=0)
    with pytest.raises(pincer.InputError):
        pincer.read_session(tmp_path / "none.db")


def test_a_session_counts_and_describes_as_its_export_does(session, program, tmp_path):
    pandas = pytest.importorskip("pandas")
    subprocess.run([program, "export", str(session), "--out", str(tmp_path)], stdout=subprocess.DEVNULL, check=True)
    read = pincer.read_session(session)
    for name, table in (("trial", "trials"), ("event", "events"), ("reading", "readings")):
        exported = pandas.read_csv(tmp_path / f"{name}.csv")
        for column in ("trial", "participant"):
            if column in exported:
                assert list(exported[column]) == list(read.frame(table)[column]), f"{name}.{column}"
    assert read.trials["trial"][0] == 1 and read.trials["participant"][0] == 1
    columns = pandas.read_csv(tmp_path / "columns.csv", keep_default_na=False)
    assert columns.equals(read.frame("columns")[list(columns.columns)].astype(str))
    levels = columns[(columns.table == "trial") & (columns.column == "condition")].levels.item()
    assert levels.startswith("cld+force: ") and ";" not in levels  # the session has this condition alone


def test_a_session_is_a_data_frame(session):
    pandas = pytest.importorskip("pandas")
    frame = pincer.read_session(session).frame("samples")
    assert isinstance(frame, pandas.DataFrame) and len(frame) > 10


def test_pictures_show_what_moves(pinch):
    state = pincer.State(pinch)
    try:
        first = pincer.render(pinch, state, 200, 150)
    except RuntimeError as error:
        pytest.skip(f"no OpenGL here: {error}")
    assert first.shape == (150, 200, 3) and first.dtype == np.uint8 and first.std() > 5
    assert np.array_equal(pincer.render(pinch, state, 200, 150), first)
    state.body("sphere").position = [0, 0, 0.12]
    assert not np.array_equal(pincer.render(pinch, state, 200, 150), first)
    near = pincer.render(pinch, state, 200, 150, pincer.Camera(target=[0, 0, 0.12], distance=0.1))
    assert not np.array_equal(near, pincer.render(pinch, state, 200, 150))
    two = [pincer.Renderer(pinch, 64, 48), pincer.Renderer(pinch, 32, 24)]
    assert [r.render(state).shape for r in two] == [(48, 64, 3), (24, 32, 3)] and two[0].render(state).shape == (
        48,
        64,
        3,
    )
    for camera, size in ((pincer.Camera(pitch=2), 64), (pincer.Camera(distance=0), 64), (None, 3)):
        with pytest.raises(pincer.InputError):
            pincer.render(pinch, state, size, 64, camera)
