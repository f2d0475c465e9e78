#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A camera of one's own: images in, poses out, while the camera runs."""
import numpy as np

import stillmap


class WallCamera:
    """Stands in for a camera's driver: it slides along a painted wall."""

    model = stillmap.Camera(width=320, height=240, fx=300, fy=300, cx=160, cy=120,
                            depth_factor=1000)

    def __init__(self):
        tiles = np.random.default_rng(7).integers(0, 256, (24, 60, 3), dtype=np.uint8)
        self.wall = tiles.repeat(10, axis=0).repeat(10, axis=1)
        self.depth_mm = np.full((240, 320), 1500, np.uint16)

    def frames(self, count):
        for k in range(count):  # a thirtieth of a second later and 1 cm farther right
            yield self.wall[:, 2 * k:2 * k + 320], self.depth_mm, k / 30


camera = WallCamera()
slam = stillmap.Slam(camera.model, threads=2)
for color, depth, stamp in camera.frames(40):
    frame = slam.process(color, depth, stamp)
    if frame.pose is None:
        print(f"{stamp:.3f}: lost")
        continue
    x, y, z = frame.pose[:3, 3]
    print(f"{stamp:.3f}: {x:.3f} {y:.3f} {z:.3f}")
result = slam.finish()
result.map.save("wall.ply")
slam.save("wall.stillmap")
print(f"{len(result.trajectory)} poses, {len(result.map)} points in wall.ply")
