"""Sweeps: killed, resumed, in shards, on clusters: the same bytes; and their tables in Python."""

import json
import os
import pathlib
import random
import shutil
import signal
import sqlite3
import subprocess
import time

import numpy as np
import pytest

import pincer

VARY = [
    "--vary",
    "sphere.mass=0.05:0.2:8",
    "--vary",
    "sphere.material.mu_s=0.3,0.5",
    "--vary",
    "duration=1",
    "--measure",
    "sphere.p_z",
    "--measure",
    "left.normal_force:max",
]


def run(program, *arguments, **more):
    return subprocess.run(
        [program, "sweep", *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
        **more,
    )


def killed_until_done(command, kills, seed):
    """Runs a shard, killed by SIGKILL at random moments so many times, then to its end. Returns how often it was killed."""
    dice = random.Random(seed)
    done = 0
    while done < kills:
        child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(dice.uniform(0.002, 0.05))
        if child.poll() is None:
            child.send_signal(signal.SIGKILL)
            done += 1
        elif done and child.returncode == 0:
            break  # finished before it could be killed more often
        child.wait()
    assert subprocess.run(command, stdout=subprocess.DEVNULL, check=False).returncode == 0
    return done


def merge_equals_whole(program, tmp_path, counts, kills, scene="s4_pinch", vary=VARY):
    """Returns how often each shard was killed."""
    assert run(program, scene, *vary, "--out", tmp_path / "whole").returncode == 0
    killed = []
    for count in counts:
        folders = [tmp_path / f"{count}-{i}" for i in range(1, count + 1)]
        for i, folder in enumerate(folders, start=1):
            command = [
                program,
                "sweep",
                scene,
                *vary,
                "--threads",
                "1",
                "--out",
                str(folder),
                "--shard",
                f"{i}/{count}",
                "--resume",
            ]
            killed.append(killed_until_done(command, kills, 100 * count + i))
        merged = run(program, "merge", *reversed(folders), "--out", tmp_path / f"merged-{count}")
        assert merged.returncode == 0, merged.stderr
        for name in ("sweep.db", "sweep.csv"):
            assert (tmp_path / f"merged-{count}" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes(), (
                count,
                name,
            )
    return killed


def test_merged_shards_are_the_whole_after_kills(program, tmp_path):
    merge_equals_whole(program, tmp_path, (1, 3), 4)


@pytest.mark.long
def test_merged_shards_are_the_whole_after_fifty_kills_each(program, tmp_path):
    scene = json.loads(
        "\n".join(line for line in pincer.load("s4_pinch").text.splitlines() if not line.lstrip().startswith("//"))
    )
    scene["solver"] = {"sleep": False}
    file = tmp_path / "pinch.json"
    file.write_text(json.dumps(scene))
    vary = ["--vary", "sphere.mass=0.05:0.2:700", "--vary", "duration=10", "--measure", "sphere.p_z"]  # 10 ms a case
    killed = merge_equals_whole(program, tmp_path, (1, 2, 3, 7), 50, str(file), vary)
    assert killed == [50] * 13


def test_a_sweep_killed_within_a_change_of_its_file_is_read_and_goes_on(program, tmp_path):
    """`--resume` and read_sweep once said "attempt to write a readonly database": a reader can't undo what a killed writer had begun."""
    run(program, "s4_pinch", *VARY, "--shard", "1/2", "--out", tmp_path / "a")
    file = tmp_path / "a/sweep.db"
    before = file.read_bytes()
    writer = sqlite3.connect(file, isolation_level=None)
    writer.execute("PRAGMA cache_size = 1")  # so that pages go to the file before the end of the transaction
    writer.execute("BEGIN")
    for _ in range(20):
        writer.execute("INSERT INTO measure SELECT 1000 + (SELECT count(*) FROM measure), hex(randomblob(2000)), 0")
    for name in ("b", "c"):
        shutil.copytree(tmp_path / "a", tmp_path / name)
        assert (tmp_path / name / "sweep.db").read_bytes() != before
        assert (tmp_path / name / "sweep.db-journal").stat().st_size > 0
    writer.execute("ROLLBACK")
    writer.close()
    assert np.array_equal(pincer.read_sweep(tmp_path / "b").table, pincer.read_sweep(tmp_path / "a").table)
    done = run(program, "s4_pinch", *VARY, "--shard", "1/2", "--out", tmp_path / "c", "--resume")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "c/sweep.db").read_bytes() == before


def test_python_and_the_program_make_the_same_table(program, tmp_path):
    run(program, "s4_pinch", *VARY, "--out", tmp_path / "a")
    table = pincer.sweep(
        "s4_pinch",
        {"sphere.mass": "0.05:0.2:8", "sphere.material.mu_s": [0.3, 0.5], "duration": 1},
        measures=["sphere.p_z", "left.normal_force:max"],
        out=tmp_path / "b",
    )
    assert (tmp_path / "a/sweep.db").read_bytes() == (tmp_path / "b/sweep.db").read_bytes()
    back = pincer.read_sweep(tmp_path / "a")
    assert np.array_equal(back.table, table.table) and back.parameters == [
        "sphere.mass",
        "sphere.material.mu_s",
        "duration",
    ]
    assert len(back.table) == 16 and len(set(back.table["state_hash"])) > 8


def test_hdf5_is_read_back_by_h5py(program, tmp_path):
    h5py = pytest.importorskip("h5py")
    run(program, "s4_pinch", *VARY, "--out", tmp_path / "a", "--format", "hdf5")
    back = pincer.read_sweep(tmp_path / "a").table
    with h5py.File(tmp_path / "a/sweep.h5") as file:
        for group in ("parameters", "measures"):
            for name in file[group]:
                assert np.array_equal(file[group][name], back[name.replace("|", "/")]), name
        assert (
            list(file["parameters"]) == ["sphere.mass", "sphere.material.mu_s", "duration"]
            or len(file["parameters"]) == 3
        )
        assert [h.decode() for h in file["state_hash"]] == list(back["state_hash"])


def test_a_dict_is_swept_and_a_case_that_fails_is_a_row(tmp_path):
    scene = {
        "version": 1,
        "duration": 0.1,
        "bodies": [{"name": "b", "shape": {"type": "sphere", "radius": 0.01}, "mass": 1}],
    }
    table = pincer.sweep(scene, {"b.mass": [1, -1, 2]}, measures=["b.p_z"], out=tmp_path / "a").table
    assert table["error"][0] == "" and "out of range" in table["error"][1] and np.isnan(table["b.p_z [m]"][1])
    with pytest.raises(pincer.InputError, match="--resume"):
        pincer.sweep(scene, {"b.mass": [1, -1, 2]}, measures=["b.p_z"], out=tmp_path / "a")
    with pytest.raises(pincer.InputError, match="3 values beside 2|2 values beside 3"):
        pincer.sweep(scene, {"b.mass": [1, 2, 3], "duration": [0.1, 0.2]}, zip=True)
    zipped = pincer.sweep(scene, {"b.mass": [1, 2], "duration": [0.1, 0.2]}, zip=True, measures=["b.p_z"])
    assert zipped.table["duration"].tolist() == [0.1, 0.2]


@pytest.mark.skipif(shutil.which("parallel") is None, reason="needs GNU parallel")
def test_gnu_parallel_runs_the_file(program, tmp_path):
    env = {**os.environ, "PATH": f"{pathlib.Path(program).parent}:{os.environ['PATH']}", "HOME": str(tmp_path)}
    out = tmp_path / "out"
    file = run(program, "s4_pinch", *VARY, "--for", "parallel", "--shards", 3, "--threads", 1, "--out", out)
    assert file.returncode == 0, file.stderr
    out.mkdir()
    done = subprocess.run(
        ["parallel", "--will-cite", "--joblog", str(out / "joblog"), "--retries", "3"],
        input=file.stdout,
        text=True,
        env=env,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert run(program, "merge", *sorted(out.glob("shard-*")), "--out", out).returncode == 0
    run(program, "s4_pinch", *VARY, "--out", tmp_path / "whole")
    assert (out / "sweep.db").read_bytes() == (tmp_path / "whole/sweep.db").read_bytes()
