"""Runs the built game as a server without a terminal in the sandbox, with players that press keys."""
import os
import re
import shutil
import signal
import stat
import subprocess
import time

from . import sandbox
from .bounded import end_group
from .keys import random_script
from .text import shown

START_SECONDS = 20  # time limit until the game listens
END_SECONDS = 8  # time limit until the game has ended after SIGTERM
MAX_ROUNDS = 20  # maximum times that the game is started, if it ends normally before the time is over
_TICKS = re.compile(r"\bbot (?:ok|lost)\b.* ticks=(\d+) objects=(\d+)")
_HANGS = re.compile(r"the game does not finish tick .*")  # a forced exit of the host
_LOG_BYTES = 64 << 10
_ASAN = "detect_leaks=0:alloc_dealloc_mismatch=0:detect_odr_violation=0:handle_segv=2:handle_abort=2:handle_sigfpe=2:" \
        "handle_sigill=2:handle_sigbus=2:hard_rss_limit_mb=3072:exitcode=77"


def settings(seed):
    """Returns the settings of the run that matter to the game, as environment variables. They override its df-config.txt."""
    return {"NAIAD_HEADLESS": "0", "NAIAD_INPUT_MODE": "together", "NAIAD_ON_GAME_OVER": "leave", "NAIAD_TICKS": "0",
            "NAIAD_EXIT_WHEN_EMPTY": "0", "NAIAD_SEED": str(seed)}


class ScriptError(Exception):
    """Raised if the script of --keys is invalid. The text has the reason."""


