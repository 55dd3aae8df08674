"""Models from files, names and dictionaries."""

import json
import os

from pincer import _core


def load(scene, *, name="scene"):
    """The model of a scene.

    scene: name of a built-in scene ("s4_pinch"), path of a scene file or of a robot's (docs/robots.md), or a dict with the keys of a
           scene file (docs/scenes.md).
    name:  of a dict's scene in messages; files that it names are relative to the folder of `name`.
    Raises InputError that says what is wrong, where, and what helps.
    """
    name, text = scene_text(scene, name)
    return _core.load_text(text, name) if text else _core.load_file(name)


def scene_text(scene, name="scene"):
    """Name and text of a dict's scene; of a file or built-in scene its path or name, and no text."""
    if not isinstance(scene, dict):
        return os.fspath(scene), ""
    try:
        return name, json.dumps(scene, indent=1, default=_plain, allow_nan=False)
    except ValueError as error:
        raise _core.InputError(
            f"{name}: a number of the scene isn't finite, or a value isn't one of JSON's: {error}."
        ) from None


def _plain(value):
    """NumPy's arrays and numbers as JSON has them."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"a scene can't hold a {type(value).__name__}; numbers, texts, lists and dicts can be in it")
