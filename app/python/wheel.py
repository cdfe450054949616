"""Packs the built module, with its assets, into a wheel that pip installs without a network.

usage: wheel.py FOLDER, where the wheel is written; its path is printed. The same module gives the same bytes.
"""

import base64
import hashlib
import pathlib
import re
import sys
import sysconfig
import zipfile

import achilles

METADATA = """\
Metadata-Version: 2.1
Name: achilles
Version: {version}
Summary: Mechanical systems with impacts, simulated past their Zeno points
License: MIT
Requires-Python: =={python}.*
Requires-Dist: numpy
Provides-Extra: all
Requires-Dist: pandas; extra == "all"
Requires-Dist: sympy; extra == "all"
"""
WHEEL = """\
Wheel-Version: 1.0
Generator: achilles
Root-Is-Purelib: false
Tag: {tag}
"""


def files_of(package: pathlib.Path) -> dict[str, bytes]:
    """The files of the package by their paths in the wheel. Links, such as those of a build tree, are followed."""
    found = {}
    folders = [package]
    while folders:
        for path in folders.pop().iterdir():
            if path.is_dir() and path.name != "__pycache__":
                folders.append(path)
            elif path.is_file():
                found[f"achilles/{path.relative_to(package).as_posix()}"] = path.read_bytes()
    return found


def hash_of(content: bytes) -> str:
    return "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()


def write_wheel(folder: pathlib.Path) -> pathlib.Path:
    """Writes the wheel of the module that this interpreter imports."""
    version = re.match(r"[0-9]+(\.[0-9]+)*", achilles.__version__)[0]
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    tag = f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"
    files = dict(sorted(files_of(pathlib.Path(achilles.__file__).parent).items()))
    about = f"achilles-{version}.dist-info"
    numbers = f"{sys.version_info.major}.{sys.version_info.minor}"
    files[f"{about}/METADATA"] = METADATA.format(version=version, python=numbers).encode()
    files[f"{about}/WHEEL"] = WHEEL.format(tag=tag).encode()
    record = [f"{name},{hash_of(content)},{len(content)}" for name, content in files.items()]
    files[f"{about}/RECORD"] = "\n".join([*record, f"{about}/RECORD,,", ""]).encode()
    wheel = folder / f"achilles-{version}-{tag}.whl"
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name)  # its time is that of all entries, 1980
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, content)
    return wheel


if __name__ == "__main__":
    if len(sys.argv) != 2 or not pathlib.Path(sys.argv[1]).is_dir():
        sys.exit(__doc__)
    print(write_wheel(pathlib.Path(sys.argv[1])))
