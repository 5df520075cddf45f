#!/usr/bin/python3
"""Tests dfserver as a service of systemd, without systemd: notifications, sockets passed to it, and the system call filter
of its unit, which must allow games to run in processes of their own in their sandbox.
usage: service_test.py BUILD_DIR SOURCE_DIR [TEST...]"""
import ctypes
import os
import re
import shutil
import signal
import socket
import ssl
import subprocess
import sys
import tempfile
import time
import unittest

BUILD, SOURCE = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
UNITS = os.path.join(SOURCE, "deploy", "systemd")
PATIENCE = 60  # timeout in seconds, for a busy machine
TICK = "5000"  # microseconds
ALPN = "naiad/1"  # kAlpn in shared/net/stream/TlsContext.h
GAPS = r"this kernel has no .*"  # missingSandboxFeatures() in server/host/world/Sandbox.cpp


def program(name):
    return os.path.join(BUILD, "bin", name)


def unit_values(unit, key):
    """Returns the values of a key in a unit file, in order."""
    with open(os.path.join(UNITS, unit), encoding="utf-8") as file:
        return [line.split("=", 1)[1].strip() for line in file if line.startswith(key + "=")]


class Manager:
    """Replaces systemd: receives the service's notifications."""

    def __init__(self, folder):
        self.path = os.path.join(folder, "notify")
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.bind(self.path)
        self.heard = []

    def wait_for(self, wanted):
        """Waits for a notification that begins with `wanted`. Stores it and the earlier ones in `heard`."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            self.socket.settimeout(max(0.01, end - time.monotonic()))
            try:
                said = self.socket.recv(4096).decode()
            except TimeoutError:
                break
            self.heard.append(said)
            if said.startswith(wanted):
                return said
        raise AssertionError(f"{wanted} was not said within {PATIENCE} s, but {self.heard}")

    def drain(self):
        """Discards the notifications received so far."""
        self.socket.setblocking(False)
        try:
            while True:
                self.socket.recv(4096)
        except BlockingIOError:
            pass


# A script that gets descriptors and a command as arguments. It duplicates the descriptors to 3, 4, ... and executes the command.
GIVE = """
import os, sys
end = sys.argv.index("--")
for place, one in enumerate(sys.argv[1:end], 3):
    os.dup2(int(one), place)
    os.close(int(one))
