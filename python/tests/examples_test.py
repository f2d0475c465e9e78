# SPDX-License-Identifier: Apache-2.0
"""The programs of examples/python, the notebook and the documents' Python run as they are shown."""
import json
import os
import re
import subprocess
import sys

import pytest

from conftest import SOURCE

EXAMPLES = SOURCE / "examples/python"


def run_python(arguments, folder):
    done = subprocess.run([sys.executable, *map(str, arguments)], cwd=folder, text=True,
                          capture_output=True, env={**os.environ, "PYTHONWARNINGS": "ignore"})
    if "skipped:" in done.stdout + done.stderr:
        pytest.skip(re.search("skipped: .*", done.stdout + done.stderr).group())
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def python_blocks(document):
    return re.findall(r"```python\n(.*?)```", (SOURCE / document).read_text(), re.DOTALL)


def test_own_camera(tmp_path):
    assert "40 poses" in run_python([EXAMPLES / "01_own_camera.py"], tmp_path)
    assert (tmp_path / "wall.ply").exists() and (tmp_path / "wall.stillmap").exists()


def test_own_network(walking, tmp_path):
    out = run_python([EXAMPLES / "02_own_network.py", walking.folder, "out"], tmp_path)
    assert "40 poses" in out and "objects in 40 frames" in out


def test_plot(program_run, tmp_path):
    run_python([EXAMPLES / "04_plot_trajectory.py", program_run, "plot.png"], tmp_path)
    assert (tmp_path / "plot.png").read_bytes().startswith(b"\x89PNG")


def test_map_in_open3d(program_run, tmp_path):
    run_python([EXAMPLES / "03_map_in_open3d.py", program_run, "map.png"], tmp_path)


def test_notebook(tmp_path):
    cells = json.loads((EXAMPLES / "05_notebook.ipynb").read_text())["cells"]
    code = "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
    (tmp_path / "notebook.py").write_text(code)
    out = run_python(["notebook.py"], tmp_path)
    errors = dict(re.findall(r"(full|off) ATE ([\d.]+)", out))
    assert float(errors["full"]) < float(errors["off"])


@pytest.mark.parametrize("document", ["README.md", "docs/python.md"])
def test_documents(document, walking, tmp_path):
    """In a folder that has what the text speaks of: a sequence `office`, its detections, images."""
    os.symlink(walking.folder, tmp_path / "office")
    given = ("import numpy as np\n"
             "color, depth = np.full((480, 640, 3), 99, np.uint8), np.ones((480, 640), np.float32)\n"
             "frames = [(color, depth, 0.0)]\n")
    blocks = python_blocks(document)
    assert blocks
    (tmp_path / "blocks.py").write_text(given + "\n".join(blocks))
    run_python(["blocks.py"], tmp_path)
