"""Fixtures of the tests of the Python module. CTest passes the locations of the source and the program."""

import os
import pathlib
import subprocess
import threading
import time

import pytest

SOURCE = pathlib.Path(os.environ["ACHILLES_SOURCE"])
PROGRAM = os.environ["ACHILLES_PROGRAM"]


@pytest.fixture
def source():
    return SOURCE


@pytest.fixture
def program():
    """Runs the program and returns its output."""

    def call(*words, status=0):
        done = subprocess.run([PROGRAM, *words], capture_output=True, text=True)
        assert done.returncode == status, done.stderr
        return done.stdout if status == 0 else done.stderr

    return call


@pytest.fixture
def counting():
    """Runs a function while another thread counts about every millisecond. Returns the duration, s, and the count."""

    def call(work):
        counted, done = 0, threading.Event()

        def count():
            nonlocal counted
            while not done.is_set():
                counted += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        begin = time.monotonic()
        try:
            work()
            seconds = time.monotonic() - begin
        finally:
            done.set()
            thread.join()
        return seconds, counted

    return call
