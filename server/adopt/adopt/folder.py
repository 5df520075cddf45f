"""Makes a private copy of an untrusted folder. Only reads the folder, with limits for number, depth and sizes of its files."""
import os
import re
import stat

MIB = 1 << 20
SOURCES = (".cpp", ".cc", ".cxx", ".c++")
HEADERS = (".h", ".hpp", ".hh", ".hxx", ".inl", ".ipp")
# Names of folders and files made by version control, editors and build systems. They are not copied.
JUNK_FOLDERS = {"__macosx", ".git", ".svn", ".hg", ".vs", ".idea", ".vscode", "cmakefiles", "node_modules", ".ds_store"}
JUNK_FOLDER = re.compile(r"cmake-build-|sfml([-_ .]?\d.*)?$|.*\.(dsym|app|tlog)$", re.I)
JUNK_FILE = re.compile(r"(\._.*|\.ds_store|thumbs\.db|desktop\.ini)$|.*\.(o|obj|pdb|ilk|idb|ipch|pch|sdf|suo|exe|dll|so|dylib|lib|a|"
                       r"exp|tlog|zip|rar|7z|tar|gz|db|sqlite|vsidx|iobj|ipdb)$", re.I)


class Limits:
    """Limits of a copy. A student's game has some hundred files and a few MiB, mostly sound files."""

    def __init__(self, entries=20000, depth=24, file_bytes=64 * MIB, total_bytes=512 * MIB, source_bytes=MIB):
        self.entries, self.depth = entries, depth
        self.file_bytes, self.total_bytes, self.source_bytes = file_bytes, total_bytes, source_bytes


class FolderError(Exception):
    """Raised if the folder cannot be read at all."""


class Copy:
    """The result of copying: `files` as paths relative to the copy, and `left_out` as (path, reason)."""

    def __init__(self, root):
        self.root, self.files, self.left_out, self.bytes, self.entries = root, [], [], 0, 0

    def path(self, name):
        return os.path.join(self.root, name)


def is_source(name):
    return name.lower().endswith(SOURCES) or name.endswith(".C")


def is_code(name):
    return is_source(name) or name.lower().endswith(HEADERS)


def copy_folder(source, target, limits=None):
    """Copies source into the new folder target."""
    limits = limits or Limits()
    copy = Copy(target)
    os.makedirs(target, mode=0o700)
    try:
        descriptor = os.open(source, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
        top = os.path.realpath(source)
    except OSError as error:
        raise FolderError(f"{source}: {error.strerror}") from error
    try:
        _copy_level(copy, limits, descriptor, top, "", 0)
    finally:
        os.close(descriptor)
    drop_broken_links(copy)
    return copy


def drop_broken_links(copy):
    """Removes links whose targets were not copied, and links to other sources."""
    inside, kept = os.path.realpath(copy.root) + os.sep, []
    for path in copy.files:
        full, reason = copy.path(path), None
        if os.path.islink(full):
            if not (os.path.isfile(full) and os.path.realpath(full).startswith(inside)):
                reason = "a link to a file that was left out"
            elif is_source(path):
                reason = "a link to another source"
        if reason:
            os.unlink(full)
            copy.left_out.append((path, reason))
        else:
            kept.append(path)
    copy.files = kept


def _copy_level(copy, limits, descriptor, top, prefix, depth):
    try:
        names = sorted(os.listdir(descriptor))
    except OSError as error:
        copy.left_out.append((prefix or ".", f"cannot be read: {error.strerror}"))
        return
    for name in names:
        path = os.path.join(prefix, name)
        copy.entries += 1
        if copy.entries > limits.entries:
            if copy.entries == limits.entries + 1:
                copy.left_out.append((path, f"this and all files after it: more than {limits.entries} files"))
            return
        reason = _copy_entry(copy, limits, descriptor, top, path, name, depth)
        if reason:
            copy.left_out.append((path, reason))


def _copy_entry(copy, limits, descriptor, top, path, name, depth):
    """Copies one entry. Returns the reason if it was not copied, else None."""
    if any(ord(character) < 32 or ord(character) == 127 for character in name):
        return "a name with control characters"
    try:
        status = os.stat(name, dir_fd=descriptor, follow_symlinks=False)
    except OSError as error:
        return f"cannot be read: {error.strerror}"
    kind = status.st_mode
    if stat.S_ISLNK(kind):
        return _copy_link(copy, descriptor, top, path, name)
    if stat.S_ISDIR(kind):
        return _copy_subfolder(copy, limits, descriptor, top, path, name, depth)
    if not stat.S_ISREG(kind):
        return {stat.S_IFIFO: "a pipe", stat.S_IFSOCK: "a socket", stat.S_IFCHR: "a device",
                stat.S_IFBLK: "a device"}.get(stat.S_IFMT(kind), "not a file")
    if JUNK_FILE.match(name):
        return "a file made by a build or the system"
    return _copy_file(copy, limits, descriptor, path, name)


def _copy_subfolder(copy, limits, descriptor, top, path, name, depth):
    if name.lower() in JUNK_FOLDERS or JUNK_FOLDER.match(name):
        return "a folder of the system, an editor or a library"
    if depth >= limits.depth:
        return f"more than {limits.depth} folders deep"
    try:
        inner = os.open(name, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC, dir_fd=descriptor)
    except OSError as error:
        return f"cannot be read: {error.strerror}"
    try:
        os.mkdir(copy.path(path), mode=0o700)
        _copy_level(copy, limits, inner, top, path, depth + 1)
    finally:
        os.close(inner)
    return None


def _copy_link(copy, descriptor, top, path, name):
    """Copies a relative link that stays inside the folder. The new link leads to the copied file."""
    try:
        text = os.readlink(name, dir_fd=descriptor)
    except OSError as error:
        return f"cannot be read: {error.strerror}"
    goal = os.path.realpath(os.path.join(top, path))
    if os.path.isabs(text) or not (goal + os.sep).startswith(top + os.sep):
        return "a link out of the folder"
    if not os.path.isfile(goal):
        return "a link that does not lead to a file"
    os.symlink(text, copy.path(path))
    copy.files.append(path)
    return None


def _copy_file(copy, limits, descriptor, path, name):
    most = limits.source_bytes if is_code(name) else limits.file_bytes
    try:
        # O_NONBLOCK: does not block if the file has been replaced by a pipe since it was checked.
        file = os.open(name, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC, dir_fd=descriptor)
    except OSError as error:
        return f"cannot be read: {error.strerror}"
    with os.fdopen(file, "rb") as reader:
        status = os.fstat(reader.fileno())
        if not stat.S_ISREG(status.st_mode):
            return "not a file"
        if status.st_size > most:
            return f"{status.st_size / MIB:.0f} MiB, more than {most // MIB} MiB"
        if copy.bytes + status.st_size > limits.total_bytes:
            return f"the folder has more than {limits.total_bytes // MIB} MiB"
        data = reader.read(status.st_size)
    copy.bytes += len(data)
    with open(copy.path(path), "wb") as writer:
        writer.write(data)
    copy.files.append(path)
    return None
