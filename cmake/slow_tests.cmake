# SPDX-License-Identifier: Apache-2.0
# stillmap_slow_tests_NAME: GoogleTest's patterns of the tests of NAME_test that take more than a second
# or two; "*" for all. They have the label slow, all others fast (`make test-fast`).
set(stillmap_slow_tests_program *)
set(stillmap_slow_tests_relocation *)
set(stillmap_slow_tests_runs *)
set(stillmap_slow_tests_synth *)
set(stillmap_slow_tests_system *)
