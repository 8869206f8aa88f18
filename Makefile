# The short way to everything. Targets install what is missing (Debian 12, apt), ask nothing and may
# be called again. See README.md.

SCENARIO ?= config/scenarios/rising-boxes.yaml
# More arguments for the program, e.g. make run ARGS=--video
ARGS ?=
# More arguments for CMake, e.g. make test CMAKE_ARGS=-DHOPSCOTCH_WERROR=ON
CMAKE_ARGS ?=
PREFIX ?= /usr/local

PROGRAM := build/release/hopscotch
BENCHES := planner mpc perception estimator sim tick wire
FUZZERS := $(basename $(notdir $(wildcard tests/fuzz/*_fuzz.cpp)))
FUZZ_SECONDS ?= 60

.PHONY: help run test build install bench campaigns check-deep format lint clean packages

help:
	@echo "make run         install what is missing, build, run the continuous-jumping demo"
	@echo "make test        install what is missing, build, run the whole test suite"
	@echo "make build       the program, build/release/hopscotch"
	@echo "make bench       the figures that the README quotes, measured here"
	@echo "make campaigns   all of config/campaigns (hours), or one: make campaigns CAMPAIGN=gaps"
	@echo "make check-deep  thread and address sanitizers, long fuzzing, clang-tidy on everything"
	@echo "make format      lay out the sources by .clang-format"
	@echo "make lint        layout, include and size rules; clang-tidy on what changed"
	@echo "make install     to PREFIX (default /usr/local)"
	@echo "make clean       remove build/ (runs/ stays)"

# The tests' packages too: one configured tree builds program and tests.
packages:
	@scripts/install_packages build run test

build: packages
	@TARGETS="hopscotch web_page" scripts/build release $(CMAKE_ARGS)

run: build
	$(PROGRAM) run $(SCENARIO) $(ARGS)

test: packages
	@scripts/build release $(CMAKE_ARGS)
	ctest --preset release --output-junit tests.xml

install: build
	cmake --install build/release --prefix $(PREFIX)

bench: build
	@for bench in $(BENCHES); do $(PROGRAM) bench $$bench || exit 1; done

# Goes on where an earlier call was; the folders are named after the files.
campaigns: build
	@broken=0; for spec in $(if $(CAMPAIGN),config/campaigns/$(CAMPAIGN).yaml,$(wildcard config/campaigns/*.yaml)); do \
	  echo "campaigns: $$spec"; \
	  $(PROGRAM) campaign $$spec --out runs/$$(basename $$spec .yaml) --resume $(ARGS) || broken=1; \
	done; exit $$broken

format:
	@scripts/install_packages lint
	@scripts/format

lint: packages
	@scripts/install_packages lint
	@scripts/format --check
	@TARGETS=check_includes scripts/build release $(CMAKE_ARGS)
	@build/release/tests/lint/check_includes .
	@scripts/tidy --changed HEAD

check-deep: packages
	@scripts/install_packages lint deep
	@scripts/build asan
	ctest --preset asan
	@scripts/build tsan
	ctest --preset tsan
	@for eyes in truth camera; do build/tsan/hopscotch run config/scenarios/flat-leaps.yaml --perception $$eyes \
	    --threads --jumps 2 --pace 0.1 --no-pictures --out build/tsan/run-$$eyes || exit 1; done
	@TARGETS="$(FUZZERS)" scripts/build fuzz
	@for fuzzer in $(FUZZERS); do scripts/fuzz $$fuzzer $(FUZZ_SECONDS) || exit 1; done
	@scripts/build release $(CMAKE_ARGS)
	ctest --preset release --build-config Deep --label-regex socketcan
	@scripts/tidy

clean:
	rm -rf build
