# SPDX-License-Identifier: Apache-2.0
# From a fresh clone on Debian 12: `make demo` or `make test`, in either order. The work is CMake's;
# this only installs what is missing and names the usual steps.
.PHONY: setup models configure build program wheel deb test test-fast demo api bench benchmark-page bench-check format tidy fuzz sanitize clean
.DEFAULT_GOAL := build

program := build/release/bin/stillmap
demo := out/demo
comma := ,
# Its name changes with tools/setup's content, so an edit of the package list sets up again.
setup_stamp := build/.setup-$(firstword $(shell cksum tools/setup))

setup: $(setup_stamp)

$(setup_stamp):
	@tools/setup
	@mkdir -p build && rm -f build/.setup-* && touch $@

# ONNX Runtime and the networks of `--segmenter auto`; 300 MB once. With the headers that come along,
# what is built from here on can run networks.
models: setup
	@tools/fetch_models
	@test ! -f build/release/build.ninja || cmake --preset release >/dev/null

configure: setup
	@test -f build/release/build.ninja || cmake --preset release

build: configure
	@cmake --build --preset release --parallel

# The program and what it links, no test.
program: configure
	@cmake --build --preset release --parallel --target stillmap_program

# The Python package as a wheel in build/wheel (docs/python.md).
wheel: configure
	@/usr/bin/python3 -m pip wheel --quiet --no-build-isolation --no-deps --wheel-dir build/wheel .
	@ls build/wheel/*.whl

# Packages for Debian 12 in build/release/packages (docs/packages.md).
deb: build
	@tools/setup help2man dpkg-dev file
	@tools/man_pages $(program) build/release/man
	@cpack --config build/release/CPackConfig.cmake -B build/release/packages >build/release/cpack.log || \
	  { cat build/release/cpack.log; exit 1; }
	@ls build/release/packages/*.deb

test: build
	@ctest --preset release --parallel "$$(nproc)" --no-tests=error

# The tests that take less than a minute together (cmake/slow_tests.cmake names the others).
test-fast: build
	@ctest --preset release --parallel "$$(nproc)" --no-tests=error --label-regex fast

# The networks of `make models`, where they are or can be had, find the people; else the renderer
# tells, with a network's faults.
demo: setup
	@$(MAKE) --no-print-directory models || echo "networks    not to be had here: see above"
	@$(MAKE) --no-print-directory $(demo)/sequence
	@if $(program) segment $(demo)/sequence --out $(demo)/detections --segmenter auto 2>/dev/null; then \
	  found=$(demo)/detections; echo "people      found by the networks of make models"; \
	else \
	  found=$(demo)/sequence/detections; \
	  echo "people      as rendered, with a network's faults (make models gets real networks)"; \
	fi; \
	$(program) run $(demo)/sequence --out $(demo)/run --segmenter detections:$$found
	@echo
	@echo "trajectory  $(demo)/run/trajectory.txt"
	@echo "map         $(demo)/run/map.ply"
	@echo "report      $(demo)/run/report.html"

# Rendered under another name first, so that an interrupted one is not taken for the whole.
$(demo)/sequence: | program
	@rm -rf $@ $@.partial && mkdir -p $(demo)
	@$(program) synth $@.partial --scene walking_xyz --frames 150 --detections imperfect
	@mv $@.partial $@

# BENCH=full: also 1000 and 3000 frames, there and back.
bench: setup
	@cmake --preset release -B build/bench -DSTILLMAP_BUILD_BENCHMARKS=ON -DSTILLMAP_BUILD_TESTS=OFF
	@cmake --build build/bench --parallel
	@tools/bench_runs --program build/bench/bin/stillmap --parts build/bench/bin --out build/bench/results.json \
	  $(if $(filter full,$(BENCH)),--lengths 1000$(comma)3000) $(addprefix --data ,$(DATA)) $(SEQUENCES)

# All of it, also on the recorded sequences of DATA, into docs/benchmarks.md and a page with plots.
benchmark-page: DATA ?= $(or $(STILLMAP_DATA),$(wildcard ../shared/data))
benchmark-page:
	@$(MAKE) --no-print-directory bench BENCH=full DATA=$(DATA)
	@tools/benchmark_page build/bench/results.json --html build/bench/benchmarks.html
	@echo "page        build/bench/benchmarks.html"

# The processor's time of 100 frames, measured by what the same machine needs for a fixed piece of work,
# against that of the last release.
bench-check: build
	@tools/bench_runs --program $(program) --frames 100 --out build/bench/check.json
	@tools/bench_compare bench/baseline.json build/bench/check.json --only user_cpu_ms --yardstick --at-most 1.5

# The page of the library's classes: build/api/html/index.html.
api: setup
	@tools/api_page build/api

format: setup
	@tools/check_format --fix

tidy: setup
	@tools/setup clang-tidy
	@cmake --preset tidy
	@cmake --build --preset tidy --parallel

# Every fuzzer in turn, for MINUTES each (docs/fuzzing.md).
fuzz: setup
	@tools/setup clang libclang-rt-14-dev
	@cmake --preset fuzz >/dev/null
	@cmake --build --preset fuzz --parallel
	@tools/fuzz build/fuzz/bin out/fuzz $(or $(MINUTES),5)

# The tests under the address and undefined-behaviour sanitizers, then under the thread sanitizer; those that
# make no sense there are listed as disabled (cmake/test_kinds.cmake).
sanitize: setup
	@tools/setup clang libclang-rt-14-dev llvm
	@for preset in asan tsan; do \
	  cmake --preset $$preset >/dev/null && cmake --build --preset $$preset --parallel && \
	  ctest --preset $$preset --parallel "$$(nproc)" --no-tests=error || exit 1; \
	done

clean:
	rm -rf build out
