# SPDX-License-Identifier: Apache-2.0
# stillmap_slow_tests_NAME: GoogleTest's patterns of the tests of NAME_test that take half a second or
# more, or belong to those; "*" for all. They have the label slow, all others fast: less than a minute
# of processor time together (`make test-fast`).
set(stillmap_slow_tests_config LoadYaml.*)
set(stillmap_slow_tests_dense FreeSpace.* System.* ViewChoice.* VoxelGrid.AgreesWith*)
set(stillmap_slow_tests_detections DetectionsFolder.Re*)
set(stillmap_slow_tests_eval SeeThrough.* StitchedMap.*)
set(stillmap_slow_tests_export FindFloor.* MakeOccupancyGrid.*)
set(stillmap_slow_tests_features CornerScores.*)
set(stillmap_slow_tests_io InflateWhole.*)
set(stillmap_slow_tests_mapping MapLocally.WithTracking*)
set(stillmap_slow_tests_motion *OnTruth)
set(stillmap_slow_tests_objects *OnTruth)
set(stillmap_slow_tests_program *)
set(stillmap_slow_tests_relocation *)
set(stillmap_slow_tests_render Renderer.*)
set(stillmap_slow_tests_runs *)
set(stillmap_slow_tests_scene Choreography.* Office.* PersonShape.IsClosed*)
set(stillmap_slow_tests_segmentation FetchedNetworks.*)
set(stillmap_slow_tests_session SessionDamage.* SessionIo.*)
set(stillmap_slow_tests_synth *)
set(stillmap_slow_tests_system *)
set(stillmap_slow_tests_tracking ReadoutEstimator.* Tracker.*)
