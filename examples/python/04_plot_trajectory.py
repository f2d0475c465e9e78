#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The trajectory of a run from above, with matplotlib:  04_plot_trajectory.py OUT PICTURE.png"""
import sys

import stillmap

try:
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
except ImportError:
    sys.exit("skipped: matplotlib is not installed (apt-get install python3-matplotlib)")

run = stillmap.Run(sys.argv[1])
x, _, z = run.trajectory.poses[:, :3, 3].T
figure, axes = plt.subplots(figsize=(6, 6))
axes.scatter(run.map.points[::50, 0], run.map.points[::50, 2], s=0.2,
             c=run.map.colors[::50] / 255, label="map")
axes.plot(x, z, "r-", linewidth=1.5, label="camera")
axes.set(xlabel="x [m]", ylabel="z [m]", aspect="equal", title=f"{len(x)} poses")
axes.legend()
figure.savefig(sys.argv[2], dpi=120)
print(sys.argv[2])
