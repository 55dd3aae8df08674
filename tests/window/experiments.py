#!/usr/bin/python3
"""Every experiment by a person at a window: under Xvfb, with a scripted mouse and keyboard.

    tests/window/experiments.py PINCER FOLDER [EXPERIMENT ...]        (without EXPERIMENT: all seven)

Each is begun, its instructions read, the training done, and counted trials; then the program is killed, goes on, is left with Esc, and what was done
comes again to the bit. The person looks at the screen and waits until it has changed before going on, so that a slow machine only takes longer.
With two fingers the person does what the window's hint says, and nothing else: who obeys it picks up spheres and turns cylinders.
Pictures of what was seen stay in FOLDER; in a counted trial with one finger neither object nor finger is in them.
"""
import pathlib
import signal
import sqlite3
import subprocess
import sys
import time

import matplotlib.ft2font
import matplotlib.image
import numpy

WIDTH, HEIGHT = 1280, 720
ONE_FINGER = ["smoothness-discrimination", "backlash-discrimination", "delay-discrimination", "repeated-localisation", "shape-identification"]
TWO_FINGERS = ["sphere-pickup", "cylinder-alignment"]
TRIALS = 3
PANEL, TACTOR, RING = (56, 61, 67), (20, 24, 30), (20, 140, 60)  # as the overlay paints them
PAD = (slice(30, 200), slice(1100, 1264))                       # of the screen
MOST_GESTURES = 40
HINT = (slice(38, 58), slice(320, 960))                        # of the screen: the green line
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"       # the window's
STEP = 8                                                       # of a hand that follows a hint [pixels]
# What the hints ask for, by the text's width on the screen: of both tasks, and of sphere pickup or cylinder alignment alone.
HINTS = {
    "Lower the fingers beside the object": "down",
    "Let go: the fingers are closed, and not around the object": "let go",
    "It is farther away: Shift and the mouse upwards, or Page up": "away",
    "It is nearer to you: Shift and the mouse downwards, or Page down": "near",
    "It is on the right: move there": "right",
    "It is on the left: move there": "left",
    "Squeeze: hold the left button, or G": "squeeze",
}
LIFTING = {
    "Too low: a finger touches the dish. Up a little": "up",
    "One finger touches: go the other way a little": "wait",
    "Lift it to the line": "up",
    "Hold it there for a second": "wait",
}
TURNING = {
    "Turn to the left: Q, or Control and the mouse": "q",
    "Turn to the right: E, or Control and the mouse": "e",
    "So far the hand goes: let go, turn it back with E, squeeze again": "let go, e",
    "So far the hand goes: let go, turn it back with Q, squeeze again": "let go, q",
    "Turn the hand back to the right: E": "e",
    "Turn the hand back to the left: Q": "q",
    "The flat faces the monitor: Enter answers": "answer",
}


class Screen:
    """An X server whose picture lies in a file."""

    def __init__(self, folder):
        self.folder = folder
        display = folder / "display"
        with open(display, "w") as file:
            self.server = subprocess.Popen(["Xvfb", "-displayfd", "1", "-screen", "0", f"{WIDTH}x{HEIGHT}x24", "-fbdir", folder, "-nolisten", "tcp",
                                            "-noreset"], stdout=file, stderr=subprocess.DEVNULL)
        wait_until(lambda: display.read_text().strip(), "Xvfb has no display")
        self.environment = {"DISPLAY": ":" + display.read_text().strip()}
        self.file = folder / "Xvfb_screen0"
        self.programs = []

    def look(self):
        """What is on the screen, as numbers: rows, columns, red green blue. The file is a window dump, big-endian, its colours blue first."""
        data = numpy.fromfile(self.file, numpy.uint8)
        head = data[:80].view(">u4")
        pixels = data[int(head[0] + 12 * head[19]):][:int(head[12]) * HEIGHT]
        return pixels.reshape(HEIGHT, -1, 4)[:, :WIDTH, 2::-1].astype(int)

    def save(self, name):
        matplotlib.image.imsave(self.folder / f"{name}.png", self.look().astype(numpy.uint8))

    def end_programs(self):
        for program in self.programs:
            if program.poll() is None:
                program.kill()
                program.wait()
        self.programs.clear()

    def close(self):
        self.server.terminate()