class Trial:
    """A run of the game.

    tree: the changed copy, which contains `program`; folder: folder of the copy to start it in; seconds: duration; players:
    number of players that join.
    """

    def __init__(self, tree, program, folder, naiad, seconds, seed, keys, named_keys, examined=False, players=1):
        self.tree, self.program, self.folder, self.naiad = tree, program, folder, naiad
        self.seconds, self.seed, self.keys, self.named_keys, self.examined = seconds, seed, keys, named_keys, examined
        self.players = players
        self.game, self.tmp, self.confined = "/game", "/tmp", True  # paths in the sandbox

    def run(self, root, confined=True):
        """Runs the game in a sandbox on the empty folder `root`, or without a sandbox if not `confined`. Returns the Outcome."""
        self.confined = confined
        if not confined:
            self.game = os.path.join(root, "game")
            self.tmp = os.path.join(root, "tmp")
            for folder in (self.game, self.tmp):
                shutil.rmtree(folder, ignore_errors=True)
                os.makedirs(folder)
            return self._checked(self.inside())
        megabytes = 96 + _megabytes(self.tree)
        timeout = self.seconds + START_SECONDS + END_SECONDS + 30
        shown = (self.tree, self.naiad.lib, self.naiad.bin)
        answer = sandbox.run(self.inside, root, shown, timeout, megabytes)
        return self._checked(answer) if answer else Outcome("hangs", text="the sandbox did not end and was killed")

    def _checked(self, answer):
        if answer["state"] == "refused" and answer["code"] == 2 and self.keys:  # dfbot's exit code for wrong usage
            raise ScriptError(answer["text"])
        return Outcome(**answer)

    def inside(self):
        """Plays the game until the time is over. In a sandbox, this is its process 1. Returns the arguments of Outcome."""
        shutil.copytree(self.tree, self.game, symlinks=True, dirs_exist_ok=True)
        started = time.monotonic()
        ticks = objects = rounds = 0
        while True:
            rounds += 1
            left = self.seconds - (time.monotonic() - started)
            one = self._round(rounds, max(left, 1.0))
            ticks += one.pop("ticks")
            objects = max(objects, one.pop("objects"))
            again = one["state"] == "over" and rounds < MAX_ROUNDS and time.monotonic() - started < self.seconds - 1
            # Does not retry a game that ends before a player can join.
            if not again or one["seconds"] < 0.2:
                return {**one, "ticks": ticks, "objects": objects, "rounds": rounds, "log": self._log(),
                        "printed": _ends(f"{self.tmp}/game.{rounds}.out")}

    def _environment(self, number):
        names = {"PATH": "/usr/bin:/bin", "HOME": f"{self.tmp}/home", "LC_ALL": "C.UTF-8", "TERM": "dumb", "NAIAD_PORT": "0",
                 "NAIAD_ADDRESS": "127.0.0.1", "NAIAD_PORT_FILE": f"{self.tmp}/port.{number}", "NAIAD_INSECURE": "1",
                 "NAIAD_LOCAL_CLIENT": "0", **settings(self.seed)}
        return {**names, "ASAN_OPTIONS": _ASAN} if self.examined else names

    def _round(self, number, seconds):
        os.makedirs(f"{self.tmp}/home", exist_ok=True)
        memory = 0 if self.examined else sandbox.MEMORY
        cpu = int(self.seconds * 2) + 60
        began = time.monotonic()
        with open(f"{self.tmp}/game.{number}.out", "wb") as output:
            game = subprocess.Popen([os.path.join(self.game, self.program)], cwd=os.path.join(self.game, self.folder),
                                    env=self._environment(number), stdin=subprocess.DEVNULL, stdout=output, stderr=output,
                                    start_new_session=True, preexec_fn=lambda: sandbox.limits(cpu, memory, self.confined))
        try:
            return self._judge(game, seconds, number, began)
        finally:
            end_group(game.pid)

    def _judge(self, game, seconds, number, began):
        """Plays and ends the game. Returns the result."""
        port = _wait_for_port(game, f"{self.tmp}/port.{number}")
        if port is None:
            code = game.poll()
            state = "deaf" if code is None else "crashed" if code < 0 or code == 77 else "unplayed" if code == 0 else "failed"
            return {"state": state, "code": code, "seconds": time.monotonic() - began, "ticks": 0, "objects": 0, "text": ""}
        code, text, seen, ticks, objects = self._play(game, seconds, number)
        ended = _end(game)
        hang = _HANGS.search(_ends(f"{self.tmp}/game.{number}.out"))
        if ended["state"] == "killed":  # if the player saw all of the game, only main() does not end
            ended = {"state": "played" if code == 0 else "hangs", "code": None, "ended_well": False}
        elif ended["state"] == "played" and code != 0:
            ended = {"state": "hangs" if hang else "played" if seen else "refused", "code": code}
        return {**ended, "seconds": time.monotonic() - began, "ticks": ticks, "objects": objects,
                "text": hang.group() if hang and ended["state"] == "hangs" else text}

    def _play(self, game, seconds, number):
        """Plays with dfbot, and again if it lost the connection to a game that still runs, as after a title screen. Returns the
        last exit code (None: dfbot had to be killed), message and ticks, the ticks of all, and the most Objects in view."""
        end, ticks, objects = time.monotonic() + seconds, 0, 0
        while True:
            said, code = self._join(game, max(end - time.monotonic(), 1.0), number)
            found = _TICKS.search(said)
            seen = int(found.group(1)) if found else 0
            ticks, objects = ticks + seen, max(objects, int(found.group(2)) if found else 0)
            if code not in (1, 4) or game.poll() is not None or time.monotonic() > end - 1:
                return code, _last_line(said) or f"dfbot exited with code {code}", seen, ticks, objects

    def _join(self, game, seconds, number):
        """Lets dfbot join and press keys. Returns its output, and its exit code or None if it had to be killed."""
        port = _wait_for_port(game, f"{self.tmp}/port.{number}")  # after a title screen, it may be another one
        script = f"{self.tmp}/keys"
        with open(script, "w", encoding="utf-8", errors="replace") as file:
            file.write(self.keys or random_script(self.named_keys, self.seed + number - 1, int(seconds * 30) + 30))
        bot = subprocess.Popen([os.path.join(self.naiad.bin, "dfbot"), f"127.0.0.1:{port}", "--insecure", "--seconds",
                                f"{seconds:.1f}",
                                "--script", script, "--quiet", "--name", "adopt", "--clients", str(self.players)], env=self._environment(0), cwd=self.tmp,
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               preexec_fn=lambda: sandbox.limits(600, confined=self.confined))
        deadline = time.monotonic() + seconds + 15
        while bot.poll() is None and game.poll() is None and time.monotonic() < deadline:
            time.sleep(0.02)  # until the player or the game ends
        if game.poll() is not None:
            _wait(bot)
        elif bot.poll() in (1, 4):  # the bot lost its connection: the game may be ending
            _wait(game, 1)
        code = bot.poll()
        if code is None:
            bot.kill()
        return bot.communicate()[0].decode("utf-8", "replace"), code

    def _log(self):
        """Returns the engine's log: the file that df-config.txt names, or the default one."""
        name = "dragonfly.log"
        folder = os.path.join(self.game, self.folder)
        try:
            with open(os.path.join(folder, "df-config.txt"), encoding="utf-8", errors="replace") as file:
                match = re.search(r"(?m)^\s*logfile\s*:\s*([\w.-]+)\s*,", file.read(_LOG_BYTES))
                name = match.group(1) if match else name
        except OSError:
            pass
        return _ends(os.path.join(folder, name))


