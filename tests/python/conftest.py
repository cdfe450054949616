"""What the tests of the Python module share. CTest says where the source and the program are."""

import os
import pathlib
import subprocess

import pytest

SOURCE = pathlib.Path(os.environ["ACHILLES_SOURCE"])
PROGRAM = os.environ["ACHILLES_PROGRAM"]


@pytest.fixture
def source():
    return SOURCE


@pytest.fixture
def program():
    """Runs the program, and returns what it prints."""

    def call(*words, status=0):
        done = subprocess.run([PROGRAM, *words], capture_output=True, text=True)
        assert done.returncode == status, done.stderr
        return done.stdout if status == 0 else done.stderr

    return call
