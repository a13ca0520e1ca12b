"""What the tests share."""
import os
import pathlib
import subprocess
import sys

import facet
import pytest

SPIN = pathlib.Path(os.environ["FACET_TEST_TOP"]) / "docs/examples/gltf/spin.gltf"


@pytest.fixture(scope="session")
def scene():
    return facet.Scene.builtin()


@pytest.fixture(scope="session")
def command():
    """The command line tool: command('render', ..) runs it."""

    def run(*arguments):
        subprocess.run([os.environ["FACET_TEST_COMMAND"], *map(str, arguments)], check=True, capture_output=True)

    return run


@pytest.fixture
def script():
    """Runs a program in an interpreter of its own, with variables changed."""

    def run(text, **variables):
        environment = {**os.environ, **variables}
        return subprocess.run([sys.executable, "-c", text], env=environment, capture_output=True, text=True, timeout=60)

    return run
