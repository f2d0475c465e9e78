#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A network of one's own on a recorded sequence:  02_own_network.py SEQUENCE OUT

Any function from an image to Detections will do. With torchvision, for instance:

    network = torchvision.models.detection.maskrcnn_resnet50_fpn(weights="DEFAULT").eval()

    def find(color):
        found = network([torchvision.transforms.functional.to_tensor(color)])[0]
        sure = found["scores"] > 0.5
        return stillmap.Detections([names[i] for i in found["labels"][sure]],
                                   found["scores"][sure].tolist(), found["boxes"][sure].tolist(),
                                   found["masks"][sure, 0].numpy() > 0.5)
"""
import sys

import numpy as np

import stillmap


def find(color):
    """Stands in for a network: takes the reddest rows and columns for a person."""
    red = color[..., 0].astype(int) - color[..., 1:].max(axis=2) > 60
    if red.sum() < 200:
        return stillmap.Detections()
    return stillmap.Detections(["person"], scores=[0.8], masks=red[np.newaxis])


sequence, out = sys.argv[1:]
stillmap.segment(sequence, f"{out}/found", find)
run = stillmap.run(sequence, out, segmenter=f"detections:{out}/found")
print(f"{len(run.trajectory)} poses, {len(run.map)} points, objects in {len(run.objects)} frames")
