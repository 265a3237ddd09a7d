# The entry point for developers. Each target first installs or builds what it needs: packages, data, the build.
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PRECIOUS: build/%/build.ninja
.PHONY: help setup setup-ci program compare pictures experiments paper published deb release abi python test-python test-rust test-bevy sanitize-rust wasm test-wasm test-installed compare-web playground test-playground film bench test sanitize systems windows clang format check-format lint docs clean

jobs := $(shell nproc)
soak := $(basename $(notdir $(wildcard tools/bench/soak.cpp)))
PROCESSES := 10
sources := find $(wildcard include src bindings distributed integrations tools tests examples) -name '*.[ch]pp'
# Prints the sources that a build compiles; a unity source includes several others.
compiled := sed -n 's/^ *"file": "\(.*\)".*/\1/p'

help: ## List the targets
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 24

compare: program ## Build the program and run the quick comparison, or that of COMPARE_ARGS
	build/release/broadside compare $(COMPARE_ARGS)

paper: setup ## Print the paper (Markdown, PDF, HTML) and README's figures from the committed results
	$(debian_python) -m tools.paper print --to docs/paper

# Each run is stored, so an interrupted measurement resumes. Debian's Python has the packages.
RUNS := 3
debian_python := $(firstword $(wildcard /usr/bin/python3) python3)

experiments: program ## Measure the paper's experiments in RUNS=3 runs and judge them: build/experiments/
	$(debian_python) -m tools.paper run --runs $(RUNS)
	$(debian_python) -m tools.paper judge

# A commit identifies the measured revision, so there must be no uncommitted changes.
published: program ## Measure the comparison in PROCESSES=10 processes, then publish it and the experiments: tools/paper/results
	git diff --quiet HEAD
	$(debian_python) -m tools.paper compare --runs $(PROCESSES)
	$(debian_python) -m tools.paper publish

bench: program ## Run the long comparison (also written to build/bench.json), the motion benchmark and a soak test
	cmake --build --preset release --target motion $(soak)
	build/release/broadside compare --long --json build/bench.json
	build/release/bench/motion
	$(addprefix build/release/bench/,$(soak))

pictures: program ## Redraw the pictures of docs/algorithms.md
	tools/docs/pictures build/release/broadside docs/pictures

docs: build/docs/ready ## Build the documentation as a site: build/docs/site/index.html
	build/docs/venv/bin/python tools/docs/site.py build/docs

build/docs/ready: tools/docs/requirements.txt | setup
	python3 -m venv --clear build/docs/venv
	build/docs/venv/bin/python -m pip install --quiet --requirement $<
	touch $@

deb: build/deb/build.ninja ## Make Debian packages of library, headers and program: build/deb/packages
	@test -f $< || cmake --preset deb
	cmake --build --preset deb
	rm -rf build/deb/packages
	cd build/deb && cpack

abi: setup-ci ## Update the ABI dump that tests compare the C interface with
	mkdir -p build/abi
	cmake -D HEADER=$(CURDIR)/bindings/c/broadside.h -D COMPILER=cc -D FOLDER=$(CURDIR)/build/abi \
	  -D DUMP=$(CURDIR)/bindings/c/abi/broadside.abi -P bindings/c/abi/dump.cmake