def wait_until(condition, complaint, seconds=60):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, complaint
        time.sleep(0.05)


def near(picture, colour, by=14):
    return (abs(picture - numpy.array(colour)).max(axis=2) <= by)


def middle_row(mask, least):
    """Of the pixels that are meant; None where there are too few."""
    rows = numpy.nonzero(mask)[0]
    return rows.mean() if len(rows) >= least else None


def text_width(text, font=matplotlib.ft2font.FT2Font(FONT)):
    """In units in which the window's letters are 1 pixel (kFontSize of tasks/view/overlay_imgui.cpp)."""
    font.set_size(100, 72)
    return 0.1282 * sum(font.load_char(ord(letter)).linearHoriAdvance for letter in text) / 65536


class Person:
    def __init__(self, screen, program):
        self.screen, self.program = screen, program
        self.x, self.y = 640, 300
        self.turns = False  # a cylinder, else it lifts a sphere

    def alive(self):
        return self.program.poll() is None

    def do(self, *words):
        subprocess.run(["xdotool", *[str(word) for word in words]], env={**self.screen.environment, "PATH": "/usr/bin:/bin"}, check=True)

    def wait(self, pictures=2, seconds=4):
        """Until so many new pictures were shown, or nothing changes."""
        before, end = self.screen.look(), time.monotonic() + seconds
        while pictures > 0 and time.monotonic() < end and self.alive():
            time.sleep(0.03)
            now = self.screen.look()
            if (now != before).any():
                before, pictures = now, pictures - 1

    def move(self, x, y, step=8):
        """As a hand does, not in a jump."""
        count = max(1, round(max(abs(x - self.x), abs(y - self.y)) / step))
        words = []
        for i in range(1, count + 1):
            words += ["mousemove", round(self.x + (x - self.x) * i / count), round(self.y + (y - self.y) * i / count), "sleep", 0.02]
        self.do(*words)
        self.x, self.y = round(x), round(y)

    def press(self, key):
        self.do("key", key)
        self.wait()

    def sees_page(self):
        picture = self.screen.look()[270:330, 500:780]
        return near(picture, PANEL, 10).mean() > 0.5

    def read_pages(self):
        while self.sees_page() and self.alive():
            self.press("Return")
            self.wait(1, 1)

    def begin_gesture(self):
        """The pointer where there is room on every side: a first movement only tells the window where it is."""
        self.do("mousemove", 641, 300, "mousemove", 640, 300)
        self.x, self.y = 640, 300
        self.wait(3)

    def stroke(self, depth, name):
        self.move(640, 300 + depth)
        self.move(720, self.y)
        if name:
            self.screen.save(name)
        self.move(580, self.y)
        self.move(640, 300)
        self.wait(3)
        time.sleep(0.3)

    def compare(self, depth, name):
        """Two intervals, then which."""
        self.begin_gesture()
        for _ in range(2):
            self.stroke(depth, name)
            self.press("Return")
            time.sleep(0.8)
            self.wait(3)
        self.press("1")
        self.press("Return")
        self.wait(3)

    def name_solid(self, depth, name):
        self.begin_gesture()
        time.sleep(1)
        self.stroke(depth, name)
        self.press("1")
        self.wait(3)

    def tactor(self):
        return middle_row(near(self.screen.look()[PAD], TACTOR), 40)

    def ring(self):
        return middle_row(near(self.screen.look()[PAD], RING), 20)

    def roll_to(self, wanted, done, settling=0.0):
        """Until the dot is in the row that `wanted` tells, then Enter, deeper each time until it counts, which shows `settling` seconds later."""
        for _ in range(60):
            if done() or not self.alive():
                return
            place, aim = self.tactor(), wanted()
            if place is None or aim is None:
                self.wait(2)
                continue
            off = aim - place
            if abs(off) > 0.5:
                self.move(min(max(self.x + 4 * min(max(off, -12), 12), 40), 1240), self.y)
                self.wait(3)
                continue
            self.press("Return")
            time.sleep(settling)
            if not done():
                self.move(self.x, min(self.y + 12, 700))
                self.wait(3)

    def localise(self, depth, name, over):
        self.begin_gesture()
        self.wait(3)
        memory = []

        def kept():
            if self.ring() is not None:
                memory[:] = [self.tactor()]
            return self.ring() is None and bool(memory)

        self.roll_to(self.ring, kept)
        if name:
            self.screen.save(name)
        self.move(self.x, max(self.y - 140, 20))
        self.wait(4)
        time.sleep(1)
        if memory and memory[0] is not None:
            self.roll_to(lambda: memory[0], over, 1.5)  # a movement in the next trial's window would take its finger along
        self.wait(3)

    def hints(self):
        return HINTS | (TURNING if self.turns else LIFTING)

    def hint(self):
        """The hint that is as wide as what is written in green; None: there is none."""
        picture = self.screen.look()[HINT]
        columns = numpy.nonzero(((picture[..., 1] > picture[..., 0] + 60) & (picture[..., 1] > picture[..., 2] + 60)).any(axis=0))[0]
        if len(columns) == 0:
            return None
        width = columns[-1] - columns[0] + 1
        return min(self.hints(), key=lambda text: abs(text_width(text) - width))

    def obey(self, hint, held):
        """Does what the hint says; returns whether the fingers are squeezed."""
        asked = self.hints().get(hint, "wait")
        ways = {"down": (0, STEP), "up": (0, -STEP), "left": (-STEP, 0), "right": (STEP, 0), "away": (0, -STEP), "near": (0, STEP)}
        if asked.startswith("let go"):
            self.do("mouseup", 1)
            time.sleep(0.6)
            return False
        if asked in ways:
            shift = asked in ("away", "near")
            self.do(*(["keydown", "shift"] if shift else ["sleep", 0]))
            self.move(self.x + ways[asked][0], self.y + ways[asked][1], 4)
            self.do(*(["keyup", "shift"] if shift else ["sleep", 0]))
        elif asked == "squeeze":
            if held:  # it was squeezed, and is to be squeezed again: it has slipped out
                self.do("mouseup", 1)
                time.sleep(0.6)
            self.do("mousedown", 1)
            time.sleep(1.8)  # the fingers close at 0.1 m/s
            return True
        elif asked in ("q", "e"):
            self.do("key", "--repeat", 3, "--delay", 60, asked)
        elif asked == "answer":
            self.press("Return")
        self.wait(2, 0.5)
        return held

    def manipulate(self, name, over):
        """One trial, as the hints say; the pointer first where there is room on every side, before the trial begins."""
        self.do("mouseup", 1, "mousemove", 640, 360)
        self.x, self.y = 640, 360
        held, said = False, []
        while not over() and self.alive():
            hint = self.hint()
            if hint and hint not in said:
                said.append(hint)
                self.screen.save(f"{name}-{len(said)}")
            held = self.obey(hint, held)
        self.do("mouseup", 1)
        time.sleep(0.3)


