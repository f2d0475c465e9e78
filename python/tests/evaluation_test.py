# SPDX-License-Identifier: Apache-2.0
"""Evaluation: the program's figures, and figures known by hand."""
import json

import numpy as np
import pytest

import stillmap
from conftest import program


def line(offsets):
    """A trajectory along x with offsets in y."""
    poses = np.tile(np.eye(4), (len(offsets), 1, 1))
    poses[:, 0, 3] = np.arange(len(offsets))
    poses[:, 1, 3] = offsets
    return stillmap.Trajectory(np.arange(len(offsets)) / 2.0, poses)


def test_known_errors():
    truth = line([0, 0, 0, 0])
    assert stillmap.evaluate_trajectory(truth, line([3, 3, 3, 3]))["ate"]["max"] < 1e-12
    # 0, 1, 1, 0 about their mean is +-0.5, and no rotation fits better.
    ate = stillmap.evaluate_trajectory(truth, line([0, 1, 1, 0]))["ate"]
    assert abs(ate["rmse"] - 0.5) < 1e-9 and ate["pairs"] == 4


def test_a_map_that_is_half_there():
    grid = np.mgrid[0:100, 0:100, 0:1].reshape(3, -1).T.astype(np.float32) * 0.02 + 0.01
    still = stillmap.PointCloud(grid)
    half = stillmap.PointCloud(grid[grid[:, 0] < 0.95])  # 5 cm farther counts as seen
    quality = stillmap.evaluate_map(half, still)
    assert abs(quality["sa"] - 0.5) < 0.02 and quality["accuracy_m"] < 1e-6
    assert quality["da"] is None


def test_a_map_becomes_a_mesh(tmp_path):
    index = np.arange(20000)
    z, angle = 1 - (2 * index + 1) / 20000, 2.399963229728653 * index
    r = np.sqrt(1 - z * z)
    out = np.stack([r * np.cos(angle), r * np.sin(angle), z], 1).astype(np.float32)
    mesh = stillmap.surface_mesh(stillmap.PointCloud(0.3 * out, normals=out))
    points, triangles = mesh.vertices.points, mesh.triangles
    assert abs(np.linalg.norm(points, axis=1) - 0.3).max() < 0.002
    corners = points[triangles].astype(float)
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert abs(volume - 4 / 3 * np.pi * 0.027) < 0.002  # closed, and its outside is out
    mesh.save(tmp_path / "ball.ply")
    assert len(stillmap.PointCloud.load(tmp_path / "ball.ply")) == len(points)
    with pytest.raises(stillmap.Error, match=r"ball.stl: expected a name that ends in"):
        mesh.save(tmp_path / "ball.stl")
    with pytest.raises(stillmap.Error, match="map: no normals"):
        stillmap.surface_mesh(stillmap.PointCloud(out))


def test_has_the_figures_of_the_program(walking, program_run):
    truth, estimate = walking.folder / "groundtruth.txt", program_run / "trajectory.txt"
    ours = stillmap.evaluate_trajectory(truth, stillmap.Trajectory.load(estimate))
    assert ours == json.loads(program("evaluate", "trajectory", truth, estimate, "--json"))
    static, dynamic = (walking.folder / f"truth/{name}_map.ply" for name in ("static", "dynamic"))
    resting = walking.folder / "truth/resting_map.ply"
    ours = stillmap.evaluate_map(program_run / "map.ply", static, dynamic, truth, estimate, resting)
    theirs = program("evaluate", "map", program_run / "map.ply", "--static", static, "--dynamic",
                     dynamic, "--resting", resting, "--groundtruth", truth, "--trajectory", estimate, "--json")
    assert ours == json.loads(theirs)["map"]
