"""The wheel of the module: packed, and installed by pip without a network."""

import base64
import csv
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import venv
import zipfile

import pytest

import achilles


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    return made(tmp_path_factory.mktemp("wheel"))


def made(folder):
    script = pathlib.Path(os.environ["ACHILLES_SOURCE"]) / "app/python/wheel.py"
    done = subprocess.run([sys.executable, script, folder], capture_output=True, text=True, check=True)
    return pathlib.Path(done.stdout.strip())


def test_its_record_is_true(wheel):
    assert re.fullmatch(r"achilles-[0-9.]+-cp3\d+-cp3\d+-linux_x86_64\.whl", wheel.name)
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        (about,) = {name.split("/")[0] for name in names if ".dist-info/" in name}
        rows = list(csv.reader(archive.read(f"{about}/RECORD").decode().splitlines()))
        assert sorted(row[0] for row in rows) == sorted(names) and rows[-1] == [f"{about}/RECORD", "", ""]
        for name, recorded, size in rows[:-1]:
            content = archive.read(name)
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            assert recorded == "sha256=" + digest and int(size) == len(content), name
        source = pathlib.Path(os.environ["ACHILLES_SOURCE"])
        for file in source.glob("assets/systems/*.toml"):
            assert archive.read(f"achilles/assets/systems/{file.name}") == file.read_bytes()
    assert {"achilles/__init__.pyi", "achilles/py.typed", "achilles/assets/fonts/DejaVuSans.ttf"} <= set(names)
    assert not any("__pycache__" in name for name in names)


def test_the_same_module_gives_the_same_bytes(wheel, tmp_path):
    assert made(tmp_path).read_bytes() == wheel.read_bytes()


def test_it_works_where_pip_installs_it(wheel, tmp_path):
    venv.create(tmp_path / "venv", with_pip=True, system_site_packages=True)
    python = tmp_path / "venv/bin/python"
    plain = {"PATH": "/usr/bin:/bin", "HOME": str(tmp_path), "PIP_DISABLE_PIP_VERSION_CHECK": "1"}
    subprocess.run([python, "-m", "pip", "install", "--no-index", "--quiet", wheel], check=True, env=plain)
    code = ("import achilles; run = achilles.simulate('ball_on_sine'); print(achilles.__file__, len(achilles.gallery()), "
            "run.figure().svg[:5], len(run.html()) > 50000, run.events[-1].t)")
    done = subprocess.run([python, "-c", code], capture_output=True, text=True, cwd="/", env=plain)
    assert done.returncode == 0, done.stderr
    place, systems, svg, has_page, t = done.stdout.split()
    assert place.startswith(str(tmp_path)) and int(systems) == len(achilles.gallery()) and svg == "<?xml" and has_page == "True"
    assert float(t) == achilles.simulate("ball_on_sine").events[-1].t
    subprocess.run([python, "-m", "pip", "uninstall", "--quiet", "--yes", "achilles"], check=True, env=plain)
    assert not pathlib.Path(place).exists()