def rows_of(session, query):
    with sqlite3.connect(f"file:{session}?mode=ro", uri=True, timeout=20) as database:
        return database.execute(query).fetchall()


def counted(session):
    """Whole trials that aren't training."""
    try:
        with sqlite3.connect(f"file:{session}?mode=ro", uri=True, timeout=20) as database:
            tables = {row[0] for row in database.execute("select name from sqlite_master where type='table'")}
            for table in ("response", "trial"):
                if table not in tables:
                    continue
                columns = {row[1] for row in database.execute(f"pragma table_info({table})")}
                where = " where training = 0" if "training" in columns else ""
                count = database.execute(f"select count(*) from {table}{where}").fetchone()[0]
                if count:
                    return count
    except sqlite3.Error:
        pass  # not there yet, or being written
    return 0


def begun(pincer, screen, experiment, *options):
    output = open(screen.folder / f"{experiment}.out", "a")
    if experiment in TWO_FINGERS and not options:  # a slow machine takes longer, and doesn't fail for it
        study = screen.folder / "patient.json"
        study.write_text('{"sphere_pickup": {"timeout": 600}, "cylinder_alignment": {"timeout": 600}}')
        options = ("--study", study)
    program = subprocess.Popen([pincer, "run", experiment, "--devices", "mouse", "--view", "--out", screen.folder / experiment, *options],
                               env={**screen.environment, "PATH": "/usr/bin:/bin", "HOME": str(screen.folder)}, stdout=output, stderr=output)
    screen.programs.append(program)

    def has_window():
        assert program.poll() is None, (screen.folder / f"{experiment}.out").read_text()
        found = subprocess.run(["xdotool", "search", "--name", "^pincer"], env={**screen.environment, "PATH": "/usr/bin:/bin"}, capture_output=True)
        return found.returncode == 0

    wait_until(has_window, f"{experiment} opens no window")
    wait_until(lambda: screen.look().std() > 1 or program.poll() is not None, f"{experiment} draws nothing")  # the window is there first
    person = Person(screen, program)
    person.wait(2)
    return person


