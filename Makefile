# make demo   see the axis run on ROS 2, and find what a recorded machine hides; SEED=7 repeats one
# make test   lint, types and tests: a quarter of an hour on two cores
# make check  what takes longer and breaks rarely: make slow, supply and pythons; WITHIN=600 stops after so many seconds
# make docs   the manual as HTML, into .cache/manual: pages of docs/, and a reference made from the code
# make bench  print the tables of benchmarks/
# make paper  the paper reproduced: its tables, Fig. 4 and Fig. 6, on recordings of the second simulator
# make fuzz   bad input for every parser, 100,000 times; FUZZ="--inputs 5000" for less
# make chaos  300 faults in running nodes, at random; CHAOS="--minutes 5 --seed 2" for others
# make endurance  24 h of simulated and 20 min of real time; ENDURANCE="--hours 1 --minutes 2" for less
# make slow       the tests that make test leaves out: colcon, installed wheels, full disks, whole diagnoses of a rig
# make supply     wheel and archive installed and run in empty environments, licences; PYTHONS="python3.10 python3.13"
# make pythons    the tests that compute on Python 3.10 and 3.13 as well, where they are installed
#
# Each sets up what it needs, once: a virtual environment in .venv. Nothing is written outside this folder and $ROS_HOME
# (~/.ros unless set otherwise); but as root on Debian, `make test` installs Chromium, to look at reports.
#   PYTHON=python3.12       the Python to use; else the first suitable one is found
#   RIG=path                recordings of a test rig, for the tests (../shared/rig)
#   REAL=path               tables of real machines, for the tests: a folder for each map of benchmarks/real
#   DEMO="--seconds 5"      further options of `pneumo demo`
#   PYTEST="-k records -x"  further options of pytest

SHELL := /bin/sh
PYTHON ?=
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/ready
RIG ?= ../shared/rig

# A sourced ROS 2 distribution must not reach into the environment, nor the marks of another environment's wheels.
unexport PYTHONPATH PYTHONHOME LD_LIBRARY_PATH _ROS_WHEELS_BOOTSTRAP_COMPLETE
# Tests start hundreds of Python processes: each would compile every module again.
unexport PYTHONDONTWRITEBYTECODE
unexport AMENT_PREFIX_PATH COLCON_PREFIX_PATH CMAKE_PREFIX_PATH
unexport ROS_DISTRO ROS_VERSION ROS_PYTHON_VERSION RMW_IMPLEMENTATION

CACHE := $(CURDIR)/.cache
export TMPDIR := $(CACHE)/tmp
ifeq ($(PIP_CACHE_DIR),)
export PIP_CACHE_DIR := $(CACHE)/pip
endif
# ROS writes its logs below the home folder, and refuses to start without one.
ifeq ($(HOME)$(ROS_HOME),)
export ROS_HOME := $(CACHE)/ros
endif
# Tests that read recordings of a rig find them here.
ifneq ($(wildcard $(RIG)/healthy),)
export PNEUMO_RIG := $(shell cd "$(RIG)" && pwd)
endif

# Tests that read tables of real machines find them here.
ifneq ($(REAL),)
export PNEUMO_REAL := $(shell cd "$(REAL)" && pwd)
endif

.PHONY: help demo test check docs slow bench paper fuzz chaos endurance supply pythons clean
.DELETE_ON_ERROR:

help:
	@sed -n '/^#/!q; s/^# \{0,1\}//p' Makefile

.cache/tmp:
	@mkdir -p $@

$(READY): setup.py tools/make_venv | .cache/tmp
	@tools/make_venv $(VENV) $(PYTHON)
	@touch $@

# The demo diagnoses a machine that the second simulator under test/ makes up, which shares no code with the package.
demo: $(READY) | .cache/tmp
	@$(BIN)/pneumo demo $(if $(SEED),--seed $(SEED)) $(DEMO)

test: $(READY) | .cache/tmp
	@tools/chromium
	@tools/timed "ruff check" $(BIN)/ruff check .
	@tools/timed "ruff format" $(BIN)/ruff format --check .
	@tools/timed mypy $(BIN)/mypy
	@tools/timed tests tools/run_tests $(BIN)/python $(PYTEST)

# The reference, with a picture for each effect, is written anew each time; nothing is fetched; a warning is an error.
docs: $(READY) | .cache/tmp
	@$(BIN)/python -m sphinx -W --keep-going -q -b html docs $(CACHE)/manual
	@echo "The manual is in .cache/manual/index.html"

check:
	@tools/check $(MAKE) $(WITHIN)

slow: $(READY) | .cache/tmp
	@tools/timed "slow tests" tools/run_tests --check $(BIN)/python $(PYTEST)

bench: $(READY) | .cache/tmp
	@set -e; for table in benchmarks/bench_*.py; do $(BIN)/python "$$table"; done

paper: $(READY) | .cache/tmp
	@$(BIN)/python -m benchmarks.paper $(if $(SEED),--seed $(SEED))

fuzz: $(READY) | .cache/tmp
	$(BIN)/python benchmarks/fuzz.py $(FUZZ)

chaos: $(READY) | .cache/tmp
	$(BIN)/python benchmarks/chaos.py $(CHAOS)

endurance: $(READY) | .cache/tmp
	$(BIN)/python benchmarks/endurance.py $(ENDURANCE)

supply: $(READY) | .cache/tmp
	$(BIN)/python tools/supply.py $(if $(PYTHONS),--python $(PYTHONS))

pythons: $(READY)
	@tools/other_pythons $(MAKE)

clean:
	rm -rf $(VENV) .venv-3.* .cache .mypy_cache .pytest_cache .ruff_cache build dist install log demo_output *.egg-info
