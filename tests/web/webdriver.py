"""A browser driven by chromedriver, which speaks the WebDriver protocol (W3C) as JSON over HTTP."""

import base64
import contextlib
import json
import os
import shutil
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"
# Options for a closed network, possibly as root: the browser must not contact its vendor, and cannot make its own sandbox.
ARGUMENTS = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
             "--disable-component-update", "--disable-sync", "--disable-extensions", "--mute-audio", "--hide-scrollbars",
             "--autoplay-policy=no-user-gesture-required", "--disable-dev-shm-usage"]


class BrowserError(Exception):
    pass


class Browser(contextlib.AbstractContextManager):
    """One chromium with one window or several. Use as a context."""

    def __init__(self, width=1000, height=700, arguments=(), patience=60):
        self.patience = patience
        self.folder = tempfile.mkdtemp(prefix="naiad-web-")
        self.log = open(os.path.join(self.folder, "chromedriver.log"), "w+")
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=self.log, stderr=subprocess.STDOUT)
        self.base = f"http://127.0.0.1:{self._port()}"
        options = {"binary": shutil.which("chromium"),
                   "args": ARGUMENTS + [f"--user-data-dir={self.folder}/profile", f"--window-size={width},{height}", *arguments]}
        wanted = {"capabilities": {"alwaysMatch": {"goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}}}
        self.session = self._call("POST", "/session", wanted)["sessionId"]

    def _port(self):
        for _ in range(1000):
            self.log.seek(0)
            for line in self.log.read().splitlines():
                if "started successfully on port" in line:
                    return int(line.rstrip(".").split()[-1])
            if self.driver.poll() is not None:
                break
            time.sleep(0.02)
        raise BrowserError("chromedriver does not start")

    def _call(self, method, path, body=None):
        data = json.dumps(body if body is not None else {}).encode() if method == "POST" else None
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=180) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise BrowserError(json.load(error)["value"]["message"]) from error

    def call(self, method, path, body=None):
        return self._call(method, f"/session/{self.session}{path}", body)

    def open(self, address):
        self.call("POST", "/url", {"url": address})

    def run(self, script, *arguments):
        """Runs the body of a JavaScript function. Returns its result."""
        return self.call("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def wait(self, script, *arguments):
        """Runs the body of a JavaScript function until its result is true. Returns the result."""
        end = time.monotonic() + self.patience
        while time.monotonic() < end:
            value = self.run(script, *arguments)
            if value:
                return value
            time.sleep(0.02)
        raise BrowserError(f"not within {self.patience} s: {script}")

    def find(self, selector):
        return self.call("POST", "/element", {"using": "css selector", "value": selector})[ELEMENT]

    def type(self, selector, text):
        self.call("POST", f"/element/{self.find(selector)}/value", {"text": text})

    def click(self, selector):
        self.call("POST", f"/element/{self.find(selector)}/click", {})

    def keys(self, *actions):
        """Presses keys: ("down", KEY), ("up", KEY), ("wait", MILLISECONDS). Keys without a character have WebDriver's code points."""
        steps = [{"type": "pause", "duration": value} if kind == "wait" else {"type": "key" + kind.capitalize(), "value": value}
                 for kind, value in actions]
        self.call("POST", "/actions", {"actions": [{"type": "key", "id": "keyboard", "actions": steps}]})

    def resize(self, width, height):
        self.call("POST", "/window/rect", {"width": width, "height": height})

    def screenshot(self, path):
        with open(path, "wb") as out:
            out.write(base64.b64decode(self.call("GET", "/screenshot")))

    def windows(self):
        return self.call("GET", "/window/handles")

    def switch(self, window):
        self.call("POST", "/window", {"handle": window})

    def devtools(self, command, **parameters):
        """Runs a command of the Chrome DevTools Protocol."""
        return self.call("POST", "/goog/cdp/execute", {"cmd": command, "params": parameters})

    def complaints(self):
        """Returns the warnings and errors on the browser's console since the last call."""
        return [entry["message"] for entry in self.call("POST", "/se/log", {"type": "browser"}) if entry["level"] in ("WARNING", "SEVERE")]

    def close(self):
        try:
            self._call("DELETE", f"/session/{self.session}")
        except (BrowserError, AttributeError, OSError):
            pass
        self.driver.terminate()
        self.driver.wait()
        self.log.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    def __exit__(self, *_):
        self.close()
