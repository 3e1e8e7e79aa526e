# The doors of the project; continuous integration uses the same ones.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
# One more than there are cores, as tests wait for compilers and for threads of their own.
WORKERS = $(shell $(BIN)/python -c 'import os; print(min((os.cpu_count() or 1) + 1, 8))')

.PHONY: docs/report.png help setup demo docs site release test test-browser lint bench bench-large bench-diagnosis mutants importers matrix nightly clean
.DEFAULT_GOAL := help

help:
	@echo "make setup   a virtual environment in $(VENV) with everything to run and test"
	@echo "make demo    build the FMU, run the loop on the sample campaign, build the improved FMU"
	@echo "make test    the tests, but for those of make nightly"
	@echo "make test-browser   both pages in Chromium, by Playwright, and in Firefox with PYTEST_ADDOPTS="-m nightly" (apt-get install chromium firefox-esr)"
	@echo "make docs    write the pages that are made from records: docs/campaign.md, docs/effects.md, docs/variables.md, docs/quantities.md, docs/options.md"
	@echo "make docs/report.png   the picture of the report in README.md, in Chromium"
	@echo "make site    the documentation as a site in out/site, with the Python reference; fails with any warning or lost link"
	@echo "make release     in dist/release, of the commit at hand: wheel, sdist, FMUs for five platforms, list of components, licences, documentation, checksums; a tag v1.2.3 is its version"
	@echo "make lint    ruff, mypy, import-linter"
	@echo "make bench   speed and accuracy beside CVODES, LSODA, fmpy, SciPy and the last release, and growth; writes out/bench.json, out/growth.png"
	@echo "make bench-large   twenty hours of recordings, 500 runs, a fleet of 1000 chairs on a cluster (an hour or more); writes out/bench-large.json"
	@echo "make bench-diagnosis   the loop on hidden truths of another simulator (hours; TRIALS='--every 10' for fewer)"
	@echo "make mutants     whether the tests notice faults that are put into the code (hours; MUTANTS='--sample 12 --only wheelchair_fmu/model')"
	@echo "make importers   FMUs and systems in other people's importers, as tables (ARGS=--write-docs puts them into docs); these go into $(VENV)-importers"
	@echo "make matrix   the tests with each Python here, lowest and highest versions of what is needed; these go into $(VENV)-matrix"
	@echo "make nightly     what takes an hour or more: further cases, every platform, importers, fuzzing, kills and damage, a few hidden truths, some mutants"
	@echo "make clean   remove what the others made, but for $(VENV)"

setup: $(VENV)/.ready

# Without a C compiler on PATH, PyPI's ziglang serves as one, which [dev] has.
$(VENV)/.ready: pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(0 if sys.version_info >= (3, 11) else "Python %d.%d is too old: give 3.11 or newer, as in make setup PYTHON=python3.12" % sys.version_info[:2])'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e ".[dev,ssp]"
	@touch $@

demo: setup
	$(BIN)/python build_fmu.py
	$(BIN)/wheelchair simulate steady-turn --speed 1 --delta-force 10 -o out/demo
	$(BIN)/wheelchair check examples/sample-campaign
	$(BIN)/wheelchair compare examples/sample-campaign -o out/demo/compare
	$(BIN)/wheelchair diagnose examples/sample-campaign --json out/demo/diagnosis.json -o out/demo
	$(BIN)/wheelchair add rolling_resistance_asymmetry examples/sample-campaign -o out/demo/better.toml
	$(BIN)/python build_fmu.py --variant out/demo/better.toml -o out/demo/Better.fmu
	@echo "the report, to be opened in a browser:"
	@$(BIN)/wheelchair report examples/sample-campaign --diagnosis out/demo/diagnosis.json -o out/demo/report.html

