"""The examples run, and pip installs what they import."""

import os
import pathlib
import re
import subprocess
import sys
import textwrap

import numpy as np
import pytest

from conftest import BUILD, SOURCE

EXAMPLES = sorted((SOURCE / "tasks/python/examples").glob("*.py"))
PACKAGE = SOURCE / "tasks/python/pincer"


def test_there_are_eight():
    assert len(EXAMPLES) == 8


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_example(example, program, tmp_path):
    if example.stem.startswith("02"):
        pytest.importorskip("matplotlib")
    if example.stem.startswith("08"):
        pytest.importorskip("pandas")
    env = {**os.environ, "PYTHONPATH": str(BUILD / "python"), "TMPDIR": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, str(example), program],
        env=env,
        cwd=SOURCE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    if "OpenGL" in done.stdout and done.returncode != 0:
        pytest.skip("no OpenGL here")
    assert done.returncode == 0, done.stdout


def test_pip_installs_it(tmp_path):
    """PEP 517 in a virtual environment without a network, as docs/python.md says; with the libraries of the build that is there."""
    subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", str(tmp_path / "venv")], check=True)
    env = {**os.environ, "PINCER_BUILD_DIR": str(BUILD)}
    env.pop("PYTHONPATH", None)
    done = subprocess.run(
        [
            str(tmp_path / "venv/bin/pip"),
            "install",
            "--no-index",
            "--no-build-isolation",
            str(SOURCE / "tasks/python"),
        ],
        env=env,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout
    code = (
        "import pincer, pincer.env; m = pincer.load('s4_pinch'); s = pincer.State(m); pincer.step(m, s, 10); "
        "pincer.env.make('PincerPinchLift-v0').reset(seed=1); print(pincer.__file__)"
    )
    said = subprocess.run(
        [str(tmp_path / "venv/bin/python"), "-c", code],
        env=env,
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    ).stdout
    installed = pathlib.Path(said.strip()).parent
    assert tmp_path / "venv" in installed.parents
    wanted = {str(path.relative_to(PACKAGE)) for path in PACKAGE.rglob("*") if path.is_file() and path.suffix != ".pyc"}
    there = {str(path.relative_to(installed)) for path in installed.rglob("*") if path.suffix not in (".pyc", ".so")}
    assert wanted <= there and {"py.typed", "__init__.pyi", "env/tasks.py"} <= wanted
    assert len(list(installed.glob("_core*.so"))) == 1


@pytest.mark.long
def test_pip_configures_a_tree_of_its_own(tmp_path):
    """Without a build at hand the back-end makes one: CMake takes its options, and the module can be built there."""
    sys.path.insert(0, str(SOURCE / "tasks/python/backend"))
    try:
        import pincer_build

        pincer_build.configure(tmp_path)
    finally:
        sys.path.pop(0)
    planned = subprocess.run(
        ["ninja", "-C", str(tmp_path), "-t", "commands", "pincer_python"], stdout=subprocess.PIPE, text=True, check=True
    ).stdout
    assert "-o python/pincer/_core." in planned


def test_the_pages_python_runs():
    """Every block of docs/python.md that is Python, in order, in one namespace."""
    page = (SOURCE / "docs/python.md").read_text()
    blocks = re.findall(r"(?:^    .*\n(?:\n(?=    ))?)+", page, flags=re.MULTILINE)
    python = [
        textwrap.dedent(block) for block in blocks if not block.strip().startswith(("PYTHONPATH=", "/usr/bin/python3"))
    ]
    assert len(python) == 3
    import pincer

    pinch = pincer.load("s4_pinch")
    names = {"states": [pincer.State(pinch)] * 2, "controls": np.full((2, 5, pinch.ncontrol), np.nan)}
    before = os.getcwd()
    os.chdir(SOURCE)
    try:
        for block in python:
            if "rollout" in block:
                names["model"] = pinch
            exec(block, names)
    finally:
        os.chdir(before)
    assert names["result"].state.shape == (2, 5, pinch.nstate) and names["report"].ok


def test_every_name_is_documented_and_typed():
    import pincer

    stub = (SOURCE / "tasks/python/pincer/__init__.pyi").read_text()
    for name in pincer.__all__:
        if name == "__version__":
            continue
        value = getattr(pincer, name)
        assert f"class {name}" in stub or f"def {name}(" in stub, f"{name} isn't in __init__.pyi"
        assert value.__doc__, f"{name} has no docstring"
        if isinstance(value, type) and name not in ("InputError", "Status", "RolloutResult", "StepReport"):
            for member in (m for m in vars(value) if not m.startswith("_")):
                block = re.split(f"\nclass {name}[:(]", stub)[1].split("\nclass ", 1)[0]
                assert f"def {member}(" in block or f"    {member}:" in block, f"{name}.{member} isn't in __init__.pyi"
    import ast

    ast.parse(stub)
    assert {name for name in pincer.Status.__members__} <= {line.split("=")[0].strip() for line in stub.splitlines()}


def test_docs_first_lines_run(tmp_path):
    """The indented Python of docs/python.md whose names it defines itself."""
    page = (SOURCE / "docs/python.md").read_text()
    block = page.split("# Python\n\n", 1)[1].split("\n\n", 1)[0]
    env = {**os.environ, "PYTHONPATH": str(BUILD / "python")}
    code = "\n".join(line[4:] for line in block.splitlines())
    rollout = "\nresult = pincer.rollout(model, state, nstep=5, threads=2)\n"
    subprocess.run([sys.executable, "-c", code + rollout], env=env, stdout=subprocess.DEVNULL, check=True)