os.environ.update(LISTEN_PID=str(os.getpid()), LISTEN_FDS=str(end - 1))
os.execv(sys.argv[end + 1], sys.argv[end + 1:])
"""


class ServiceTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="naiad-service-")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        for name in ("config", "game"):
            os.mkdir(os.path.join(self.folder, name))
        self.manager = Manager(self.folder)
        self.addCleanup(self.manager.socket.close)

    def file(self, name):
        return os.path.join(self.folder, name)

    def text(self, name):
        with open(self.file(name), encoding="utf-8", errors="replace") as file:
            return file.read()

    def wait_until(self, is_true, what):
        end = time.monotonic() + PATIENCE
        while not is_true():
            self.assertLess(time.monotonic(), end, f"{what}, within {PATIENCE} s:\n{self.text('log')}")
            time.sleep(0.02)

    def start(self, *options, program_name="dfserver", preexec=None, variables=None, pass_fds=(), words=()):
        environment = {key: value for key, value in os.environ.items() if not key.startswith(("NAIAD_", "LISTEN_", "WATCHDOG_"))}
        environment.update(NOTIFY_SOCKET=self.manager.path, XDG_CONFIG_HOME=self.file("config"), XDG_DATA_HOME=self.file("config"),
                           XDG_STATE_HOME=self.file("config"), XDG_RUNTIME_DIR=self.file("config"))
        environment.update(variables or {})
        if program_name == "dfserver":
            options = ["--frame-time", TICK, "--log-file", self.file("log"), *options]
        server = subprocess.Popen([*words, program(program_name), *options],
                                  env=environment, cwd=self.file("game"), stdout=subprocess.DEVNULL,
                                  stderr=open(self.file("errors"), "wb"), preexec_fn=preexec, pass_fds=pass_fds)
        self.addCleanup(self.end, server)
        return server

    @staticmethod
    def end(server):
        if server.poll() is None:
            server.kill()
        server.wait()

    def stop(self, server):
        server.send_signal(signal.SIGTERM)
        self.assertEqual(server.wait(PATIENCE), 0, self.text("errors"))

    def play(self, port, ticks=20):
        """Plays with a bot. Returns its output."""
        bot = subprocess.run([program("dfbot"), f"127.0.0.1:{port}", "--ticks", str(ticks), "--random", "1", "--known-servers",
                              self.file("known")], capture_output=True, text=True, timeout=PATIENCE, check=False)
        self.assertEqual(bot.returncode, 0, bot.stdout + bot.stderr + self.text("log"))
        return bot.stdout

    # ---- messages to the manager ------------------------------------------------------------------------------------

    def test_ready_once_it_listens_alive_by_its_ticks_stopping_at_the_end(self):
        server = self.start("--address", "127.0.0.1", "--port", "0", "--port-file", self.file("port"), "--game", "hello",
                            variables={"WATCHDOG_USEC": "200000"})
        self.manager.wait_for("READY=1")
        self.assertEqual(self.manager.heard, ["READY=1"], "nothing before")
        port = int(self.text("port"))
        socket.create_connection(("127.0.0.1", port), PATIENCE).close()
        for _ in range(3):
            self.manager.wait_for("WATCHDOG=1")
        self.play(port, ticks=200)
        self.manager.wait_for(f"STATUS=127.0.0.1:{port}, 1 player")
        self.manager.drain()  # its queue is full now, and messages to a full queue are lost
        self.stop(server)
        self.manager.wait_for("STOPPING=1")

    def test_a_game_that_hangs_keeps_it_from_saying_that_it_is_alive(self):
        server = self.start(program_name="trouble_game", variables={
            "WATCHDOG_USEC": "200000", "NAIAD_PORT": "0", "NAIAD_PORT_FILE": self.file("port"), "NAIAD_LOG_FILE": self.file("log")})
        self.manager.wait_for("WATCHDOG=1")
        bot = subprocess.Popen([program("dfbot"), f"127.0.0.1:{self.text('port').strip()}", "--script", "press H", "--seconds", "600",
                                "--known-servers", self.file("known")], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(self.end, bot)
        self.wait_until(lambda: "has not finished tick" in self.text("log"), "the log speaks of a game that hangs")
        self.manager.drain()
        self.manager.socket.settimeout(1)
        with self.assertRaises(TimeoutError):
            self.manager.socket.recv(4096)
        self.assertIsNone(server.poll())

    # ---- sockets from the manager -----------------------------------------------------------------------------------

    def give_sockets(self, *kinds):
        """Returns sockets on one port of all addresses as dfserver@.socket makes them, for the server's descriptors 3 and 4."""
        while True:
            first = socket.create_server(("::", 0), family=socket.AF_INET6, dualstack_ipv6=True)
            port = first.getsockname()[1]
            second = socket.socket(socket.AF_INET6, socket.SOCK_DGRAM)
            second.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 0)
            try:
                second.bind(("::", port))
            except OSError:
                first.close()
                second.close()
                continue
            self.addCleanup(first.close)
            self.addCleanup(second.close)
            both = {"tcp": first, "udp": second}
            return port, [both[kind] for kind in kinds]

    def start_with(self, sockets, *options):
        # Not 3 and 4 in this process, because Popen uses descriptors of its own between fork and exec.
        high = [os.dup2(one.fileno(), 200 + i) for i, one in enumerate(sockets)]
        words = [sys.executable, "-c", GIVE, *(str(one) for one in high), "--"]
        server = self.start(*options, words=words, pass_fds=high)
        for one in high:
            os.close(one)
        return server

    def test_it_listens_with_the_sockets_that_it_is_given(self):
        port, sockets = self.give_sockets("tcp", "udp")
        # A client that connects before the server starts must wait and then be served.
        early = socket.create_connection(("127.0.0.1", port), PATIENCE)
        self.addCleanup(early.close)
        server = self.start_with(sockets, "--game", "hello", "--port-file", self.file("port"))
        self.manager.wait_for("READY=1")
        self.assertEqual(int(self.text("port")), port)
        context = ssl.create_default_context()
        context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
        context.set_alpn_protocols([ALPN])
        self.assertEqual(context.wrap_socket(early).version(), "TLSv1.3")
        self.play(port)
        self.stop(server)
        self.assertRegex(self.text("log"), r"stopped: .*joined=1")

    def test_games_in_processes_of_their_own_do_not_get_them(self):
        port, sockets = self.give_sockets("udp", "tcp")
        server = self.start_with(sockets, "--game", "hello", "--on-game-over", "restart")
        self.manager.wait_for("READY=1")
        self.play(port)
        inodes = {os.fstat(one.fileno()).st_ino for one in sockets}
        with open(f"/proc/{server.pid}/task/{server.pid}/children", encoding="ascii") as file:
            worlds = file.read().split()
        self.assertTrue(worlds)
        for world in worlds:
            for name in os.listdir(f"/proc/{world}/fd"):
                try:
                    self.assertNotIn(os.stat(f"/proc/{world}/fd/{name}").st_ino, inodes)
                except FileNotFoundError:
                    pass
        self.stop(server)

    def test_wrong_sockets_are_an_error_that_says_so(self):
        _, sockets = self.give_sockets("tcp", "tcp")
        server = self.start_with(sockets, "--game", "hello")
        self.assertEqual(server.wait(PATIENCE), 4)
        self.assertIn("The sockets from the service manager (LISTEN_FDS) cannot be used: both are TCP sockets.", self.text("errors"))

    # ---- the unit files -----------------------------------------------------------------------------------------------------

    def analyze(self, *words):
        if not shutil.which("systemd-analyze"):
            self.skipTest("there is no systemd-analyze")
        return subprocess.run(["systemd-analyze", *words], capture_output=True, text=True, timeout=PATIENCE, check=False)

    def test_units_are_in_order(self):
        # Puts the paths of the built programs into the units, and removes the manual pages, which another test checks.
        for name in os.listdir(UNITS):
            with open(os.path.join(UNITS, name), encoding="utf-8") as file:
                text = re.sub(r"^Documentation=.*\n", "", file.read(), flags=re.M)
            with open(self.file(name), "w", encoding="utf-8") as file:
                file.write(text.replace("/usr/bin/df", os.path.join(BUILD, "bin", "df")))
        for name in ("dfserver@.service", "dfserver@.socket", "dfweb.service", "dfdir.service"):
            found = self.analyze("verify", self.file(name))
            said = [line for line in found.stderr.splitlines() if self.folder in line or name.split(".")[0] in line]
            self.assertEqual((found.returncode, said), (0, []), found.stderr)

    def test_units_are_hardened(self):
        for name in ("dfserver@.service", "dfweb.service", "dfdir.service"):
            said = self.analyze("security", "--offline=true", os.path.join(UNITS, name)).stdout
            exposure = re.search(r"Overall exposure level for .*: ([0-9.]+)", said)
            self.assertTrue(exposure, said)
            self.assertLessEqual(float(exposure.group(1)), 1.5, said)

    def filtered_calls(self):
        """Returns the names of the system calls that the unit's SystemCallFilter allows, as systemd resolves it."""
        known = self.analyze("syscall-filter")
        sets, current = {}, None
        for line in known.stdout.splitlines():
            if re.match(r"^@[a-z-]+$", line):
                current = sets.setdefault(line, [])
            elif re.match(r"^    [@a-z0-9_]", line) and current is not None:
                current.append(line.strip())
            elif line and not line.startswith(" "):
                current = None
        self.assertIn("@system-service", sets, known.stderr)

        def resolve(name):
            if not name.startswith("@"):
                return {name}
            return set().union(*(resolve(one) for one in sets[name]))

        allowed = set()
        for value in unit_values("dfserver@.service", "SystemCallFilter"):
            names = set().union(*(resolve(one) for one in value.lstrip("~").split()))
            allowed = allowed - names if value.startswith("~") else allowed | names
        return allowed | resolve("@default") | {"execve"}  # added by systemd itself

    def sandbox_gaps(self):
        """Returns dfserver's message about missing sandbox features of this kernel, without the unit's filter."""
        other = os.path.join(self.folder, "other")
        subprocess.run([program("dfserver"), "--address", "127.0.0.1", "--port", "0", "--game", "hello", "--on-game-over", "restart",
                        "--ticks", "3", "--log-file", other, "--identity", other + "-key"], cwd=self.file("game"),
                       stdout=subprocess.DEVNULL, timeout=PATIENCE, check=True)
        with open(other, encoding="utf-8") as file:
            return "; ".join(re.findall(GAPS, file.read()))

    def test_sandboxed_worlds_start_under_the_units_filter(self):
        install = seccomp_installer(self.filtered_calls())
        if install is None:
            self.skipTest("no list of system calls of this processor (linux-libc-dev)")

        def harden():
            if os.getuid() == 0:  # the service's user is unprivileged
                os.setgroups([])
                os.setgid(65534)
                os.setuid(65534)
            deny_writable_code()
            install()

        os.chmod(self.folder, 0o711)
        for name in ("config", "game"):
            os.chown(self.file(name), 65534 if os.getuid() == 0 else -1, -1)
        for name in ("log", "port", "errors"):
            with open(self.file(name), "w", encoding="utf-8"):
                pass
            os.chmod(self.file(name), 0o666)
        if os.getuid() == 0 and not readable_by_others(program("dfserver")):
            self.skipTest("the build is in a folder that other users cannot enter")
        os.chmod(self.manager.path, 0o777)
        if self.sandbox_gaps():
            self.skipTest("the kernel has no whole sandbox: " + self.sandbox_gaps())
        server = self.start("--address", "127.0.0.1", "--port", "0", "--game", "saucershoot", "--on-game-over", "restart",
                            preexec=harden)
        try:
            self.manager.wait_for("READY=1")
        except AssertionError as error:
            self.fail(f"{error}\n{self.text('errors')}\n{self.text('log')}\n{server.poll()}")
        listening = r"on 127\.0\.0\.1:(\d+)"
        self.wait_until(lambda: re.search(listening, self.text("log")), "the log says where it listens")
        port = re.search(listening, self.text("log")).group(1)
        self.play(port)
        self.assertEqual(re.findall(GAPS, self.text("log")), [], "the sandbox is whole")
        with open(f"/proc/{server.pid}/status", encoding="ascii") as file:
            self.assertIn("Seccomp:\t2", file.read())
        self.stop(server)


