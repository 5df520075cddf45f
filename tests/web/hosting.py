"""A real dfserver with a real dfweb in front of it, on free ports of loopback."""

import contextlib
import json
import os
import re
import shutil
import socket
import subprocess
import tempfile
import threading
import time


class PathProxy(contextlib.AbstractContextManager):
    """A proxy that serves a web server below a path, as nginx and caddy do: removes the path from requests, and redirects
    from the path without '/'. Set `port_behind` to the web server's port. Use as a context."""

    def __init__(self, path):
        self.path, self.port_behind, self.outside = path, None, []
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.origin = "http://127.0.0.1:%d" % self.listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self):
        try:
            while True:
                threading.Thread(target=self._serve, args=(self.listener.accept()[0],), daemon=True).start()
        except OSError:
            return  # closed

    def _serve(self, browser):
        with browser:
            head = b""
            while b"\r\n\r\n" not in head:
                piece = browser.recv(65536)
                if not piece:
                    return
                head += piece
            method, target, rest = head.split(b" ", 2)
            file, mark, query = target.decode().partition("?")
            if file == self.path:
                browser.sendall(f"HTTP/1.1 301 Moved\r\nLocation: {self.path}/{mark}{query}\r\nContent-Length: 0\r\nConnection: close\r\n\r\n".encode())
                return
            if not file.startswith(self.path + "/"):
                self.outside += [file] if file != "/favicon.ico" else []
                browser.sendall(b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\nConnection: close\r\n\r\n")
                return
            if b"upgrade: websocket" not in rest.lower():  # one request a connection, because each has another path
                rest = rest.replace(b"Connection: keep-alive", b"Connection: close")
            with socket.create_connection(("127.0.0.1", self.port_behind)) as server:
                server.sendall(b" ".join([method, (file[len(self.path):] + mark + query).encode(), rest]))
                threading.Thread(target=self._copy, args=(browser, server), daemon=True).start()
                self._copy(server, browser)

    @staticmethod
    def _copy(source, target):
        try:
            while piece := source.recv(65536):
                target.sendall(piece)
            target.shutdown(socket.SHUT_WR)
        except OSError:
            pass  # one end has closed the connection

    def __exit__(self, *_):
        self.listener.close()


class Hosting(contextlib.AbstractContextManager):
    """Runs both programs. `page` is the folder that dfweb serves, `gateway` its further arguments. Use as a context."""

    def __init__(self, build, page, *arguments, gateway=()):
        self.folder = tempfile.mkdtemp(prefix="naiad-web-")
        self.programs = []
        bin_ = os.path.join(build, "bin")
        environment = {**os.environ, "XDG_CONFIG_HOME": self.folder, "XDG_DATA_HOME": self.folder, "XDG_STATE_HOME": self.folder,
                       "NAIAD_JOURNAL": "off"}
        self.visitors = os.path.join(self.folder, "visitors")
        self.control = os.path.join(self.folder, "control.sock")
        self.ctl = os.path.join(bin_, "dfctl")
        self.server = self._start([os.path.join(bin_, "dfserver"), "--address", "127.0.0.1", "--port", "0", "--proxy-socket", self.visitors,
                                   "--control", self.control, *arguments], "server.log", environment)
        link = re.compile(r"naiad://\S*#\w{26}(?!\S)")
        self.link = self._wait("server.log", "link", lambda: link.search(self.text("server.log"))).group()
        self.key = self.link.split("#")[1]
        port_file = os.path.join(self.folder, "port")

        def start_gateway(port):
            self.gateway = self._start([os.path.join(bin_, "dfweb"), self.link, "--proxy-socket", self.visitors, "--listen", f"127.0.0.1:{port}",
                                        "--port-file", port_file, "--page", page, "--name", "a game", *gateway], "gateway.log", environment)
            self.port = int(self._wait("gateway.log", "port", lambda: os.path.exists(port_file) and self.text("port").endswith("\n") and self.text("port")))

        self._port_file, self._start_gateway = port_file, start_gateway
        start_gateway(0)
        self.address = f"http://127.0.0.1:{self.port}/"

    def _start(self, command, log, environment):
        out = open(os.path.join(self.folder, log), "wb")
        program = subprocess.Popen(command, stdout=out, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, env=environment)
        out.close()
        self.programs.append(program)
        return program

    def break_lines(self):
        """Kills the gateway, which ends all connections with browsers, and starts another gateway at its address."""
        self.gateway.kill()
        self.gateway.wait()
        self.programs.remove(self.gateway)
        os.remove(self._port_file)
        self._start_gateway(self.port)

    def players_of(self, room):
        """Returns the number of players in a room, as dfctl reports it."""
        answer = subprocess.run([self.ctl, "--control", self.control, "rooms", "--json"], capture_output=True, text=True, check=True)
        return next(row["players"] for row in json.loads(answer.stdout) if row["room"] == room)

    def text(self, log):
        with open(os.path.join(self.folder, log), errors="replace") as file:
            return file.read()

    def _wait(self, log, what, found):
        """Waits until `found` returns a true value, and returns it."""
        for _ in range(3000):
            if value := found():
                return value
            self._check()
            time.sleep(0.02)
        raise RuntimeError(f"{log} has no {what}:\n" + self.text(log))

    def wait_for_line(self, log, text):
        self._wait(log, text, lambda: text in self.text(log))

    def _check(self):
        for program in self.programs:
            if program.poll() is not None:
                raise RuntimeError("ended: " + " ".join(program.args) + "\n" + "".join(self.text(log) for log in os.listdir(self.folder) if log.endswith(".log")))

    def close(self):
        for program in reversed(self.programs):
            program.terminate()
        for program in self.programs:
            try:
                program.wait(20)
            except subprocess.TimeoutExpired:
                program.kill()
                program.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def __exit__(self, *_):
        self.close()
