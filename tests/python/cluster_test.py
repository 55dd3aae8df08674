"""Sweeps on schedulers that people have: a Slurm of one node, Dask with two workers of which one is killed. Only with --cluster."""

import os
import random
import shutil
import signal
import socket
import subprocess
import time

import numpy as np
import pytest

import pincer
from conftest import BUILD

pytestmark = pytest.mark.cluster
VARY = {"sphere.mass": "0.05:0.2:24", "duration": 3}
ARGUMENTS = ["--vary", "sphere.mass=0.05:0.2:24", "--vary", "duration=3", "--measure", "sphere.p_z"]


def whole(program, folder):
    subprocess.run(
        [program, "sweep", "s4_pinch", *ARGUMENTS, "--out", str(folder)], stdout=subprocess.DEVNULL, check=True
    )
    return (folder / "sweep.db").read_bytes()


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Slurm:
    """munged, slurmctld and slurmd of their own in a folder; ended with it."""

    def __init__(self, folder):
        self.folder, self.daemons = folder, []
        host = socket.gethostname().split(".")[0]
        key = folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        folder.chmod(0o755)
        munge = folder / "munge"
        munge.mkdir(mode=0o755)
        munged = shutil.which("munged", path="/usr/sbin:/usr/bin")
        subprocess.run(
            [
                munged,
                "--force",
                f"--key-file={key}",
                f"--socket={munge}/socket",
                f"--pid-file={munge}/pid",
                f"--log-file={munge}/log",
                f"--seed-file={munge}/seed",
            ],
            check=True,
        )
        self.munge_pid = int((munge / "pid").read_text())
        (folder / "slurm.conf").write_text(
            f"""ClusterName=pincer
SlurmctldHost={host}
SlurmUser=root
SlurmdUser=root
SlurmctldPort={free_port()}
SlurmdPort={free_port()}
AuthType=auth/munge
AuthInfo=socket={munge}/socket
CryptoType=crypto/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobRequeue=1
ReturnToService=2
MpiDefault=none
NodeName={host} CPUs={os.cpu_count()} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""
        )
        (folder / "state").mkdir()
        (folder / "spool").mkdir()
        self.env = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf"), "PATH": f"{BUILD}:{os.environ['PATH']}"}
        for daemon in ("slurmctld", "slurmd"):
            self.daemons.append(
                subprocess.Popen(
                    [shutil.which(daemon, path="/usr/sbin:/usr/bin"), "-D"],
                    env=self.env,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                )
            )
        for _ in range(60):
            if "idle" in self.run("sinfo", "-h", "-o", "%t").stdout:
                return
            time.sleep(1)
        raise AssertionError((folder / "slurmctld.log").read_text()[-2000:])

    def run(self, *command, **more):
        return subprocess.run(
            list(command),
            env=self.env,
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            check=False,
            **more,
        )

    def close(self):
        for daemon in self.daemons:
            daemon.terminate()
        for daemon in self.daemons:
            daemon.wait(timeout=30)
        os.kill(self.munge_pid, signal.SIGTERM)


@pytest.mark.skipif(
    shutil.which("slurmctld", path="/usr/sbin") is None or os.geteuid() != 0, reason="needs slurm-wlm, munge and root"
)
def test_slurm_array_goes_on_where_a_task_was_killed(program, tmp_path):
    slurm = Slurm(tmp_path)
    try:
        out = tmp_path / "out"
        out.mkdir()
        file = subprocess.run(
            [
                program,
                "sweep",
                "s4_pinch",
                *ARGUMENTS,
                "--for",
                "slurm",
                "--shards",
                "3",
                "--threads",
                "1",
                "--time-limit",
                "5:00",
                "--out",
                str(out),
            ],
            stdout=subprocess.PIPE,
            text=True,
            check=True,
        ).stdout
        (tmp_path / "job.sh").write_text(file)
        said = slurm.run("sbatch", "--parsable", "job.sh", cwd=tmp_path)
        assert said.returncode == 0, said.stdout
        job = said.stdout.strip()
        deadline, requeued = time.time() + 240, 0
        while slurm.run("squeue", "-h", "-j", job).stdout.strip() and time.time() < deadline:
            running = slurm.run("squeue", "-h", "-t", "R", "-o", "%A_%a|%F_%K", "-j", job).stdout.split()
            if running and requeued < 2:
                requeued += slurm.run("scontrol", "requeue", running[0].split("|")[1]).returncode == 0
            time.sleep(0.5)
        shards = sorted(out.glob("shard-*"))
        merged = subprocess.run(
            [program, "sweep", "merge", *map(str, shards), "--out", str(out)],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )
        assert merged.returncode == 0, merged.stdout + "\n".join(path.read_text() for path in tmp_path.glob("*.log"))
        assert requeued > 0 and (out / "sweep.db").read_bytes() == whole(program, tmp_path / "whole")
    finally:
        slurm.close()


def test_dask_goes_on_where_a_worker_was_killed(program, tmp_path):
    distributed = pytest.importorskip("distributed")
    port = free_port()
    env = {**os.environ, "PYTHONPATH": str(BUILD / "python")}
    python = "/usr/bin/python3"
    commands = [["-m", "distributed.cli.dask_scheduler", "--port", str(port), "--no-dashboard"]]
    commands += [
        [
            "-m",
            "distributed.cli.dask_worker",
            f"tcp://127.0.0.1:{port}",
            "--nthreads",
            "1",
            "--no-dashboard",
            "--no-nanny",
            "--local-directory",
            str(tmp_path),
        ]
    ] * 2
    processes = [
        subprocess.Popen(
            [python, *command], env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=tmp_path
        )
        for command in commands
    ]
    try:
        with distributed.Client(f"tcp://127.0.0.1:{port}", timeout="60s") as client:
            client.wait_for_workers(2, timeout=60)
            import threading

            killer = threading.Timer(random.uniform(0.1, 0.4), processes[1].kill)
            killer.start()
            sweep = pincer.sweep(
                "s4_pinch", VARY, measures=["sphere.p_z"], client=client, chunk_size=1, out=tmp_path / "out"
            )
            killer.join()
            assert processes[1].wait(timeout=30) == -signal.SIGKILL
        assert (tmp_path / "out/sweep.db").read_bytes() == whole(program, tmp_path / "whole")
        assert np.array_equal(pincer.read_sweep(tmp_path / "whole").table, sweep.table)
    finally:
        for process in processes:
            process.kill()
            process.wait()
