#!/usr/bin/python3
"""Opens pages of `pincer share` in headless Chromium and looks: is everything there, does it move, is the console silent?

    tests/browser/pages.py PINCER FOLDER [SCENE ...]        (without SCENE: those of the gallery, docs/site/build)

Each scene's page is drawn beside what pincer itself draws (`pincer sim --screenshot`) at the same time from the same place: coloured pixels, which
are bodies, fingers and forces, must be in the same places. Another picture in the middle of the run must differ where things move. A page whose
data was cut must say so. A session's page must have its trials.
"""
import importlib.machinery
import importlib.util
import json
import pathlib
import re
import subprocess
import sys

import matplotlib.image
import numpy

from chromium import Chromium

WIDTH, HEIGHT = 1280, 720  # as pincer draws
BEGIN = 0.02               # [s]: contacts are there, and nothing has gone far from where the camera was placed for
STANDING = {"masonry_arch", "stack_of_ten"}  # scenes in which nothing is to be seen to move
# Two renderers: borders are smoothed otherwise, light and its tone differ, arrows are a few pixels wide.
OVERLAP = 0.8
# True once the page has drawn its first picture, or says why it can't.
DRAWN = "!!(document.getElementById('clock')?.textContent || document.querySelector('.fault'))"


def opened(browser, page, address, picture, bare):
    """The picture of a page, as numbers, and what its console said."""
    png, said = browser.picture(f"file://{page}#{address}{'&bare' if bare else ''}", DRAWN)
    picture.write_bytes(png)
    return matplotlib.image.imread(picture)[..., :3], said


def coloured(image):
    """Where a picture has colour: neither the floor nor the sky has."""
    return image.max(axis=2) - image.min(axis=2) > 0.22 * image.max(axis=2)  # skin has 0.27, the sky of the window 0.15


def overlap(a, b):
    return (a & b).sum() / max((a | b).sum(), 1)


def run(*command):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True)


def check_scene(browser, pincer, folder, scene, seconds):
    page = folder / f"{scene}.html"
    shared = run(pincer, "share", scene, "--duration", seconds, "--out", page)
    assert shared.returncode == 0, shared.stderr
    assert page.stat().st_size < 5e6, f"{page.stat().st_size} bytes"
    run(pincer, "sim", scene, "--duration", BEGIN, "--from-operator", "--screenshot", folder / f"{scene}-own.png")
    own = matplotlib.image.imread(folder / f"{scene}-own.png")[..., :3]
    begin, said = opened(browser, page, f"t={BEGIN}", folder / f"{scene}-begin.png", True)
    assert not said, said
    same = overlap(coloured(own), coloured(begin))
    middle, said = opened(browser, page, f"t={seconds / 2}", folder / f"{scene}-middle.png", True)
    assert not said, said
    moved = (abs(begin - middle).max(axis=2) > 0.1).mean()
    print(f"{scene}: {1e-6 * page.stat().st_size:.2f} MB, {100 * coloured(begin).mean():.1f} % coloured, overlap with pincer's own picture {same:.3f}, "
          f"moved by the middle {1000 * moved:.1f} per mille", flush=True)
    assert coloured(begin).mean() > 0.003, "nothing is seen"
    assert same > OVERLAP
    if scene not in STANDING:
        assert moved > 0.001, "nothing moves"


def check_damage(browser, folder):
    """The console is heard: a page whose data ends too early says so, and the picture has the sentence."""
    whole = (folder / "pickup.html").read_text()
    cut = folder / "cut.html"
    cut.write_text(re.sub(r'(id="pincer-data">.{2000})[^<]*', r"\1", whole))
    _, said = opened(browser, cut, "t=0", folder / "cut.png", False)
    assert said, "a damaged page says nothing"
    print(f"damaged page: {said[0][:110]}", flush=True)


def check_session(browser, pincer, folder):
    out = folder / "session"
    ran = run(pincer, "run", "sphere-pickup", "--repetitions", 1, "--friction", 0.9, "--condition", "cld+force", "--seed", 7, "--out", out, "--no-report")
    assert ran.returncode == 0, ran.stderr
    reported = run(pincer, "report", out / "session.db", "--web")
    assert reported.returncode == 0, reported.stderr
    page = out / "report_replay.html"
    links = re.findall(r'<td><a href="([^"#]*)#shown=(\d+)">(\d+)</a></td>', (out / "report.html").read_text())
    assert links == [(page.name, "1", "1")], links
    picture, said = opened(browser, page, "t=3&shown=1", folder / "session.png", False)
    assert not said, said
    index = json.loads(re.search(r'id="pincer-index">(.*?)</script>', page.read_text(), re.S)[1])
    trials = len(index["recordings"])
    print(f"session: {1e-6 * page.stat().st_size:.2f} MB, linked from its report, trials {trials}, {100 * coloured(picture).mean():.1f} % coloured", flush=True)
    assert page.stat().st_size < 5e6
    assert trials >= 1 and coloured(picture).mean() > 0.01


def gallery():
    """The scenes of the documentation's gallery, and how many seconds of each."""
    path = str(pathlib.Path(__file__).resolve().parents[2] / "docs/site/build")
    loader = importlib.machinery.SourceFileLoader("site_build", path)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("site_build", loader))
    loader.exec_module(module)
    return module.GALLERY


def main():
    pincer, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    with Chromium(folder, WIDTH, HEIGHT) as browser:
        for scene in sys.argv[3:] or gallery():
            check_scene(browser, pincer, folder, scene, gallery().get(scene, 2))
        if len(sys.argv) == 3:
            check_damage(browser, folder)
            check_session(browser, pincer, folder)


if __name__ == "__main__":
    main()
