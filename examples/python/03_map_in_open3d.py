#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The map of a run in Open3D:  03_map_in_open3d.py OUT [PICTURE.png]"""
import sys

import numpy as np

import stillmap

try:
    import open3d
except ImportError:
    sys.exit("skipped: Open3D is not installed (apt-get install python3-open3d)")

run = stillmap.Run(sys.argv[1])
cloud = open3d.geometry.PointCloud()
cloud.points = open3d.utility.Vector3dVector(run.map.points.astype(np.float64))
cloud.colors = open3d.utility.Vector3dVector(run.map.colors / 255.0)
path = open3d.geometry.LineSet()
path.points = open3d.utility.Vector3dVector(run.trajectory.poses[:, :3, 3])
path.lines = open3d.utility.Vector2iVector(
    [[i, i + 1] for i in range(len(run.trajectory) - 1)])
print(cloud, path)
if len(sys.argv) > 2:
    window = open3d.visualization.Visualizer()
    window.create_window(visible=False)
    for thing in (cloud, path):
        window.add_geometry(thing)
    window.capture_screen_image(sys.argv[2], do_render=True)
else:
    open3d.visualization.draw_geometries([cloud, path])
