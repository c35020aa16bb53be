"""The guest's initial files as a cpio archive (format "newc"), built without external tools or root rights."""

import stat

DIRECTORY, PROGRAM = stat.S_IFDIR | 0o755, stat.S_IFREG | 0o755


def entry(name, mode, data=b""):
    path = name.encode() + b"\0"
    fields = (0, mode, 0, 0, 1, 0, len(data), 0, 0, 0, 0, len(path), 0)
    head = b"070701" + b"".join(b"%08X" % f for f in fields) + path
    return padded(head) + padded(data)


def padded(data):
    return data + b"\0" * (-len(data) % 4)


def archive(files):
    """@param files name -> bytes, all executable; folders are created as needed."""
    folders = {"/".join(name.split("/")[:i]) for name in files for i in range(1, name.count("/") + 1)}
    parts = [entry(f, DIRECTORY) for f in sorted(folders)]
    parts += [entry(name, PROGRAM, data) for name, data in files.items()]
    return b"".join(parts) + entry("TRAILER!!!", 0)
