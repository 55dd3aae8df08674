#!/usr/bin/python3
"""The page that computes, in headless Chromium: are its bits those of a native build, and can a mouse pick the ball up?

    tests/browser/play.py PAGE FOLDER

A scripted mouse squeezes, lifts and carries the ball, lets it go, and pulls the held ball of the other scene. Its pictures stay in FOLDER.
"""
import pathlib
import sys

from chromium import Chromium

BALL = "play.recording.groups[1].matrices[0].slice(9).map((column) => column[0])"  # its place in W [m]


def shown_at(page, place):
    """Where a place in W is in the window [pixels]."""
    return page.value(f"""(() => {{
        const {{ camera, canvas }} = play.stage, box = canvas.getBoundingClientRect();
        const p = play.wish.p.clone().set({place[0]}, {place[1]}, {place[2]}).project(camera);
        return [box.left + (1 + p.x) / 2 * box.width, box.top + (1 - p.y) / 2 * box.height]; }})()""")


def point(page, place, held, kind="mouseMoved"):
    page.mouse(kind, *shown_at(page, place), held)


def wait_ticks(page, ticks):
    """On a busy machine the page has fewer of them in a second than a thousand."""
    page.wait_for(f"play.ticks > {page.value('play.ticks') + ticks}")


def settled(page):
    """Until the ball moves by less than 10 um in a second of its own."""
    last = page.value(BALL)
    for _ in range(20):
        wait_ticks(page, 1000)
        now = page.value(BALL)
        if max(abs(a - b) for a, b in zip(now, last)) < 1e-5:
            return now
        last = now
    raise AssertionError(f"the ball doesn't come to rest: {now}")


def picks_up(page, folder):
    middle = (0, 0, 0.02)
    point(page, middle, False)
    point(page, middle, True, "mousePressed")
    page.wait_for("play.numbers(play.module._playNumbers(), 8)[0] > 1.5")
    for i in range(1, 11):
        point(page, (0.002 * i, 0, 0.02 + 0.004 * i), True)
        wait_ticks(page, 100)
    lifted = settled(page)
    (folder / "play-lifted.png").write_bytes(page.png())
    assert abs(lifted[0] - 0.02) < 2e-3 and abs(lifted[2] - 0.06) < 3e-3, lifted
    point(page, (0.02, 0, 0.06), False, "mouseReleased")
    wait_ticks(page, 1000)
    dropped = page.value(BALL)  # it rolls to and fro
    assert dropped[2] < 0.03, dropped
    print(f"picked up to {1e3 * lifted[2]:.1f} mm, let go to {1e3 * dropped[2]:.1f} mm", flush=True)


def pulls(page, folder):
    page.value("document.getElementById('scene').value = 'pinch'; document.getElementById('scene').dispatchEvent(new Event('change'))")
    page.wait_for("play.recording.camera.target[2] > 0.08")
    wait_ticks(page, 20)
    start = page.value(BALL)
    point(page, start, True, "mousePressed")
    point(page, (0, 0, 0.1 + 0.02), True)  # 1.2 N up, and 0.98 N of weight down
    wait_ticks(page, 500)
    (folder / "play-held.png").write_bytes(page.png())
    held = page.value(BALL)
    assert max(abs(a - b) for a, b in zip(start, held)) < 1e-9, (start, held)
    point(page, (0, 0, 0.1 - 0.03), True)  # 1.8 N down besides
    wait_ticks(page, 500)
    slipped = page.value(BALL)
    assert slipped[2] < start[2] - 1e-3, slipped
    point(page, (0, 0, 0.07), False, "mouseReleased")
    print("held against 1.2 N, slips under 2.8 N", flush=True)


def main():
    page_file, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    with Chromium(folder, 1280, 720) as browser, browser.page(f"file://{page_file}", "!!window.play?.cost") as page:
        bits = page.value("document.getElementById('bits').textContent")
        print(bits, flush=True)
        assert bits.count("the same to the bit") == 2, bits
        picks_up(page, folder)
        pulls(page, folder)
        print(page.value("document.getElementById('numbers').textContent"), flush=True)
        assert page.value("play.numbers(play.module._playNumbers(), 8)[7]") == 0, "flagged ticks"
        said = browser.said()
        assert not said, said
    assert page_file.stat().st_size < 5e6


if __name__ == "__main__":
    main()