def readable_by_others(path):
    while path != "/":
        if not os.stat(path).st_mode & 0o001:
            return False
        path = os.path.dirname(path)
    return True


# ---- seccomp like systemd's -------------------------------------------------------------------------------------------------

LIBC = ctypes.CDLL(None, use_errno=True)
PR_SET_NO_NEW_PRIVS, PR_SET_SECCOMP, PR_SET_MDWE = 38, 22, 65
SECCOMP_RET_ALLOW, SECCOMP_RET_ERRNO = 0x7FFF0000, 0x00050000
LOAD, JUMP_EQUAL, RETURN = 0x20, 0x15, 0x06
NUMBERS = {"x86_64": ("/usr/include/{}/asm/unistd_64.h", 0xC000003E), "aarch64": ("/usr/include/asm-generic/unistd.h", 0xC00000B7)}


class Instruction(ctypes.Structure):
    _fields_ = [("code", ctypes.c_uint16), ("true", ctypes.c_uint8), ("false", ctypes.c_uint8), ("value", ctypes.c_uint32)]


class Program(ctypes.Structure):
    _fields_ = [("size", ctypes.c_uint16), ("instructions", ctypes.POINTER(Instruction))]


def call_numbers():
    machine = os.uname().machine
    if machine not in NUMBERS:
        return None, 0
    path, arch = NUMBERS[machine]
    path = path.format(f"{machine}-linux-gnu")
    if not os.path.exists(path):
        return None, 0
    with open(path, encoding="ascii") as file:
        return {name: int(number) for name, number in re.findall(r"#define __NR(?:3264)?_(\w+) (\d+)", file.read())}, arch


