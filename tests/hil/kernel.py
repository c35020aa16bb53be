"""Unpacks Debian's PREEMPT_RT kernel into a folder; it is neither installed nor booted on this machine.

Usage: kernel.py FOLDER [arm64]; scripts/setup hil and scripts/setup hil-arm64 do it."""

import lzma
import pathlib
import platform
import shutil
import subprocess
import sys
import zlib

import zstandard

# Kernel compression formats: magic bytes and decompressor, each of which ignores data after its stream.
PACKED = (
    (b"\xfd7zXZ\x00", lambda data: lzma.LZMADecompressor(lzma.FORMAT_XZ).decompress(data)),
    (b"\x28\xb5\x2f\xfd", lambda data: zstandard.ZstdDecompressor().decompressobj().decompress(data)),
    (b"\x1f\x8b\x08", lambda data: zlib.decompressobj(wbits=31).decompress(data)),
)
# Modules that the guest needs; their dependencies are read from the modules.
MODULES = ("virtio_pci", "virtio_console", "virtio-rng", "9pnet_virtio", "9p", "overlay",
           "can", "can-raw", "can-bcm", "vcan", "kvaser_pci", "slcan")
OF_A_DISK = ("virtio_blk", "crc32c_generic", "ext4")


def package():
    """Name of the package with the newest kernel, from the dependencies of the meta package."""
    depends = subprocess.run(["apt-cache", "depends", "linux-image-rt-amd64"], capture_output=True, text=True)
    names = [line.split()[-1] for line in depends.stdout.splitlines() if "Depends: linux-image-" in line]
    if not names:
        raise RuntimeError("apt knows no PREEMPT_RT kernel (linux-image-rt-amd64); as root: apt-get update")
    return names[0]


def fetch(cache, arm64=False):
    """@return the folder with boot/ and the kernel's modules. The package is downloaded once, and again only if that
    folder was removed or lacks a module."""
    here = sorted(mark.parent for mark in cache.glob("*/complete"))
    if here and complete(here[-1]):
        return here[-1]
    folder = cache / "linux-image-rt-arm64" if arm64 else cache / package()
    print(f"hil: fetching {folder.name}, 70 MB", flush=True)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    if arm64:
        download_arm64(folder)
        next((folder / "boot").glob("vmlinuz-*")).rename(folder / "vmlinux")  # not packed
    else:
        download(folder)
        unpack(next((folder / "boot").glob("vmlinuz-*")), folder / "vmlinux")
    unpack_modules(folder)
    needed = set(modules(folder, MODULES + OF_A_DISK))  # all modules together have 400 MB
    for module in folder.rglob("*.ko"):
        if module not in needed:
            module.unlink()
    (folder / "complete").touch()
    return folder


def download(folder):
    name = folder.name
    got = subprocess.run(["apt-get", "download", "-q", name], cwd=folder, capture_output=True, text=True)
    if got.returncode != 0:
        raise RuntimeError(f"apt-get download {name}: {got.stderr.strip().splitlines()[-1]}")
    archive = next(folder.glob("*.deb"))
    subprocess.run(["dpkg-deb", "-x", archive.name, "."], cwd=folder, check=True)
    archive.unlink()


def download_arm64(folder):
    """By mmdebstrap, because this machine's apt knows only packages of its own architecture."""
    release = platform.freedesktop_os_release()["VERSION_CODENAME"]
    got = subprocess.run(["mmdebstrap", "--quiet", "--variant=extract", "--arch=arm64", f"--include={folder.name}", release, folder],
                         capture_output=True, text=True)
    if got.returncode != 0:
        raise RuntimeError(f"mmdebstrap {folder.name}: {got.stderr.strip().splitlines()[-1]}")


def unpack(bzimage, to):
    """The kernel as an uncompressed ELF file; an emulated CPU would need seconds to decompress it at every boot."""
    data = bzimage.read_bytes()
    for magic, unpacked in PACKED:
        at = data.find(magic)
        while at >= 0:  # the magic bytes may also occur in code
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
    """Decompresses modules to plain .ko files for the guest's insmod; Debian 13 compresses each with xz."""
    for packed in pathlib.Path(folder).rglob("*.ko.xz"):
        packed.with_suffix("").write_bytes(lzma.decompress(packed.read_bytes()))
        packed.unlink()


def needs(module):
    """Names of the modules on which this one depends, from its .modinfo section."""
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
    """Files of the modules and their dependencies, in loading order."""
    folder = pathlib.Path(folder)  # modules are in /lib/modules in Debian 12, in /usr/lib/modules in 13
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
        fetch(pathlib.Path(sys.argv[1]), arm64=sys.argv[2:] == ["arm64"])
    except (RuntimeError, OSError) as error:
        sys.exit(f"hil: {error}")
