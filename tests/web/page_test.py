#!/usr/bin/env python3
"""usage: page_test.py BUILD [TEST...]

Tests the page in a real browser (chromium, headless), with a real dfweb and dfserver. Exit code 77: there is no browser.
With NAIAD_PICTURES=DIR it writes pictures of the page to DIR, at three sizes.
"""

import os
import shutil
import subprocess
import sys
import unittest
import urllib.request

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from hosting import Hosting, PathProxy  # noqa: E402
from webdriver import Browser  # noqa: E402

BUILD = ""
LEFT, UP, RIGHT, DOWN = "\ue012", "\ue013", "\ue014", "\ue015"

SHOWN = """
  const all = [];
  const {shown = [], shownColumns = 1} = window.naiad?.picture ?? {};
  for (let i = 0; i < shown.length; i += shownColumns)
    all.push(String.fromCodePoint(...[...shown.slice(i, i + shownColumns)].map((cell) => cell & 0x1fffff)));
  return all;
"""


def page():
    return os.path.join(BUILD, "web")


def rows(browser):
    """Returns the rows of the picture that the page shows, as text."""
    return browser.run(SHOWN)


def wait_for(browser, text):
    browser.wait("const rows = (() => {" + SHOWN + "})(); return rows.some((row) => row.includes(arguments[0]));", text)


def play(browser, address):
    """Opens the page and presses its button, once it can be pressed."""
    browser.open(address)
    browser.wait("return document.querySelector('#play').disabled === false && document.querySelector('#title').textContent !== 'Naiad'")
    browser.run("document.querySelector('#name').value = 'Ada'")
    browser.click("#play")


def join(browser, hosting, search=""):
    play(browser, hosting.address + search + "#" + hosting.key)
    browser.wait("return document.body.classList.contains('playing') && window.naiad.picture.shown.length > 0")


