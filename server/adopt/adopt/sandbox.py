"""A sandbox for a Python function and the processes it starts: own namespaces for users, mounts, processes and network.

Processes in it see the system's programs and libraries and the given paths read-only, and a small file system in memory that is
deleted at the end. The network is a private loopback. They have no capabilities and cannot get any. When the sandbox ends, all its
processes end. It requires a kernel that lets users create namespaces (Debian 12 does): see unavailable_reason().
"""
import ctypes
import json
import os
import resource
import select
import signal
import socket
import struct
import sys
import time

from .bounded import limit_to

_libc = ctypes.CDLL(None, use_errno=True)
_NEWNS, _NEWCGROUP, _NEWUTS, _NEWIPC, _NEWUSER, _NEWPID, _NEWNET = (
    0x20000, 0x2000000, 0x4000000, 0x8000000, 0x10000000, 0x20000000, 0x40000000)
_RDONLY, _NOSUID, _NODEV, _BIND, _REC, _PRIVATE = 1, 2, 4, 4096, 16384, 1 << 18
_MNT_DETACH = 2
_SYS_MOUNT_SETATTR = 442
_ATTR_RDONLY, _ATTR_NOSUID, _AT_FDCWD, _AT_RECURSIVE = 1, 2, -100, 0x8000
_PR_SET_PDEATHSIG, _PR_SET_NO_NEW_PRIVS, _PR_CAPBSET_DROP, _PR_SET_DUMPABLE = 1, 38, 24, 4
_SYSTEM = ("/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64", "/etc/ld.so.cache", "/etc/ld.so.conf", "/etc/ld.so.conf.d",
           "/etc/alternatives", "/etc/localtime", "/etc/ssl/openssl.cnf")
_DEVICES = ("null", "zero", "full", "random", "urandom")
MEMORY = 4 << 30  # maximum address space of a process in bytes


class SandboxError(Exception):
    """Raised if the kernel does not let this user make a sandbox."""


def _call(name, *arguments):
    if getattr(_libc, name)(*arguments) != 0:
        error = ctypes.get_errno()
        raise SandboxError(f"{name}: {os.strerror(error)}")


def _syscall(name, number, *arguments):
    if _libc.syscall(ctypes.c_long(number), *arguments) != 0:
        raise SandboxError(f"{name}: {os.strerror(ctypes.get_errno())}")


def _mount(source, target, kind, flags, data=None):
    encode = lambda text: None if text is None else os.fsencode(text)
    _call("mount", encode(source), encode(target), encode(kind), ctypes.c_ulong(flags), encode(data))


def _write(path, text):
    try:
        with open(path, "w", encoding="ascii") as file:
            file.write(text)
    except OSError as error:
        raise SandboxError(f"{path}: {error.strerror}") from error


def _enter_namespaces():
    user, group = os.geteuid(), os.getegid()
    _call("unshare", _NEWUSER | _NEWNS | _NEWPID | _NEWIPC | _NEWNET | _NEWUTS | _NEWCGROUP)
    _write("/proc/self/setgroups", "deny")
    # Maps no user to root, not even root, because a program executed as root gets all capabilities of its namespace.
    _write("/proc/self/uid_map", f"1000 {user} 1")
    _write("/proc/self/gid_map", f"1000 {group} 1")


def _read_only(path):
    attributes = struct.pack("QQQQ", _ATTR_RDONLY | _ATTR_NOSUID, 0, 0, 0)
    _syscall("mount_setattr", _SYS_MOUNT_SETATTR, ctypes.c_int(_AT_FDCWD), os.fsencode(path), ctypes.c_uint(_AT_RECURSIVE),
             attributes, ctypes.c_size_t(len(attributes)))


def _bind(source, root, writable=False):
    """Mounts a file or folder under its own path in the sandbox. Copies a link (/bin on Debian)."""
    target = root + source
    os.makedirs(os.path.dirname(target), exist_ok=True)
    if os.path.islink(source):
        os.symlink(os.readlink(source), target)
        return
    if os.path.isdir(source):
        os.makedirs(target, exist_ok=True)
    else:
        with open(target, "ab"):
            pass
    _mount(source, target, None, _BIND | _REC)
    if not writable:
        _read_only(target)


def _build_root(root, shown, megabytes):
    """Builds the root file system: the system's folders, the `shown` paths, and the writable folders /tmp and /game."""
    _mount(None, "/", None, _REC | _PRIVATE)
    _mount("sandbox", root, "tmpfs", _NOSUID | _NODEV, f"size={megabytes}m,mode=755")
    for path in _SYSTEM:
        if os.path.lexists(path):
            _bind(path, root)
    for path in dict.fromkeys(os.path.realpath(path) for path in shown):
        _bind(path, root)
    os.makedirs(root + "/dev", exist_ok=True)
    for device in _DEVICES:
        _bind("/dev/" + device, root, writable=True)
    for folder in ("/tmp", "/game", "/proc"):
        os.makedirs(root + folder, exist_ok=True)
    try:
        _mount("proc", root + "/proc", "proc", _NOSUID | _NODEV)
    except SandboxError:
        pass  # fails in some containers; /proc is not needed


