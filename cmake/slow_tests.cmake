# SPDX-License-Identifier: Apache-2.0
# stillmap_slow_tests_NAME: GoogleTest's patterns of the tests of NAME_test that take long; "*" for all.
# They have the label slow, all others fast (`make test-fast`): those take less than a minute together
# on two idle cores. docs/benchmarks.md tells how the times were measured.
