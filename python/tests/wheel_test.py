# SPDX-License-Identifier: Apache-2.0
"""The wheel: built from what is built, installed elsewhere, imported there alone."""
import os
import pathlib
import subprocess
import sys

import pytest

from conftest import SOURCE

CODE = "import stillmap; print(stillmap.__file__, stillmap.Camera.load('tum_fr1').width)"


def test_a_wheel_can_be_installed_and_imported(tmp_path):
    build = pathlib.Path(os.environ["PYTHONPATH"]).parent
    if build != SOURCE / "build/release":
        pytest.skip("setup.py would build all anew: this is not build/release")
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "-q"]
    subprocess.run([*pip, "wheel", "--no-build-isolation", "--no-deps", "--wheel-dir", tmp_path,
                    SOURCE], check=True)
    wheel = next(tmp_path.glob("stillmap-*.whl"))
    subprocess.run([*pip, "install", "--no-deps", "--no-index", "--target", tmp_path / "place",
                    wheel], check=True)
    done = subprocess.run([sys.executable, "-c", CODE], cwd=tmp_path, check=True, text=True,
                          capture_output=True, env={"PYTHONPATH": str(tmp_path / "place")})
    assert done.stdout.split() == [str(tmp_path / "place/stillmap/__init__.py"), "640"]
    assert (tmp_path / "place/stillmap/_core.pyi").exists()
