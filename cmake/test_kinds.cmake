# SPDX-License-Identifier: Apache-2.0
# stillmap_slow_tests_NAME: the files FILE_test.cpp of NAME_test whose tests take two seconds or more together, and
# their seconds: FILE=SECONDS. They have the label slow, all others fast: less than a minute of processor time together
# (`make test-fast`).
set(stillmap_slow_tests_config yaml_loader=2)
set(stillmap_slow_tests_dense surface_fusion=2 vacated_places=5)
set(stillmap_slow_tests_detections detections_io=2)
set(stillmap_slow_tests_devices openni_device=2 rosbridge_device=10)
set(stillmap_slow_tests_eval stitched_map=10)
set(stillmap_slow_tests_export occupancy_grid=3)
set(stillmap_slow_tests_faults faults=27 surroundings=12)
set(stillmap_slow_tests_io inflate=4)
set(stillmap_slow_tests_mapping local_mapper=7)
set(stillmap_slow_tests_motion dynamic_objects=7 motion_estimator=5)
set(stillmap_slow_tests_objects object_tracker=5)
set(stillmap_slow_tests_program
  camera=10 evaluate_trajectory=2 export=10 export_session=4 interruption=20 map_commands=13 modes=25 objects=11
  real_data=28 run=30 save_recording=4 segment=2 show_run=3 stereo_run=20)
set(stillmap_slow_tests_relocation relocation=32)
set(stillmap_slow_tests_report report_html=2)
set(stillmap_slow_tests_runs device_run=4 driver_run=5 layout_run=20 live_run=7 pipeline=8)
set(stillmap_slow_tests_scene choreography=9 office=4)
set(stillmap_slow_tests_segmentation segmenter=3)
set(stillmap_slow_tests_session session_damage=3)
set(stillmap_slow_tests_synth detection_faults=9 sequence=15 sequence_writer=7 truth_maps=2)
set(stillmap_slow_tests_system growth=34 loop_session=80 merge_tree=7 stages=40 system=40)
set(stillmap_slow_tests_tracking tracker=9)
set(stillmap_slow_tests_view view_server=3)

# Tests that are skipped where data, a program or a device is absent: expressions for SUITE.TEST.
set(stillmap_lone_tests
  OnTruth ^DepthUnitOnData[.] ^SequenceOnData[.] ^Freiburg1Xyz[.] ^StitchedMap[.] EqualsTheScriptOnPublishedTrajectories
  ^FrameObjects[.]AreThoseOfGivenSequences ^FormatObjectsJson[.]HasTheKeysOfAGivenSequence$
  ^ReadPly[.]ReadsTheSharedMaps$ ^ReadTrajectory[.]ReadsThePublishedFiles$ ^DetectionsFolder[.]ReadsThoseOfARealNetwork$
  ^OnnxNetworks[.] ^FetchedNetworks[.] ^FurniturePackage[.] ^ShowRun[.] ^ServerForPages[.] ^OpenNiDevice[.] OnADevice$
  ^Export[.].*ReadBy ^Export[.].*ReadAs ^ExportMesh[.]MeshesAreReadBy ADiskIsFull$ AFullDiskIsAnError$
  ^SaveRecording[.]DevicesAreNamedOrRefused$
  ^Surroundings[.]AnotherUserReadsWhatNobodyMayWrite$ ^Surroundings[.]LanguagesMakeNoDifference$)

# Tests that make no sense under sanitizers, as expressions for CTest's names: with STILLMAP_SANITIZE CTest lists them as
# disabled. The Python package is not built there at all (cmake/python.cmake), and with it its tests.
set(stillmap_unsanitized_tests
  ^faults[.]faults$                       # its library replaces the calls that the sanitizers replace, too
  ^install_consumer$ ^configure_parts$    # they configure and build projects of their own
  ^api_page$ ^workflow[.]                 # they test Doxygen's pages and scripts in Python
  _browser$)                              # they measure how soon a page shows what happens

# Tests whose leaks tools/lsan.supp can only tell by whole stacks, which cost time: expressions for SUITE.TEST.
set(stillmap_whole_stack_tests ^OpenNiDevice[.] OnADevice$ ^SaveRecording[.]DevicesAreNamedOrRefused$)

# A sanitized program needs some ten times as long.
set(stillmap_test_timeout_s 600)
if(STILLMAP_SANITIZE)
  set(stillmap_test_timeout_s 3600)
else()
  set(stillmap_unsanitized_tests "")
  set(stillmap_whole_stack_tests "")
endif()

# For the tests of a folder that add_test added.
function(stillmap_disable_unsanitized_tests)
  list(JOIN stillmap_unsanitized_tests "|" unsanitized)
  get_property(tests DIRECTORY PROPERTY TESTS)
  if(unsanitized)
    list(FILTER tests INCLUDE REGEX "${unsanitized}")
    set_tests_properties(${tests} PROPERTIES DISABLED TRUE)
  endif()
endfunction()
