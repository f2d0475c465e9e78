# SPDX-License-Identifier: Apache-2.0
"""Slam, frame by frame: the program's bits, objects of any network, saved sessions."""
import numpy as np
import pytest

import stillmap


def run_over(sequence, find=lambda frame: None, **options):
    slam = stillmap.Slam(sequence.camera, **options)
    for frame in sequence:
        slam.process(frame.color, frame.depth, frame.stamp_text, find(frame))
    return slam, slam.finish()


@pytest.mark.parametrize("threads", [1, 3])
def test_has_the_bits_of_the_program(walking, program_run, tmp_path, threads):
    _, result = run_over(walking, threads=threads)
    result.trajectory.save(tmp_path / "trajectory.txt")
    result.keyframes.save(tmp_path / "keyframes.txt")
    result.map.save(tmp_path / "map.ply")
    for file in ("trajectory.txt", "keyframes.txt", "map.ply"):
        assert (tmp_path / file).read_bytes() == (program_run / file).read_bytes(), file


def test_objects_of_any_network_keep_people_out(walking):
    """The same run with and without the objects, in a mode that knows no other means."""
    truth = stillmap.Trajectory.load(walking.folder / "groundtruth.txt")
    given = stillmap.Segmenter(f"detections:{walking.folder}/detections")
    seen = []

    def network(frame):
        found = given(frame.color, frame.stamp_text)
        seen.append(found)
        # As an own network gives it: names, scores, boxes and one mask for each object.
        masks = np.array([found.mask == i + 1 for i in range(len(found))], bool)
        return stillmap.Detections(found.class_names, found.scores, found.boxes, masks)

    settings = {"dynamics.mode": "mask"}
    _, without = run_over(walking, settings=settings)
    _, with_objects = run_over(walking, network, settings=settings)
    assert any("person" in found.class_names for found in seen)
    dynamic = stillmap.PointCloud.load(walking.folder / "truth/dynamic_map.ply")
    static = stillmap.PointCloud.load(walking.folder / "truth/static_map.ply")
    quality = [stillmap.evaluate_map(result.map, static, dynamic, truth, result.trajectory)
               for result in (without, with_objects)]
    assert quality[1]["da"] > quality[0]["da"] + 0.2


def test_tells_what_became_of_objects(walking):
    given = stillmap.Segmenter(f"detections:{walking.folder}/detections")
    slam = stillmap.Slam(walking.camera)
    for frame in walking:
        result = slam.process(frame.color, frame.depth, frame.stamp_text,
                              given(frame.color, frame.stamp_text))
    people = [state for state in result.objects if state.class_name == "person"]
    assert people
    for state in people:
        assert state.dynamic and state.category == "dynamic" and len(state.box) == 4
        number = 1 + [other.track for other in result.objects].index(state.track)
        assert (result.object_mask == number).any()
        assert result.excluded[result.object_mask == number].all()
    assert result.pose.shape == (4, 4) and np.allclose(result.pose[3], [0, 0, 0, 1])
    assert result.features.shape == (len(result.feature_tracked), 2)
    assert result.feature_tracked.sum() == result.tracked_features > 0
    assert 0 < result.pose_ms <= result.library_ms and "tracking" in result.stages


def test_objects_are_carried_over_frames_that_no_network_saw(walking):
    given = stillmap.Segmenter(f"detections:{walking.folder}/detections")
    slam = stillmap.Slam(walking.camera)
    for frame in walking:
        looked = frame.id % 2 == 0
        found = given(frame.color, frame.stamp_text)
        result = slam.process(frame.color, frame.depth, frame.stamp_text, found if looked else None)
        if not looked and frame.id > 4 and len(found):
            assert any(state.filled for state in result.objects)
            assert not result.is_keyframe
    assert len(slam.finish().trajectory) == len(walking)


def test_the_map_so_far_is_that_of_the_end(walking):
    slam = stillmap.Slam(walking.camera)
    assert not slam.needs_objects or len(slam.map()) == 0
    for frame in walking:
        slam.process(frame.color, frame.depth, frame.stamp)
    so_far = slam.map()
    result = slam.finish()
    assert np.array_equal(so_far.points, result.map.points) and len(so_far) > 1000
    assert slam.finish() is result or len(slam.finish().map) == len(result.map)
    assert np.array_equal(slam.map().points, result.map.points)


def test_sessions_go_on(walking, tmp_path):
    slam, result = run_over(walking)
    slam.save(tmp_path / "map.stillmap")
    session = stillmap.Session.load(tmp_path / "map.stillmap")
    assert np.array_equal(session.map().points, result.map.points)
    assert np.array_equal(session.trajectory.poses, result.trajectory.poses)
    assert np.array_equal(session.keyframes.poses, result.keyframes.poses)
    assert session.camera.width == 320
    session.save(tmp_path / "again.stillmap")
    assert (tmp_path / "again.stillmap").read_bytes() == (tmp_path / "map.stillmap").read_bytes()

    localized, seen = run_over(walking, load=tmp_path / "map.stillmap", localize_only=True)
    # In the world of the saved map: the same poses within a centimetre.
    known = dict(zip(result.trajectory.stamps, result.trajectory.poses))
    off = [np.linalg.norm(known[s][:3, 3] - T[:3, 3])
           for s, T in zip(seen.trajectory.stamps, seen.trajectory.poses)]
    assert len(off) > 30 and max(off) < 0.02
    with pytest.raises(stillmap.Error, match="only localises"):
        localized.save(tmp_path / "never.stillmap")
    both = session.merged(stillmap.Session.load(tmp_path / "again.stillmap"))
    assert both is not None and len(both.keyframes) > len(session.keyframes)
