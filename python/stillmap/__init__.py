# SPDX-License-Identifier: Apache-2.0
"""RGB-D SLAM: the camera's trajectory and a clean 3-D map of the static world.

A recorded sequence, as the program `stillmap run` does it, with the same bits:

    import stillmap
    run = stillmap.run("office", "result")
    print(run.report["ate"], run.map.points.shape)

A camera of your own, frame by frame:

    slam = stillmap.Slam("tum_fr1")               # or stillmap.Camera(width=640, ...)
    find = stillmap.Segmenter("auto")             # or any network of yours: color -> Detections
    frame = slam.process(color, depth, stamp, find(color))
    result = slam.finish()                        # result.trajectory, result.map

docs/python.md has more, examples/python has whole programs.
"""
from ._core import (CLASS_NAMES, Camera, Detections, DetectionsWriter, Error, Frame, FrameResult,
                    Mesh, ObjectState, PointCloud, RunResult, Segmenter, Sequence, Session, Slam,
                    Trajectory, __version__, default_settings, evaluate_map, evaluate_trajectory,
                    surface_mesh)
from .recording import segment, synth
from .run import Run, run

__all__ = ["CLASS_NAMES", "Camera", "Detections", "DetectionsWriter", "Error", "Frame",
           "FrameResult", "Mesh", "ObjectState", "PointCloud", "Run", "RunResult", "Segmenter", "Sequence",
           "Session", "Slam", "Trajectory", "__version__", "default_settings", "evaluate_map",
           "evaluate_trajectory", "run", "segment", "surface_mesh",
           "synth"]

# Messages and help() call the classes by the names under which they are used.
for _class in (Camera, Detections, DetectionsWriter, Frame, FrameResult, Mesh, ObjectState, PointCloud,
               RunResult, Segmenter, Sequence, Session, Slam, Trajectory):
    _class.__module__ = __name__
del _class
