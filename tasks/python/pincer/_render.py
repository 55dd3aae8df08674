"""Pictures without a display."""

from pincer import _core

_last = None  # renderer of the last call: making one takes as long as some pictures


def render(model, state, width=640, height=480, camera=None, *, forces=True):
    """A picture of the state: uint8 array (height, width, 3), red, green, blue.

    camera: pincer.Camera; None: so that all that moves is seen. forces: with contacts, friction cones and force arrows.
    Keeps the renderer of the last model and size. For several at once, or from other threads, make a pincer.Renderer each.
    """
    global _last
    import threading

    key = (id(model), width, height, threading.get_ident())
    if _last is None or _last[0] != key:
        _last = None
        _last = (key, model, _core.Renderer(model, width, height))
    return _last[2].render(state, camera, forces)
