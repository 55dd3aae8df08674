"""Where the module under test is, and the program beside it: build/ unless PINCER_BUILD says otherwise."""

import os
import pathlib
import sys

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("PINCER_BUILD", SOURCE / "build"))
sys.path.insert(0, str(BUILD / "python"))


@pytest.fixture(scope="session")
def program():
    return str(BUILD / "pincer")


@pytest.fixture(scope="session")
def pinch():
    import pincer

    return pincer.load("s4_pinch")


def pytest_addoption(parser):
    parser.addoption("--cluster", action="store_true", help="also tests on a Slurm and a Dask cluster of this machine")
    parser.addoption("--long", action="store_true", help="also tests of a million steps and fifty kills")


def pytest_collection_modifyitems(config, items):
    asked = {name for name in ("cluster", "long") if config.getoption(f"--{name}")}
    if os.environ.get("PINCER_LONG_TESTS"):  # tests/run --long
        asked.add("long")
    for item in items:
        for name in {"cluster", "long"} - asked:
            if name in item.keywords:
                item.add_marker(pytest.mark.skip(reason=f"needs --{name}"))
