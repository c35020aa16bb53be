"""Debian's PREEMPT_RT kernel, unpacked into a folder: never installed, never booted on this machine itself.

Usage: kernel.py FOLDER; scripts/setup hil does it."""

import lzma
import pathlib
import shutil
import subprocess
import sys
import zlib

import zstandard

# How kernels are packed: first bytes, and what unpacks them. Each ignores what follows its stream.
PACKED = (
    (b"\xfd7zXZ\x00", lambda data: lzma.LZMADecompressor(lzma.FORMAT_XZ).decompress(data)),
    (b"\x28\xb5\x2f\xfd", lambda data: zstandard.ZstdDecompressor().decompressobj().decompress(data)),
    (b"\x1f\x8b\x08", lambda data: zlib.decompressobj(wbits=31).decompress(data)),
)
# What the guest needs, in no order; what these need is found in the modules themselves.
MODULES = ("virtio_pci", "virtio_console", "virtio-rng", "9pnet_virtio", "9p", "overlay",
           "can", "can-raw", "can-bcm", "vcan", "kvaser_pci", "slcan")
OF_A_DISK = ("virtio_blk", "crc32c_generic", "ext4")


def package():
    """Name of the package with the newest kernel, which the meta package depends on."""
    depends = subprocess.run(["apt-cache", "depends", "linux-image-rt-amd64"], capture_output=True, text=True)
    names = [line.split()[-1] for line in depends.stdout.splitlines() if "Depends: linux-image-" in line]
    if not names:
        raise RuntimeError("apt knows no PREEMPT_RT kernel (linux-image-rt-amd64); as root: apt-get update")
    return names[0]


def fetch(cache):
    """@return the folder with boot/ and the modules of the kernel; the package is downloaded once, anew only when that
    folder is removed or a module is wanted that was not kept."""
    here = sorted(mark.parent for mark in cache.glob("*/complete"))
    if here and complete(here[-1]):
        return here[-1]
    name = package()
    folder = cache / name
    print(f"hil: fetching {name}, 70 MB", flush=True)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    got = subprocess.run(["apt-get", "download", "-q", name], cwd=folder, capture_output=True, text=True)
    if got.returncode != 0:
        raise RuntimeError(f"apt-get download {name}: {got.stderr.strip().splitlines()[-1]}")
    archive = next(folder.glob("*.deb"))
    subprocess.run(["dpkg-deb", "-x", archive.name, "."], cwd=folder, check=True)
    archive.unlink()
    unpack(next((folder / "boot").glob("vmlinuz-*")), folder / "vmlinux")
    unpack_modules(folder)
    needed = set(modules(folder, MODULES + OF_A_DISK))  # of 400 MB
    for module in folder.rglob("*.ko"):
        if module not in needed:
            module.unlink()
    (folder / "complete").touch()
    return folder


def unpack(bzimage, to):
    """The kernel as ELF: an emulated CPU would need seconds to unpack it at every start."""
    data = bzimage.read_bytes()
    for magic, unpacked in PACKED:
        at = data.find(magic)
        while at >= 0:  # the first bytes may also stand in code
            try:
                elf = unpacked(data[at:])
            except (lzma.LZMAError, zstandard.ZstdError, zlib.error):
                elf = b""
            if elf.startswith(b"\x7fELF"):
                to.write_bytes(elf)
                return
            at = data.find(magic, at + 1)
    raise RuntimeError(f"{bzimage}: holds no kernel packed with xz, zstd or gzip, the ways that Debian uses")


def unpack_modules(folder):
    """Plain .ko files, as the guest's insmod reads them: Debian 13 packs each of them with xz."""
    for packed in pathlib.Path(folder).rglob("*.ko.xz"):
        packed.with_suffix("").write_bytes(lzma.decompress(packed.read_bytes()))
        packed.unlink()


def needs(module):
    """Names of the modules that one asks for, from its own .modinfo."""
    data = module.read_bytes()
    at = data.find(b"\0depends=")
    at = at + 9 if at >= 0 else data.find(b"depends=") + 8
    return [n for n in data[at:data.index(b"\0", at)].decode().split(",") if n]


def complete(folder):
    try:
        modules(folder, MODULES + OF_A_DISK)
    except RuntimeError:
        return False
    return True


def modules(folder, names=MODULES):
    """Files of modules and all they need, in an order in which they can be loaded."""
    folder = pathlib.Path(folder)  # /lib/modules in Debian 12, /usr/lib/modules in 13
    found = {f.stem.replace("-", "_"): f for f in folder.rglob("*.ko")}
    inside = {pathlib.PurePath(line).stem.replace("-", "_") for list_ in folder.rglob("modules.builtin") for line in list_.read_text().splitlines()}
    order = []

    def add(name):
        file = found.get(name.replace("-", "_"))
        if file is None:
            if name.replace("-", "_") in inside:
                return
            raise RuntimeError(f"the kernel has no module {name}")
        if file in order:
            return
        for other in needs(file):
            add(other)
        order.append(file)

    for name in names:
        add(name)
    return order


if __name__ == "__main__":
    try:
        fetch(pathlib.Path(sys.argv[1]))
    except (RuntimeError, OSError) as error:
        sys.exit(f"hil: {error}")