def do_trials(person, experiment, wanted):
    session = person.screen.folder / experiment / "session.db"
    for gesture in range(MOST_GESTURES):
        done = counted(session)
        if done >= wanted:
            return
        assert person.alive(), (person.screen.folder / f"{experiment}.out").read_text()
        person.read_pages()
        trains = gesture == 0 and not done  # the first thing that is felt
        depth, name = 72 + 16 * (gesture % 5), f"{experiment}-{'training' if trains else 'trial'}"
        if experiment in TWO_FINGERS:
            person.turns = experiment == "cylinder-alignment"
            person.manipulate(name, lambda: counted(session) > done or person.sees_page())
        elif experiment == "shape-identification":
            person.name_solid(depth, name)
        elif experiment == "repeated-localisation":
            person.localise(depth, name, lambda: counted(session) > done or person.sees_page() or person.ring() is not None)
        else:
            person.compare(depth, name)
    assert counted(session) >= wanted, f"{experiment}: no {wanted} trials in {MOST_GESTURES} gestures"


def shows_something(folder, name):
    """Whether anything but the sky is below the panels and left of the fingerpad: the sky is the same all along a row. The pointer has some hundred pixels."""
    picture = (255 * matplotlib.image.imread(folder / f"{name}.png")[130:, :1040, :3]).astype(int)
    return (abs(picture - numpy.median(picture, axis=1, keepdims=True)).max(axis=2) > 12).sum() > 2000


def run_experiment(pincer, screen, experiment):
    folder = screen.folder
    subprocess.run(["rm", "-rf", folder / experiment, folder / f"{experiment}.out"], check=True)
    start = time.monotonic()
    person = begun(pincer, screen, experiment)
    screen.save(f"{experiment}-page")
    do_trials(person, experiment, TRIALS)
    person.program.send_signal(signal.SIGKILL)
    person.program.wait()
    before = counted(folder / experiment / "session.db")
    person = begun(pincer, screen, experiment, "--resume")
    screen.save(f"{experiment}-resumed")
    do_trials(person, experiment, before + 1)
    person.do("key", "Escape")
    code = person.program.wait(60)
    assert code == 5, f"{experiment}: exit code {code} after Esc\n" + (folder / f"{experiment}.out").read_text()
    replay = subprocess.run([pincer, "replay", folder / experiment / "session.db"], capture_output=True, text=True)
    assert replay.returncode == 0 and "The same to the bit" in replay.stdout, replay.stdout + replay.stderr
    if experiment in ONE_FINGER:  # on the mouse the two fingers are seen, unless --blind
        assert shows_something(folder, f"{experiment}-training"), f"neither object nor finger is seen in training: {experiment}-training.png"
        assert not shows_something(folder, f"{experiment}-trial"), f"object or finger is seen in a counted trial: {experiment}-trial.png"
    if experiment in TWO_FINGERS:
        outcomes = [row[0] for row in rows_of(folder / experiment / "session.db", "select outcome from trial where training = 0")]
        print(f"{experiment}: {outcomes}", flush=True)
        assert set(outcomes) == {"success"}, f"{experiment}: who does what the hints say fails: {outcomes}"
    print(f"{experiment}: {counted(folder / experiment / 'session.db')} trials, killed after {before}, resumed, left, the same to the bit; "
          f"{time.monotonic() - start:.0f} s", flush=True)


def main():
    pincer, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    screen = Screen(folder)
    failed = []
    try:
        for experiment in sys.argv[3:] or ONE_FINGER + TWO_FINGERS:
            try:
                run_experiment(pincer, screen, experiment)
            except AssertionError as error:
                failed.append(experiment)
                print(f"{experiment}: {error}", flush=True)
                screen.save(f"{experiment}-failed")
            finally:
                screen.end_programs()
    finally:
        screen.close()
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
