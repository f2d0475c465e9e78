# SPDX-License-Identifier: Apache-2.0
"""Images and objects as arrays: what is shared, what is copied, what is refused."""
import gc
import os
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import stillmap

HEIGHT, WIDTH = 120, 160


def camera():
    return stillmap.Camera(width=WIDTH, height=HEIGHT, fx=150, fy=150, cx=80, cy=60,
                           depth_factor=1000)


def images(shift=0):
    """A painted wall, `shift` pixels farther to the left."""
    random = np.random.default_rng(7)
    tiles = random.integers(0, 256, (HEIGHT // 6, WIDTH // 4, 3), dtype=np.uint8)
    color = np.ascontiguousarray(tiles.repeat(6, 0).repeat(6, 1)[:, shift:shift + WIDTH])
    depth = np.full((HEIGHT, WIDTH), 1.5, np.float32)
    return color, depth


def run(change=lambda color, depth: (color, depth), **options):
    """The poses of a few frames whose arrays were changed."""
    slam = stillmap.Slam(camera(), {"dynamics.mode": "off"}, threads=1)
    for k in range(4):
        frame = slam.process(*change(*images(2 * k)), k / 30, **options)
        assert frame.status in ("initialized", "tracked")
    return slam.finish().trajectory.poses


def test_the_poses_are_those_of_the_motion():
    # 2 pixels of 150 at 1.5 m: what is in the middle of the image is 2 cm a frame farther right.
    # (The plane wall alone hardly tells a step from a turn.)
    middle = run()[-1] @ [0, 0, 1.5, 1]
    assert np.allclose(middle[:3], [0.06, 0, 1.5], atol=0.005)


def test_a_wide_lens_is_read_back_from_its_file(tmp_path):
    wide = stillmap.Camera(width=640, height=480, fx=200, fy=210, cx=320, cy=240, lens="fisheye",
                           k1=0.1, k2=0.01, k3=-0.02, k4=0.003)
    (tmp_path / "wide.yaml").write_text(wide.yaml())
    back = stillmap.Camera.load(tmp_path / "wide.yaml")
    assert (back.lens, back.k1, back.k4, back.fy) == ("fisheye", 0.1, 0.003, 210)
    assert camera().lens == "brown_conrady"


@pytest.mark.parametrize("name, change", [
    ("bgr view", lambda color, depth: (color[..., ::-1].copy()[..., ::-1], depth)),
    ("rows apart", lambda color, depth: (np.pad(color, ((0, 0), (0, 9), (0, 0)))[:, :WIDTH],
                                         np.pad(depth, ((0, 0), (0, 9)))[:, :WIDTH])),
    ("columns apart", lambda color, depth: (color.repeat(2, 1)[:, ::2],
                                            depth.repeat(2, 1)[:, ::2])),
    ("upside down", lambda color, depth: (color[::-1].copy()[::-1], depth[::-1].copy()[::-1])),
    ("millimetres", lambda color, depth: (color, (depth * 1000).astype(np.uint16))),
    ("read only", lambda color, depth: (
        np.frombuffer(color.tobytes(), np.uint8).reshape(color.shape), depth)),
])
def test_the_layout_of_arrays_makes_no_difference(name, change):
    assert np.array_equal(run(change), run()), name


def test_copies_make_no_difference():
    assert np.array_equal(run(copy=True), run())


def test_missing_depth_may_be_zero_nan_infinite_or_negative():
    def with_hole(value):
        def change(color, depth):
            depth[40:80, 40:80] = value
            return color, depth
        return change

    holes = run(with_hole(0))
    assert not np.array_equal(holes, run())
    for value in (np.nan, np.inf, -np.inf, -1):
        assert np.array_equal(run(with_hole(value)), holes)


def test_arrays_are_shared_as_long_as_they_are_needed():
    slam = stillmap.Slam(camera(), {"dynamics.mode": "full"}, threads=2)
    color, depth = images()
    before = sys.getrefcount(color), sys.getrefcount(depth)
    slam.process(color, depth, 0)
    assert sys.getrefcount(depth) > before[1]  # compared with later frames
    slam.finish()
    del slam
    gc.collect()
    assert (sys.getrefcount(color), sys.getrefcount(depth)) == before
    copied = stillmap.Slam(camera(), {"dynamics.mode": "full"}, threads=1)
    copied.process(color, depth, 0, copy=True)
    copied.process(color, depth, 1, copy=True)  # gives up what the first call lent
    assert sys.getrefcount(color) <= before[0] + 1


def test_results_cannot_be_written_to():
    slam = stillmap.Slam(camera(), {"dynamics.mode": "off"})
    slam.process(*images(), 0)
    points = slam.finish().map.points
    assert points.base is not None and points.dtype == np.float32 and points.shape[1] == 3
    with pytest.raises(ValueError, match="read-only"):
        points[0] = 0


def test_masks_become_ids_and_boxes():
    masks = np.zeros((2, HEIGHT, WIDTH), bool)
    masks[0, 10:30, 20:50] = True
    masks[1, 20:40, 40:60] = True
    found = stillmap.Detections(["Pedestrian", "sofa"], scores=[0.9, 0.5], masks=masks)
    assert found.class_names == ["person", "couch"]
    assert found.mask[25, 45] == 1 and found.mask[35, 45] == 2 and found.mask[0, 0] == 0
    # Of the second object only what the first leaves: rows 20 to 39, columns 40 to 59.
    assert found.boxes.tolist() == [[20, 10, 50, 30], [40, 20, 60, 40]]
    assert np.array_equal(stillmap.Detections(["person", "couch"], masks=found.mask).mask,
                          found.mask)


def test_trajectories_and_clouds_are_what_was_given(tmp_path):
    poses = np.tile(np.eye(4), (3, 1, 1))
    poses[:, :3, 3] = [[0, 0, 0], [0.5, 0, -1], [1, 2, 3]]
    poses[2, :3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    given = stillmap.Trajectory([0.5, 1, 2], poses)
    given.save(tmp_path / "t.txt")
    read = stillmap.Trajectory.load(tmp_path / "t.txt")
    assert np.allclose(read.poses, poses, atol=1e-6) and read.stamps.tolist() == [0.5, 1, 2]
    points = np.arange(12, dtype=np.float32).reshape(4, 3)
    colors = np.arange(12, dtype=np.uint8).reshape(4, 3)
    stillmap.PointCloud(points, colors, np.uint8([0, 1, 2, 3])).save(tmp_path / "c.ply")
    cloud = stillmap.PointCloud.load(tmp_path / "c.ply")
    assert np.array_equal(cloud.points, points) and np.array_equal(cloud.colors, colors)
    assert [stillmap.CLASS_NAMES[label] for label in cloud.labels[:2]] == ["", "person"]


COLOR, DEPTH = images()


def process(color=COLOR, depth=DEPTH, stamp=0, objects=None):
    return stillmap.Slam(camera()).process(color, depth, stamp, objects)


def process_twice():
    slam = stillmap.Slam(camera())
    slam.process(COLOR, DEPTH, 2)
    slam.process(COLOR, DEPTH, 2)


def process_after_the_end():
    slam = stillmap.Slam(camera())
    slam.finish()
    slam.process(COLOR, DEPTH, 0)


@pytest.mark.parametrize("call, message", [
    (lambda: process(color=COLOR[..., :2]), "color: 120 x 160 x 2 uint8, expected height x"),
    (lambda: process(color=COLOR / 255), "color: 120 x 160 x 3 float64, expected"),
    (lambda: process(color=COLOR.tolist()), "color: a list, expected"),
    (lambda: process(color=COLOR[:100]), "color: 100 x 160 pixels, expected 120 x 160"),
    (lambda: process(depth=DEPTH[:, :100]), "depth: 120 x 100 pixels, expected 120 x 160"),
    (lambda: process(depth=DEPTH.astype(float)), "depth: 120 x 160 float64, expected"),
    (lambda: process(stamp=float("nan")), "stamp: nan, expected seconds"),
    (lambda: process(stamp="1 2"), "stamp: '1 2', expected a finite number"),
    (lambda: process_twice(), "stamp: 2.000000 after 2.000000, expected stamps that increase"),
    (lambda: process_after_the_end(), "the run has ended with finish"),
    (lambda: process(objects=[1]), "objects: a list, expected Detections or None"),
    (lambda: process(objects=stillmap.Detections(["person"], boxes=[[5, 5, 2, 9]])), "objects"),
    (lambda: process(objects=stillmap.Detections(["person"], masks=np.ones((1, 9, 9)))),
     "objects: masks of 9 x 9 pixels, expected 120 x 160"),
    (lambda: stillmap.Detections(["person"]), "boxes: missing; expected boxes or masks"),
    (lambda: stillmap.Detections(["a"], masks=np.zeros((1, 9, 9))), "masks: object 0 has no pixel"),
    (lambda: stillmap.Detections(["a"], scores=[1, 1], boxes=[[0, 0, 1, 1]]), "scores: 2 of them"),
    (lambda: stillmap.Camera(width=9, height=9, fx=1, fy=1, cx=0, cy=0, k7=1),
     "Camera: unknown k7"),
    (lambda: stillmap.Camera(width=9, height=9, fx=1, fy=1, cx=0, cy=0, lens="fish"),
     "Camera: lens is 'fish', expected brown_conrady or fisheye"),
    (lambda: stillmap.Camera(width=9, height=9), "Camera: fx is missing"),
    (lambda: stillmap.Camera.load("tum_fr7"), "unknown camera 'tum_fr7': did you mean"),
    (lambda: stillmap.Slam(3), "camera: a int, expected a Camera"),
    (lambda: stillmap.Slam(camera(), {"seed": "x"}), "seed"),
    (lambda: stillmap.Slam(camera(), ["seed"]), "settings: a list, expected a dict"),
    (lambda: stillmap.Slam(camera(), localize_only=True), "localize_only needs a map"),
    (lambda: stillmap.Slam(camera(), threads=0), "threads: 0, expected 1 or more"),
    (lambda: stillmap.Slam(camera()).save("x"), "x: finish() comes before save()"),
    (lambda: stillmap.Trajectory([0, 0], np.tile(np.eye(4), (2, 1, 1))), "stamps[1]: 0.000"),
    (lambda: stillmap.Trajectory([0], [2 * np.eye(4)]), "poses[0]: no rigid transform"),
    (lambda: stillmap.Trajectory([0], np.eye(4)), "poses: 4 x 4 float64, expected 1 x 4 x 4"),
    (lambda: stillmap.PointCloud(np.zeros((2, 2))), "points: 2 x 2 float64, expected N x 3"),
    (lambda: stillmap.PointCloud(np.zeros((2, 3)), np.zeros((2, 3))), "colors: 2 x 3 float64"),
    (lambda: stillmap.Segmenter("bogus")(COLOR), "bogus"),
    (lambda: stillmap.Sequence("/nowhere"), "/nowhere"),
    (lambda: stillmap.Session.load("/nowhere.stillmap"), "/nowhere.stillmap"),
    (lambda: stillmap.run("/nowhere", "/tmp/never"), "/nowhere"),
    (lambda: stillmap.run("/nowhere", "/tmp/never", wrong=1), "--wrong"),
    (lambda: stillmap.synth("/tmp/never", "wakling_xyz"), "did you mean 'walking_xyz'?"),
])
def test_errors_are_one_line(call, message):
    with pytest.raises(stillmap.Error) as caught:
        call()
    assert message in str(caught.value) and "\n" not in str(caught.value)
    assert isinstance(caught.value, ValueError)


def test_settings_have_their_types():
    defaults = stillmap.default_settings()
    assert defaults["tracking.features"] > 0 and isinstance(defaults["tracking.features"], int)
    assert defaults["dynamics.mode"] == "full" and defaults["dynamics.fill_boxes"] is True
    stillmap.Slam(camera(), defaults)  # takes what it gives


def test_other_threads_run_while_the_library_works():
    slam = stillmap.Slam(camera(), threads=1)
    for k in range(20):
        slam.process(*images(2 * k), k / 30)
    begun = threading.Event()

    def finish():
        begun.set()
        for _ in range(40):
            slam.map()  # each some milliseconds of C++

    worker = threading.Thread(target=finish)
    worker.start()
    begun.wait()
    ticks = 0
    while worker.is_alive():
        ticks += 1
        time.sleep(0.0002)
    # With the lock held, this thread would run between two calls alone.
    assert ticks > 2 * 40


@pytest.mark.parametrize("end", ["", "del slam, color, depth", "slam.finish()", "sys.exit(0)"])
def test_python_ends_with_a_slam_that_is_still_there(end, tmp_path):
    script = tmp_path / "script.py"
    script.write_text("from arrays_test import *\n"
                      "slam = stillmap.Slam(camera(), threads=3)\n"
                      "for k in range(6):\n"
                      "    color, depth = images(2 * k)\n"
                      "    slam.process(color, depth, k / 30)\n" + end)
    done = subprocess.run([sys.executable, script], capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": os.pathsep.join(
                              [os.environ["PYTHONPATH"], os.path.dirname(__file__)])})
    assert (done.returncode, done.stderr) == (0, "")
