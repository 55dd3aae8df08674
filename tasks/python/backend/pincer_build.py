"""The build back-end of `pip install ./tasks/python` (PEP 517): CMake builds the module, and this packs it into a wheel.

Needs what tasks/demo needs (.ci/packages, "build"): pip can't install a compiler or Eigen.
PINCER_BUILD_DIR: folder of a CMake tree to use or keep; without it one is made in a temporary place.
"""

import base64
import hashlib
import os
import pathlib
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

HERE = pathlib.Path(__file__).resolve().parent.parent
SOURCES = HERE.parent.parent
VERSION = "0.1.0"
METADATA = f"""Metadata-Version: 2.1
Name: pincer
Version: {VERSION}
Summary: Multi-finger manipulation physics
License: BSD-3-Clause
Requires-Python: >=3.9
Requires-Dist: numpy
"""


def _tag():
    version = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{version}-{version}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def _run(*command):
    try:
        subprocess.run([str(word) for word in command], check=True)
    except FileNotFoundError:
        raise SystemExit(f'pincer: {command[0]} is missing. Install what .ci/packages lists for "build".') from None
    except subprocess.CalledProcessError:
        raise SystemExit(
            'pincer: the build failed; its messages are above. It needs the packages that .ci/packages lists for "build".'
        ) from None


def configure(folder):
    """Makes a CMake tree for the module in `folder`."""
    _run(
        "cmake",
        "-S",
        SOURCES,
        "-B",
        folder,
        "-G",
        "Ninja",
        "-DPINCER_TESTS=OFF",
        "-DPINCER_PYTHON=ON",
        f"-DPython_EXECUTABLE={sys.executable}",
    )


def _build(folder):
    """Builds the module with CMake in `folder`; returns the package's folder."""
    folder = pathlib.Path(folder)
    if not (folder / "build.ninja").exists():
        configure(folder)
    _run("cmake", "--build", folder, "--target", "pincer_python")
    package = folder / "python" / "pincer"
    module = "_core" + sysconfig.get_config_var("EXT_SUFFIX")
    if not (package / module).exists():
        raise SystemExit(
            f"pincer: {folder} was configured for another Python than {sys.executable}: it has no {module}. "
            "Leave PINCER_BUILD_DIR out, or name a folder that isn't there yet."
        )
    return package


def _record(name, data):
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(data)}\n"


def _pack(package, wheel_directory):
    name = f"pincer-{VERSION}-{_tag()}.whl"
    info = f"pincer-{VERSION}.dist-info"
    files = {f"pincer/{path.relative_to(package)}": path.read_bytes() for path in sorted(_files(package))}
    files[f"{info}/METADATA"] = METADATA.encode()
    files[
        f"{info}/WHEEL"
    ] = f"Wheel-Version: 1.0\nGenerator: pincer_build\nRoot-Is-Purelib: false\nTag: {_tag()}\n".encode()
    record = "".join(_record(path, data) for path, data in files.items()) + f"{info}/RECORD,,\n"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, data in files.items():
            wheel.writestr(path, data)
        wheel.writestr(f"{info}/RECORD", record)
    return name


def _files(package):
    """The package's files; links are followed, caches left out."""
    for folder, folders, names in os.walk(package, followlinks=True):
        folders[:] = [f for f in folders if f != "__pycache__"]
        yield from (pathlib.Path(folder) / name for name in names)


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    kept = os.environ.get("PINCER_BUILD_DIR")
    if kept:
        return _pack(_build(kept), wheel_directory)
    with tempfile.TemporaryDirectory() as folder:
        return _pack(_build(folder), wheel_directory)


def build_sdist(sdist_directory, config_settings=None):
    raise SystemExit("pincer: a source package of the module alone can't be built; take the whole repository.")