def seccomp_installer(names):
    """Returns a function that forbids this process all other system calls with EPERM, as SystemCallErrorNumber does."""
    numbers, arch = call_numbers()
    if not numbers:
        return None
    refused = SECCOMP_RET_ERRNO | 1
    code = [Instruction(LOAD, 0, 0, 4), Instruction(JUMP_EQUAL, 1, 0, arch), Instruction(RETURN, 0, 0, refused),
            Instruction(LOAD, 0, 0, 0)]
    for name in sorted(names):
        if name in numbers:  # the other system calls exist only on other processors
            code += [Instruction(JUMP_EQUAL, 0, 1, numbers[name]), Instruction(RETURN, 0, 0, SECCOMP_RET_ALLOW)]
    code.append(Instruction(RETURN, 0, 0, refused))
    array = (Instruction * len(code))(*code)
    whole = Program(len(code), array)

    def install():
        if LIBC.prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 or LIBC.prctl(PR_SET_SECCOMP, 2, ctypes.byref(whole), 0, 0) != 0:
            raise OSError(ctypes.get_errno(), "seccomp")
    return install


def deny_writable_code():
    """Applies MemoryDenyWriteExecute directly, in kernels that support it (6.3)."""
    LIBC.prctl(PR_SET_MDWE, 1, 0, 0, 0)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *(f"ServiceTest.{name}" if "." not in name else name for name in sys.argv[3:])], verbosity=2)
