"""Headless Chromium, told over a pipe in its DevTools protocol: opens pages, waits for what they say, takes their pictures, hears their console."""
import base64
import contextlib
import json
import os
import subprocess
import time

PATIENCE = 150  # for an answer, on a machine however busy [s]


class Chromium:
    """One browser for all pages: `with Chromium(folder, width, height) as browser: ...`"""

    def __init__(self, folder, width, height):
        command_in, self.commands = os.pipe()
        self.answers, answer_out = os.pipe()
        os.set_inheritable(command_in, True)
        os.set_inheritable(answer_out, True)
        shell = f'exec 3<&{command_in} 4>&{answer_out} chromium "$@"'  # the protocol's descriptors are 3 and 4
        self.process = subprocess.Popen(
            ["bash", "-c", shell, "chromium", "--headless=new", "--remote-debugging-pipe", "--no-sandbox", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--hide-scrollbars", f"--window-size={width},{height}", f"--user-data-dir={folder / 'profile'}"],
            pass_fds=(command_in, answer_out), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(command_in)
        os.close(answer_out)
        self.size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.number, self.rest, self.events = 0, b"", []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        with contextlib.suppress(OSError):
            self.ask("Browser.close")
        os.close(self.commands)
        self.process.wait(PATIENCE)
        os.close(self.answers)

    def ask(self, method, session=None, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters} | ({"sessionId": session} if session else {})
        os.write(self.commands, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.next()
            if answer.get("id") == self.number:
                assert "error" not in answer, f"{method}: {answer['error']}"
                return answer["result"]
            self.events.append(answer)

    def next(self):
        while b"\0" not in self.rest:
            more = os.read(self.answers, 1 << 20)
            assert more, "the browser ended"
            self.rest += more
        text, self.rest = self.rest.split(b"\0", 1)
        return json.loads(text)

    @contextlib.contextmanager
    def page(self, address, drawn):
        """A page, once `drawn`, an expression of JavaScript, is true."""
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        page = Page(self, self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"])
        self.events.clear()
        for domain in ("Page", "Runtime", "Log"):
            page.ask(f"{domain}.enable")
        page.ask("Emulation.setDeviceMetricsOverride", **self.size)
        page.ask("Page.navigate", url=address)
        page.wait_for(drawn)
        yield page
        self.ask("Target.closeTarget", targetId=target)

    def picture(self, address, drawn):
        """The PNG of a page once it is drawn; and what its console said meanwhile."""
        with self.page(address, drawn) as page:
            return page.png(), self.said()

    def said(self):
        """Lines of the console, errors that nobody caught, and what the browser says of the page."""
        lines = []
        for event in self.events:
            parameters = event.get("params", {})
            if event.get("method") == "Runtime.consoleAPICalled":
                lines.append(" ".join(str(a.get("description", a.get("value"))) for a in parameters["args"]))
            elif event.get("method") == "Runtime.exceptionThrown":
                lines.append(parameters["exceptionDetails"].get("exception", {}).get("description", parameters["exceptionDetails"]["text"]))
            elif event.get("method") == "Log.entryAdded":
                lines.append(parameters["entry"]["text"])
        return [line for line in lines if "GPU stall due to ReadPixels" not in line]  # a remark on how the picture is taken


class Page:
    """A page that is open, of Chromium.page."""

    def __init__(self, browser, session):
        self.browser, self.session = browser, session

    def ask(self, method, **parameters):
        return self.browser.ask(method, self.session, **parameters)

    def value(self, expression):
        return self.ask("Runtime.evaluate", expression=expression, returnByValue=True)["result"].get("value")

    def wait_for(self, expression):
        until = time.monotonic() + PATIENCE
        while not self.value(expression):
            assert time.monotonic() < until, f"not within {PATIENCE} s: {expression}: {self.browser.said()}"
            time.sleep(0.1)

    def mouse(self, kind, x, y, held):
        """kind: mousePressed, mouseMoved or mouseReleased, of the left button."""
        self.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=int(held), clickCount=1)

    def png(self):
        return base64.b64decode(self.ask("Page.captureScreenshot", format="png")["data"])