release_files := build/release_files
release: ## Build what a release carries (wheel, npm package, playground, Debian packages): build/release_files/
	$(MAKE) python
	$(MAKE) wasm
	$(MAKE) playground
	$(MAKE) deb
	rm -rf $(release_files)
	mkdir $(release_files)
	cp $(python_folder)/wheels/*.whl $(release_files)
	cp build/playground/index.html $(release_files)/broadside-playground.html
	cp build/deb/packages/*.deb $(release_files)
	cd $(release_files) && npm pack --silent $(CURDIR)/$(wasm_folder)/package && sha256sum * >SHA256SUMS

# CMake's build folder and two virtual environments are kept: one builds the wheel, the other tests it.
python_folder := build/python

python: $(python_folder)/builder/ready ## Build the Python package as a wheel: build/python/wheels/
	rm -rf $(python_folder)/wheels
	$(python_folder)/builder/bin/python -m pip wheel . --quiet --no-build-isolation --no-deps --wheel-dir $(python_folder)/wheels \
	  --config-settings build-dir=$(python_folder)/cmake

test-python: python $(python_folder)/tester/ready ## Install the wheel and run the tests of the Python package
	$(python_folder)/tester/bin/python -m pip install --quiet --force-reinstall --no-deps $(python_folder)/wheels/*.whl
	$(python_folder)/tester/bin/python -m pytest -q tests/bindings/python
	$(python_folder)/tester/bin/python -m pytest -q tests/tools/bench/python

$(python_folder)/builder/ready: bindings/python/requirements.txt
$(python_folder)/tester/ready: tests/bindings/python/requirements.txt
$(python_folder)/%/ready: | setup
	python3 -m venv --clear $(@D)
	$(@D)/bin/python -m pip install --quiet --requirement $<
	touch $@

# Its own target folder; `cargo package` fetches the optional crates.
test-rust: export CARGO_TARGET_DIR := $(CURDIR)/build/rust
test-rust: | setup ## Test the Rust crate, and build what `cargo package` packs; needs cargo, and the network once
	cargo test --quiet --all-features
	cargo run --quiet --example falling_boxes
	cargo package --quiet --allow-dirty

test-bevy: export CARGO_TARGET_DIR := $(CURDIR)/build/rust
test-bevy: | setup ## Test the plugin for Bevy; needs cargo 1.95 and the network
	cargo test --quiet --manifest-path bindings/rust/bevy/Cargo.toml

# The options instrument Rust's code too. They are of nightly compilers, but others take them with RUSTC_BOOTSTRAP.
sanitize-rust: export RUSTC_BOOTSTRAP := 1
sanitize-rust: export RUSTFLAGS := -Zsanitizer=address -Zexternal-clangrt -Clinker=clang++ -Clink-arg=-fsanitize=address,undefined
sanitize-rust: export RUSTDOCFLAGS = $(RUSTFLAGS)
sanitize-rust: export BROADSIDE_LIB_DIR := $(CURDIR)/build/asan/src
sanitize-rust: build/asan/build.ninja ## Test the Rust crate with the address sanitizer in Rust and C++
	@test -f $< || cmake --preset asan
	cmake --build --preset asan --target src/libbroadside.a
	cmake -E make_directory build/asan/src/pkgconfig
	cmake -E copy build/asan/broadside.pc build/asan/src/pkgconfig
	cargo test --quiet --target-dir build/asan/rust --target "$$(rustc -vV | sed -n 's/^host: //p')"

# CMake's build folders: one for each dimension.
wasm_folder := build/wasm
wasm_dimensions := 2d 3d

wasm: $(wasm_dimensions:%=$(wasm_folder)/%/build.ninja) ## Build the npm package for JavaScript: build/wasm/package/
	for dimension in $(wasm_dimensions); do \
	  test -f $(wasm_folder)/$$dimension/build.ninja || emcmake cmake --preset wasm-$$dimension || exit 1; \
	  cmake --build --preset wasm-$$dimension || exit 1; done
	node bindings/wasm/build.mjs $(wasm_folder) $(wasm_folder)/package

test-wasm: wasm ## Run the tests of the npm package
	node bindings/wasm/build.mjs --tests $(wasm_folder)/tests $(wasm_folder)/package
	BROADSIDE_PACKAGE=$(CURDIR)/$(wasm_folder)/package BROADSIDE_WEB=$(CURDIR)/tools/web \
	  node --test $(wasm_folder)/tests/

test-installed: test-wasm ## Install the npm package in an empty project, build it with Vite, test it in Node 18; needs the network
	node tests/bindings/wasm/installed.mjs $(wasm_folder)/package $(wasm_folder)/tests

$(wasm_dimensions:%=$(wasm_folder)/%/build.ninja): $(wasm_folder)/%/build.ninja: CMakePresets.json | setup
	emcmake cmake --preset wasm-$*

compare-web: wasm ## Compare the npm package with other JavaScript libraries, in Node and in Chromium
	cd tools/bench/web && npm ci --silent --ignore-scripts --no-audit --no-fund
	node tools/bench/web/compare.mjs $(wasm_folder)/package
	node tools/bench/web/compare.mjs --chromium $(wasm_folder)/package

# Its engine is the whole library, in a build of its own.
playground: $(wasm_folder)/playground/build.ninja ## Build the playground, a page to see and compare algorithms: build/playground/index.html
	@test -f $< || emcmake cmake --preset playground
	cmake --build --preset playground
	node tools/web/build.mjs --playground build/playground

test-playground: playground build/release/build.ninja ## Run the tests of the playground's page with its engine
	@test -f build/release/build.ninja || cmake --preset release
	ctest --preset release --no-tests=error --tests-regex '^web_playground'

film: playground ## Film the playground for README: docs/pictures/playground.gif
	node tools/docs/film.mjs build/playground/index.html docs/pictures/playground.gif

$(wasm_folder)/playground/build.ninja: CMakePresets.json | setup
	emcmake cmake --preset playground

# Debian's Emscripten does not find Debian's acorn by itself.
wasm test-wasm test-installed compare-web playground test-playground: export NODE_PATH := /usr/share/nodejs

test: tests-release ## Build everything and run all tests

sanitize: tests-asan tests-tsan ## Run the tests with the address, undefined-behaviour and thread sanitizers

systems: build/release/build.ninja ## Run the equivalence test on emulated ARM, Windows, 32-bit x86 and a big-endian machine
	@test -f $< || cmake --preset release
	cmake --build --preset release --target law_here
	ctest --preset release -R '^systems' --parallel $(jobs)

windows: build/windows/build.ninja ## Build the program for Windows with MinGW-w64; run it and the unit tests under Wine
	@test -f $< || cmake --preset windows
	cmake --build --preset windows
	ctest --preset windows

clang: tests-clang ## Run the tests in an optimised clang build; CI uses clang only with the address sanitizer

format: setup ## Format every source file
	$(sources) | xargs clang-format -i

# Local names may hide those of other sources in a unit.
lint: check-format build/lint/build.ninja ## Check format and types, and run clang-tidy on library, lab and program
	tools/web/node_modules/.bin/tsc --noEmit --project tools/web
	@test -f build/lint/build.ninja || cmake --preset lint
	$(compiled) build/lint/compile_commands.json | sort -u | grep --extended-regexp --invert-match \
	  '/(tests|bench)/|/lab/page_template\.cpp$$|/linked_algorithms\.cpp$$|\.c$$' | \
	  xargs -P $(jobs) -n 1 clang-tidy -p build/lint --quiet --extra-arg=-Wno-shadow

check-format: setup
	$(sources) | xargs clang-format --dry-run --Werror

clean: ## Remove everything that was built or fetched
	rm -rf build

# The comparison's other libraries are installed unless PEERS=no. RUST_PEERS sets the CMake option BROADSIDE_RUST_PEERS, which
# docs/peers.md describes.
PEERS := yes
RUST_PEERS := $(if $(filter no,$(PEERS)),OFF)
# What tools/setup/setup installs for each goal; all that building and testing takes if the goal is not listed.
of_compare := $(if $(filter no,$(PEERS)),,--peers)
of_bench := $(of_compare)
of_paper := --paper
of_experiments := --paper
of_published := --peers --paper
of_deb := --deb
of_docs := --docs
of_format := --format
of_check-format := --format
of_systems := --systems
of_windows := --systems
of_python := --python
of_test-python := --python
of_wasm := --wasm
of_test-wasm := --wasm
of_test-installed := --web
of_compare-web := --web
of_playground := --web
of_test-playground := --build --web
of_film := --film
setup_options := $(sort $(foreach goal,$(MAKECMDGOALS),$(or $(of_$(goal)),--build)))

published: RUST_PEERS := ENGINES

setup:
	@tools/setup/setup $(setup_options)

setup-ci: | setup
	@tools/setup/setup --ci

# The build must be configured again after setup has installed packages: setup then removes build.ninja, but make has
# already seen it.
# Builds everything that `cmake --install build/release` copies.
program: build/release/build.ninja ## Build the program and all that is installed with it: build/release/broadside
	@test -f $< || cmake --preset release
	$(if $(RUST_PEERS),cmake --preset release -D BROADSIDE_RUST_PEERS=$(RUST_PEERS))
	cmake --build --preset release --target broadside_installed

# Builds everything with one preset and runs its tests.
tests-%: build/%/build.ninja
	@test -f $< || cmake --preset $*
	cmake --build --preset $*
	ctest --preset $* --parallel $(jobs)

# Only the tests that use threads.
tests-tsan: build/tsan/build.ninja
	@test -f $< || cmake --preset tsan
	cmake --build --preset tsan --target thread_tests
	ctest --test-dir build/tsan/tests/threads --output-on-failure --parallel $(jobs)

# Left out: tests of other libraries, which Debian has compiled whatever our compiler; tests of other systems and of
# the installed library, which choose their own compilers; and tests of the page and the paper, which need none.
tests-clang: export GTEST_FILTER := \
  -*/cgal_*:*/boost_*:*/geos_*:*/embree_*:*/bullet_*:*/ode_*:*/fcl_*:*/box2d_*:*/chipmunk_*
tests-clang: build/clang/build.ninja
	cmake --build --preset clang
	ctest --preset clang --parallel $(jobs) --exclude-regex '^(systems|consumer|web_|tools_paper)'

build/%/build.ninja: CMakePresets.json | setup
	cmake --preset $*

# These presets use clang or its tools.
build/asan/build.ninja build/clang/build.ninja build/lint/build.ninja: | setup-ci