def _loopback_up():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        request = struct.pack("16sH14s", b"lo", 0x1 | 0x40, b"")  # IFF_UP | IFF_RUNNING
        if _libc.ioctl(any_socket.fileno(), ctypes.c_ulong(0x8914), request) != 0:  # SIOCSIFFLAGS
            raise SandboxError(f"loopback: {os.strerror(ctypes.get_errno())}")


def _change_root(root):
    os.chdir(root)
    _syscall("pivot_root", {"x86_64": 155, "aarch64": 41}.get(os.uname().machine, 155), b".", b".")
    _call("umount2", b".", _MNT_DETACH)
    os.chdir("/game")


def _drop_privileges():
    """Makes sure that programs executed from now on have no capabilities and cannot gain any."""
    for capability in range(64):
        _libc.prctl(_PR_CAPBSET_DROP, capability, 0, 0, 0)
    if _libc.prctl(_PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0:
        raise SandboxError("no_new_privs: " + os.strerror(ctypes.get_errno()))


def limits(seconds, memory=MEMORY, confined=True):
    """Sets the limits of a program, in the child before exec, and drops its capabilities. memory 0: no limit. Not `confined`: no
    limit of processes either, because outside of a sandbox it would count all threads of the user."""
    limit_to(resource.RLIMIT_CORE, 0)
    limit_to(resource.RLIMIT_FSIZE, 32 << 20)
    limit_to(resource.RLIMIT_NOFILE, 256)
    limit_to(resource.RLIMIT_CPU, seconds)
    if confined:
        limit_to(resource.RLIMIT_NPROC, 128)
    if memory:  # 0 for a sanitizer, which reserves most of the address space and has a limit of its own
        limit_to(resource.RLIMIT_AS, memory)
    else:
        hard = resource.getrlimit(resource.RLIMIT_AS)[1]
        resource.setrlimit(resource.RLIMIT_AS, (hard, hard))
    _drop_effective()


def _drop_effective():
    """Drops the capabilities of this process, which it still has from creating the namespace."""
    header = struct.pack("Ii", 0x20080522, 0)  # version 3 of capset, for this thread
    _libc.capset(header, struct.pack("6I", 0, 0, 0, 0, 0, 0))


def run(function, root, shown, timeout, megabytes=64):
    """Runs function() as process 1 of a new sandbox, with its root mounted on the empty folder `root`. `shown`: paths that it may
    read. Returns its result, passed as JSON, or None if it gave none within `timeout` seconds. Raises SandboxError, RuntimeError.
    """
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        _first_process(function, root, shown, megabytes, reader, writer)
    os.close(writer)
    try:
        return _answer(reader, timeout)
    finally:
        os.close(reader)
        try:
            os.kill(child, signal.SIGKILL)  # this also kills process 1, and so all processes of the sandbox
        except ProcessLookupError:
            pass
        os.waitpid(child, 0)


def _first_process(function, root, shown, megabytes, reader, writer):
    """Runs in the child process: creates the namespaces, then process 1 of the sandbox. Never returns."""
    try:
        os.close(reader)
        os.setsid()
        _libc.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
        _enter_namespaces()
        if os.fork() != 0:
            os.close(writer)
            os.wait()
            os._exit(0)
        _libc.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
        # Process 1 gets only signals for which it has handlers. With those of its parent, its descendants could end it.
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGALRM):
            signal.signal(number, signal.SIG_DFL)
        _build_root(root, shown, megabytes)
        _loopback_up()
        _change_root(root)
        _drop_privileges()
        _send(writer, {"result": function()})
    except SandboxError as error:
        _send(writer, {"sandbox": str(error)})
    except BaseException as error:  # reported by the parent
        _send(writer, {"error": f"{type(error).__name__}: {error}"})
    finally:
        os._exit(0)


def _send(writer, answer):
    with os.fdopen(os.dup(writer), "wb") as file:
        file.write(json.dumps(answer).encode("ascii"))


def _answer(reader, timeout):
    deadline, data = time.monotonic() + timeout, b""
    while True:
        left = deadline - time.monotonic()
        if left <= 0 or not select.select([reader], [], [], left)[0]:
            return None
        chunk = os.read(reader, 1 << 16)
        if not chunk:
            break
        data += chunk
    if not data:
        return None
    try:
        answer = json.loads(data)
    except ValueError:
        raise RuntimeError("the answer of the sandbox is incomplete") from None
    if "sandbox" in answer:
        raise SandboxError(answer["sandbox"])
    if "error" in answer:
        raise RuntimeError(answer["error"])
    return answer["result"]


def unavailable_reason(root):
    """Returns the reason why this user cannot have a sandbox; None if sandboxes work."""
    if not sys.platform.startswith("linux"):
        return "it requires Linux"
    try:
        return None if run(lambda: True, root, (), 20) else "it did not start"
    except (SandboxError, OSError, RuntimeError) as error:
        return str(error)