class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()

    def setUp(self):
        # Each test has its own tab without state of earlier tests.
        window = self.browser.call("POST", "/window/new", {"type": "tab"})["handle"]
        for other in self.browser.windows():
            if other != window:
                self.browser.switch(other)
                self.browser.call("DELETE", "/window")
        self.browser.switch(window)
        self.browser.complaints()

    def no_complaints(self):
        self.assertEqual(self.browser.complaints(), [])

    def begin(self):
        """Leaves the title screen of saucershoot."""
        self.browser.keys(("down", " "), ("wait", 100), ("up", " "))
        wait_for(self.browser, "=##=>")

    def test_a_player_joins_and_moves_their_ship(self):
        with Hosting(BUILD, page(), "--game", "saucershoot") as hosting:
            join(self.browser, hosting)
            wait_for(self.browser, "1 player")
            self.begin()
            before = self.ship_below(0)
            self.browser.keys(("down", DOWN), ("wait", 500), ("up", DOWN))
            self.ship_below(before)
            self.no_complaints()

    def ship_below(self, row):
        """Waits until the ship, which blinks at first, is below that row. Returns its row."""
        return self.browser.wait(f"const at = (() => {{{SHOWN}}})().findIndex((row) => row.includes('=##=>')); return at > {row} && at;")

    def test_a_reloaded_page_plays_on_and_a_duplicated_tab_is_another_player(self):
        with Hosting(BUILD, page(), "--game", "saucershoot") as hosting:
            join(self.browser, hosting)
            wait_for(self.browser, "1 player")
            self.browser.call("POST", "/refresh", {})
            self.browser.wait("return document.body.classList.contains('playing')")
            wait_for(self.browser, "Session resumed")
            wait_for(self.browser, "1 player")
            first = self.browser.windows()
            self.browser.run("window.open(location.href)")
            self.browser.wait("return true")
            (second,) = [window for window in self.browser.windows() if window not in first]
            self.browser.switch(second)
            self.browser.wait("return document.querySelector('#play').disabled === false && document.querySelector('#name').value !== ''")
            self.browser.click("#play")
            self.browser.wait("return document.body.classList.contains('playing')")
            wait_for(self.browser, "2 players")

    def test_a_line_that_breaks_costs_nothing(self):
        with Hosting(BUILD, page(), "--game", "saucershoot") as hosting:
            join(self.browser, hosting)
            self.begin()
            before = self.ship_below(0)
            hosting.break_lines()
            hosting.wait_for_line("server.log", '"Ada" reconnected')
            self.browser.keys(("down", DOWN), ("wait", 500), ("up", DOWN))
            self.ship_below(before)
            wait_for(self.browser, "1 player")

    def test_chat_help_and_leaving(self):
        with Hosting(BUILD, page(), "--game", "saucershoot") as hosting:
            join(self.browser, hosting)
            self.browser.click("#say")
            self.browser.wait("return window.naiad.client.writing() && document.activeElement.id === 'line'")
            self.browser.type("#line", "Grüße an alle")
            wait_for(self.browser, "say: Grüße an alle")
            self.browser.type("#line", "\ue007")
            wait_for(self.browser, "Ada: Grüße an alle")
            self.browser.click("#help")
            wait_for(self.browser, "this help")
            self.browser.click("#leave")
            self.browser.wait("return document.querySelector('#said').textContent === 'You left.'")
            self.assertIsNone(self.browser.run("return sessionStorage.getItem('naiad.token')"))
            self.no_complaints()

    def test_a_password_is_asked_for(self):
        with Hosting(BUILD, page(), "--game", "saucershoot", "--password", "sesame") as hosting:
            play(self.browser, hosting.address)
            self.browser.wait("return !document.querySelector('#secret').hidden")
            self.browser.type("#password", "sesame")
            self.browser.click("#play")
            self.browser.wait("return document.body.classList.contains('playing')")
            self.assertEqual(self.browser.run("return document.querySelector('#password').value"), "")

    def test_a_link_to_another_game_is_told_apart(self):
        with Hosting(BUILD, page(), "--game", "hello") as hosting:
            self.browser.open(hosting.address + "#" + "a" * 26)
            self.browser.wait("return document.querySelector('#said').textContent.includes('different server')")
            self.assertTrue(self.browser.run("return document.querySelector('#play').disabled"))

    def test_page_works_below_a_path(self):
        with PathProxy("/game") as proxy, Hosting(BUILD, page(), "--game", "saucershoot", gateway=("--origin", proxy.origin)) as hosting:
            proxy.port_behind = hosting.port
            for address in (proxy.origin + "/game", proxy.origin + "/game/", proxy.origin + "/game/index.html"):
                hosting.address = address
                join(self.browser, hosting, search="?touch")
                wait_for(self.browser, "1 player")
                self.assertIsNotNone(self.browser.run("return sessionStorage.getItem('naiad.tokengame/')"))
                self.browser.click("#leave")
                self.browser.wait("return document.querySelector('#said').textContent === 'You left.'")
            self.assertEqual(proxy.outside, [], "requests outside of the path")
            self.no_complaints()

    def test_every_keyboard_opens_the_menu(self):
        """Presses the menu key in layouts of three scripts, and keys that must stay the browser's."""
        with Hosting(BUILD, page(), "--game", "saucershoot") as hosting:
            join(self.browser, hosting)
            control = 2
            for key, code in [("g", "KeyG"), ("п", "KeyG"), ("γ", "KeyG"), ("]", "BracketRight"), ("]", "Digit9"), ("ъ", "BracketRight")]:
                self.dispatch(key, code, control)
                wait_for(self.browser, "Menu: t chat")
                self.dispatch("Escape", "Escape")
                self.browser.wait("return !((() => {" + SHOWN + "})()).some((row) => row.includes('Menu: t chat'))")
            for key, code in [("9", "Digit9"), ("+", "BracketRight"), ("u", "KeyU")]:
                self.dispatch(key, code, control)
            self.count_presses()
            for key, code in [("ц", "KeyW"), ("ф", "KeyA"), ("ы", "KeyS"), ("в", "KeyD")]:
                self.dispatch(key, code)
            self.assertEqual(self.browser.run("return window.presses"), ["ц", "ф", "ы", "в"])
            self.assertNotIn("Menu: t chat", "".join(rows(self.browser)))
            self.no_complaints()

    def dispatch(self, key, code, held=0):
        for kind in ("rawKeyDown", "keyUp"):
            self.browser.devtools("Input.dispatchKeyEvent", type=kind, key=key, code=code, modifiers=held)

    def count_presses(self):
        self.browser.run("""
            window.presses = [];
            const {client} = window.naiad;
            const key = client.key;
            client.key = (name, code, action, modifiers) => { action === 0 && window.presses.push(name); key(name, code, action, modifiers); };
        """)

    def test_a_phone_keyboard_presses_each_letter_once(self):
        """Composes words as phone keyboards do, which report all of the word at each letter."""
        with Hosting(BUILD, page(), "--game", "saucershoot") as hosting:
            join(self.browser, hosting, search="?touch")
            self.count_presses()
            self.browser.click("#keyboard")
            for count in range(1, 5):
                self.browser.devtools("Input.imeSetComposition", text="wasd"[:count], selectionStart=count, selectionEnd=count)
            self.browser.devtools("Input.imeSetComposition", text="wasd ", selectionStart=5, selectionEnd=5)
            self.assertEqual(self.browser.run("return window.presses.join('')"), "wasd ")
            self.browser.devtools("Input.insertText", text="wasd ")
            self.assertEqual(self.browser.run("return [window.presses.join(''), document.querySelector('#line').value]"), ["wasd ", ""])
            for text in ("a", "ab", "a", "ac"):  # the second letter is erased and typed again
                self.browser.devtools("Input.imeSetComposition", text=text, selectionStart=len(text), selectionEnd=len(text))
            self.browser.devtools("Input.insertText", text="ac")
            self.browser.devtools("Input.insertText", text="w")
            self.assertEqual(self.browser.run("return window.presses.join('')"), "wasd abcw")
            self.no_complaints()

    def test_buttons_are_shown_only_while_playing(self):
        with Hosting(BUILD, page(), "--room", "hall=lobby", "--room", "arcade=hello") as hosting:
            visible = "return ['bar', 'pad'].map((id) => getComputedStyle(document.querySelector('#' + id)).visibility)"
            self.browser.open(hosting.address + "?touch")
            self.assertEqual(self.browser.run(visible), ["hidden", "hidden"])
            join(self.browser, hosting, search="?touch")
            self.assertEqual(self.browser.run(visible), ["visible", "visible"])
            self.browser.click("#rooms")
            wait_for(self.browser, "arcade")
            self.browser.click("#leave")
            self.browser.wait("return !document.querySelector('#door').hidden")
            self.assertEqual(self.browser.run(visible), ["hidden", "hidden"])

    def test_own_name_has_the_players_color(self):
        with Hosting(BUILD, page(), "--game", "hello") as hosting:
            join(self.browser, hosting)
            # The background of the blank cell before the player's name, in reverse (2) and each colour.
            grounds = self.browser.run("""
                const at = (color) => [...window.naiad.picture.image((0x20 | color << 21 | 2 << 24) >>> 0).getContext("2d").getImageData(0, 0, 1, 1).data];
                return [1, 2, 3, 4, 5, 6, 7].map((color) => at(color).join());
            """)
            self.assertEqual(len(set(grounds)), 7, grounds)

    def test_the_address_names_the_room(self):
        games = ("--room", "hall=lobby", "--room", "arcade=saucershoot")
        with Hosting(BUILD, page(), *games) as hosting:
            join(self.browser, hosting, search="?room=arcade")
            self.begin()
            hosting.wait_for_line("server.log", "Ada")
            self.assertEqual(hosting.players_of("arcade"), 1)
            # After a reload, the page still plays as Ada, in her room.
            self.browser.call("POST", "/refresh", {})
            wait_for(self.browser, "Session resumed")
            self.assertEqual(hosting.players_of("arcade"), 1)
            self.no_complaints()

    def test_a_room_that_is_none_is_said(self):
        with Hosting(BUILD, page(), "--room", "hall=lobby", "--room", "arcade=hello") as hosting:
            for name in ("..%2Fetc", "a%20b", "%3Cscript%3E", "a" * 33, "-x"):
                self.browser.open(hosting.address + "?room=" + name + "#" + hosting.key)
                self.browser.wait("return document.querySelector('#said').textContent.includes('invalid room name')")
                self.assertTrue(self.browser.run("return document.querySelector('#play').disabled"), name)
            play(self.browser, hosting.address + "?room=arcad#" + hosting.key)
            self.browser.wait("return document.querySelector('#said').textContent.includes('did you mean \"arcade\"')")

    def test_a_browser_without_webassembly_gets_a_sentence(self):
        with Hosting(BUILD, page(), "--game", "hello") as hosting:
            self.browser.devtools("Page.addScriptToEvaluateOnNewDocument", source="delete globalThis.WebAssembly")
            self.browser.open(hosting.address)
            self.browser.wait("return document.querySelector('#said').textContent.includes('lacks WebAssembly')")
            self.assertTrue(self.browser.run("return document.querySelector('#play').disabled"))

    def test_a_browser_that_cannot_run_the_script_gets_a_sentence(self):
        folder = os.path.join(BUILD, "old_page")
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(page(), folder)
        with open(os.path.join(folder, "page.js"), "a", encoding="utf-8") as script:
            script.write("\nwhat no browser ( can read\n")
        visible = "return getComputedStyle(document.querySelector('#unable')).visibility === 'visible'"
        with Hosting(BUILD, folder, "--game", "hello") as hosting:
            self.browser.open(hosting.address)
            self.assertFalse(self.browser.run(visible), "not at once")
            self.browser.wait(visible)
        with Hosting(BUILD, page(), "--game", "hello") as hosting:
            join(self.browser, hosting)
            self.assertIsNone(self.browser.run("return document.querySelector('#unable')"))

    def test_a_server_that_is_gone_is_said_and_found_again(self):
        with Hosting(BUILD, page(), "--game", "hello") as hosting:
            join(self.browser, hosting)
            hosting.server.terminate()
            hosting.server.wait()
            self.browser.wait("return !document.querySelector('#door').hidden && document.querySelector('#said').textContent.length > 10")

    def test_touch_screens_have_a_pad(self):
        with Hosting(BUILD, page(), "--game", "saucershoot") as hosting:
            join(self.browser, hosting, search="?touch")
            self.begin()
            before = self.ship_below(0)
            press = "const button = document.querySelector('#pad .down'); button.dispatchEvent(new PointerEvent(arguments[0], {pointerId: 1, bubbles: true, cancelable: true}))"
            self.browser.run("HTMLElement.prototype.setPointerCapture = () => {}")
            self.browser.run(press, "pointerdown")
            self.ship_below(before)
            self.browser.run(press, "pointerup")

    def test_the_page_is_small(self):
        with Hosting(BUILD, page(), "--game", "hello") as hosting:
            names = ["", "page.css", "page.js", "module.js", "picture.js", "sound.js", "clock.js", "client.wasm", "font.woff2", "icon.svg", "server"]
            total = 0
            for name in names:
                request = urllib.request.Request(hosting.address + name, headers={"Accept-Encoding": "gzip"})
                with urllib.request.urlopen(request) as answer:
                    total += len(answer.read())
            print(f"page bytes={total}")
            self.assertLess(total, 600_000)

    def recorded(self, before, until, after):
        """Plays in a busy world until this script is true. Returns the pictures, the truth file and the result of `after`."""
        folder = os.path.join(BUILD, "recording_page")
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(page(), folder)
        shutil.copy(os.path.join(BUILD, "wasm", "recording_client.wasm"), os.path.join(folder, "client.wasm"))
        truth = os.path.join(folder, "truth.txt")
        with Hosting(BUILD, folder, "--game", "bullethell", "--seed", "7", "--truth-file", truth) as hosting:
            join(self.browser, hosting)
            self.browser.run(before)
            self.browser.patience = 120
            self.browser.wait(until)
            result = self.browser.run(after)
            return self.browser.run(RECORDED), truth, result

    def test_what_is_seen_is_what_the_server_shows(self):
        """Compares each cell of 1,000 ticks of a busy world with the server's own picture."""
        seen, truth, rate = self.recorded("""
            window.frames_drawn = 0;
            const show = window.naiad.picture.show;
            window.naiad.picture.show = function (picture) { ++window.frames_drawn; return show.call(this, picture); };
            window.since = performance.now();
        """, "return window.naiad.client.exports.recorded() >= 1000", "return window.frames_drawn * 1000 / (performance.now() - window.since)")
        compared, cells, wrong = compare(seen, truth)
        print(f"page ticks={compared} cells={cells} wrong_cells={wrong} frames_per_s={rate:.1f}")
        self.assertGreaterEqual(compared, 900)
        self.assertEqual(wrong, 0)

    def test_a_picture_without_an_overtaken_snapshot_is_not_compared(self):
        """Delays both streams, and then delivers the second first, without its largest snapshot.

        The first stream alone carries that snapshot, as if the second had unsent bytes when the server sent it.
        """
        seen, truth, overtaken = self.recorded("""
            const {client} = window.naiad;
            const received = client.received;
            const first = 1;
            const snapshots = 0x1a;  // the first byte of a message with a snapshot
            let delayed = [];
            window.overtaken = 0;
            client.received = (stream, message) => delayed.push([stream, message]);
            setInterval(() => {
              const all = delayed;
              delayed = [];
              const onSecond = all.filter(([stream]) => stream !== first);
              const sizes = onSecond.map(([, message]) => message[0] === snapshots ? message.length : 0);
              if (sizes.length > 1) {
                onSecond.splice(sizes.indexOf(Math.max(...sizes)), 1);
                ++window.overtaken;
              }
              for (const one of onSecond.concat(all.filter(([stream]) => stream === first))) received(...one);
            }, 300);
        """, "return window.overtaken >= 20 && window.naiad.client.exports.recorded() >= 20", "return window.overtaken")
        compared, cells, wrong = compare(seen, truth)
        print(f"page ticks={compared} cells={cells} overtaken={overtaken} wrong_cells={wrong}")
        self.assertGreater(compared, 10)
        self.assertEqual(wrong, 0)

    def test_bots_come_by_the_gateway_as_well(self):
        truth = os.path.join(BUILD, "gateway-truth.txt")
        with Hosting(BUILD, page(), "--game", "bullethell", "--truth-file", truth) as hosting:
            bot = subprocess.run([os.path.join(BUILD, "bin", "dfbot"), "--web", hosting.address, "--clients", "3", "--ticks", "150", "--random", "1",
                                  "--truth-file", truth, "--quiet"], capture_output=True, text=True, timeout=120)
        print(bot.stdout.strip())
        self.assertEqual(bot.returncode, 0, bot.stdout + bot.stderr)
        self.assertIn(" wrong_cells=0 ", bot.stdout)

    def test_pictures(self):
        folder = os.environ.get("NAIAD_PICTURES")
        if not folder:
            self.skipTest("NAIAD_PICTURES names no folder")
        with Hosting(BUILD, page(), "--game", "saucershoot") as hosting:
            for name, width, height, search in [("page-wide", 1280, 720, ""), ("page-window", 800, 560, ""), ("page-phone", 412, 880, "?touch")]:
                self.browser.devtools("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=2 if search else 1, mobile=bool(search))
                join(self.browser, hosting, search=search)
                self.begin()
                self.browser.screenshot(os.path.join(folder, name + ".png"))
                self.browser.click("#leave")
                self.browser.wait("return !document.querySelector('#door').hidden")
            self.browser.devtools("Emulation.clearDeviceMetricsOverride")


RECORDED = """
  const {exports} = window.naiad.client;
  const all = {};
  const size = exports.recorded_size();
  const count = (size & 0xffff) * (size >> 16);
  for (let i = 0; i < exports.recorded(); ++i) {
    const tick = exports.recorded_tick(i) >>> 0;
    const cells = new Uint32Array(exports.memory.buffer, exports.recorded_cells(), count);
    let text = "";
    let colors = "";
    for (const cell of cells) {
      text += String.fromCodePoint(cell & 0x1fffff);
      colors += cell >>> 21 & 7;
    }
    all[tick] = [text, colors];
  }
  return all;
"""


def compare(seen, path):
    """Compares pictures by tick with a truth file (shared/replica/TruthFile.h). Returns ticks and cells compared, and wrong cells."""
    compared = cells = wrong = 0
    with open(path, encoding="utf-8") as file:
        while head := file.readline().split():
            _, tick, _, _, width, height = head
            width, height = int(width), int(height)
            lines = [file.readline().rstrip("\n") for _ in range(2 * height + 1)]
            if tick not in seen:
                continue
            text, colors = "".join(lines[:height]), "".join(lines[height:2 * height])
            if len(text) != width * height or len(colors) != width * height:
                break  # the file ends early because it was still being written
            compared += 1
            cells += width * height
            for ch, color, seen_ch, seen_color in zip(text, colors, *seen[tick]):
                wrong += ch != seen_ch or color not in (".", seen_color)
    return compared, cells, wrong


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    BUILD = os.path.abspath(sys.argv.pop(1))
    if not shutil.which("chromium") or not shutil.which("chromedriver"):
        print("skipped: there is no chromium with its chromedriver")
        sys.exit(77)
    unittest.main(verbosity=2)