class Outcome:
    """The result of a run.

    state: "played" (for the whole time), "over" (the game ended normally), "unplayed" (main() ended without a game), "failed"
    (main() ended with an error), "crashed", "deaf" (never listened), "hangs", "refused" (the player could not play; `text` has the
    reason).
    """

    def __init__(self, state, code=0, seconds=0.0, ticks=0, objects=0, rounds=1, text="", log="", printed="", ended_well=True):
        self.state, self.code, self.seconds = state, code, seconds
        self.ticks, self.objects, self.rounds = ticks, objects, rounds
        self.text, self.log, self.printed, self.ended_well = text, log, printed, ended_well

    @property
    def runs(self):
        return self.state in ("played", "over") and self.ticks > 0 or self.state == "over" and self.seconds >= 0.2


def _wait_for_port(game, path):
    deadline = time.monotonic() + START_SECONDS
    while time.monotonic() < deadline and game.poll() is None:
        try:
            with open(path, encoding="ascii") as file:
                text = file.read()
            if text.strip().isdigit() and text.endswith("\n"):
                return int(text)
        except OSError:
            pass
        time.sleep(0.02)  # until the game listens or ends
    return None


def _wait(process, seconds=3):
    try:
        process.wait(seconds)
    except subprocess.TimeoutExpired:
        pass


def _last_line(said):
    lines = [line for line in said.splitlines() if line.strip()]
    return shown(lines[-1].removeprefix("dfbot: "), 500) if lines else ""


def _end(game):
    """Ends the game if it still runs. Returns its state and exit code. State "killed": it did not end by itself."""
    code = game.poll()
    if code is not None:
        state = "over" if code == 0 else "crashed" if code < 0 or code == 77 else "failed"
        return {"state": state, "code": code}
    game.terminate()
    try:
        code = game.wait(END_SECONDS)
    except subprocess.TimeoutExpired:
        game.kill()
        return {"state": "killed"}
    return {"state": "played", "code": code, "ended_well": (code >= 0 and code != 77) or code == -signal.SIGTERM}


def _ends(path):
    """Returns the beginning and end of a file that the game wrote. Untrusted: it may be a link or a pipe."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return ""
    with os.fdopen(descriptor, "rb") as file:
        status = os.fstat(descriptor)
        if not stat.S_ISREG(status.st_mode):
            return ""
        data = file.read(_LOG_BYTES)
        if status.st_size > _LOG_BYTES:
            file.seek(max(status.st_size - _LOG_BYTES, _LOG_BYTES))
            data += b"\n" + file.read(_LOG_BYTES)
        return data.decode("utf-8", "replace")


def _megabytes(folder):
    total = sum(os.lstat(os.path.join(place, name)).st_size for place, _, names in os.walk(folder) for name in names)
    return (total >> 20) + 1