# Laws and channels of whoever writes the pages stay out of them.
docs: export WHEELCHAIR_CONFIG := /dev/null
docs: setup
	$(BIN)/python -m wheelchair_fmu.campaign.reference docs/campaign.md
	$(BIN)/python -m wheelchair_fmu.model.catalogue_page docs/effects.md
	$(BIN)/python -m wheelchair_fmu.fmu.variables_page docs/variables.md
	$(BIN)/wheelchair quantities --page docs/quantities.md
	$(BIN)/python -m wheelchair_fmu.cli.options_page docs/options.md

# The picture in README.md, by Chromium.
docs/report.png: setup
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e ".[browser]"
	$(BIN)/python -m benchmarks.page_picture $@

site: export WHEELCHAIR_CONFIG := /dev/null
site: setup
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e ".[site]"
	.ci/site out/site

# The wheel is tried and tested in an empty environment, in another folder. RELEASE_TESTS narrows or
# widens what is tested, and RELEASE_TESTS=none leaves the tests out.
release: setup
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e ".[release]"
	.ci/release dist/release

test: setup
	$(BIN)/python -m pytest -n $(WORKERS)

test-browser: setup
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e ".[browser]"
	$(BIN)/python -m pytest tests/browser -s

lint: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check --quiet .
	$(BIN)/mypy
	$(BIN)/lint-imports

bench-diagnosis: setup
	$(BIN)/python -m benchmarks.diagnosis --baselines $(TRIALS)

mutants: setup
	$(BIN)/python -m benchmarks.mutants $(MUTANTS)

bench: setup
	$(BIN)/python -m benchmarks.bench

bench-large: setup
	$(BIN)/python -m benchmarks.bench large fleet_cost

importers: setup $(VENV)-importers/.ready
	IMPORTERS_PYTHON=$(CURDIR)/$(VENV)-importers/bin/python $(BIN)/python -m benchmarks.importers $(ARGS)

$(VENV)-importers/.ready: benchmarks/importers/requirements.txt
	$(PYTHON) -m venv $(VENV)-importers
	$(VENV)-importers/bin/python -m pip install --quiet --disable-pip-version-check -r $<
	@touch $@

# PYTHONS and TESTS narrow it, or widen it to TESTS=tests.
matrix: setup
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e ".[matrix]"
	$(BIN)/python -m benchmarks.matrix $(if $(PYTHONS),--pythons $(PYTHONS)) $(if $(TESTS),--tests $(TESTS))

# Runs what the machine has: wine64, qemu-user with libc6-arm64-cross, valgrind, clang with libclang-rt-dev, firefox-esr; the rest is skipped
# with its reason. Every part is done, and it fails if one has failed. NIGHTLY_SEED and TRIALS' --seeds choose other moments,
# places and chairs.
NIGHTLY_SEED ?= 1
NIGHTLY_MUTANTS ?= 20
nightly: TRIALS := --seeds $(NIGHTLY_SEED) --every 20 --out out/nightly-diagnosis
nightly: setup $(VENV)-importers/.ready
	@echo "seeds: NIGHTLY_SEED=$(NIGHTLY_SEED), trials $(TRIALS)"
	@failed=; \
	NIGHTLY_SEED=$(NIGHTLY_SEED) IMPORTERS_PYTHON=$(CURDIR)/$(VENV)-importers/bin/python \
		$(BIN)/python -m pytest -n $(WORKERS) -m nightly --durations=30 || failed="$$failed tests"; \
	$(BIN)/python -m benchmarks.diagnosis $(TRIALS) || failed="$$failed trials"; \
	$(BIN)/python -m benchmarks.mutants --drawn --sample $(NIGHTLY_MUTANTS) --seed $(NIGHTLY_SEED) || failed="$$failed mutants"; \
	if [ -n "$$failed" ]; then echo "failed:$$failed"; exit 1; fi

clean:
	rm -rf dist out build *.egg-info .pytest_cache .mypy_cache .ruff_cache .import_linter_cache
	find wheelchair_fmu fmu_src tests benchmarks -name __pycache__ -prune -exec rm -rf {} +
