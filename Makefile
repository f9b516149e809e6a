# Two commands matter: `make verify` and `make test`. Both build .venv when it is missing; after that no network is used.
# Only relative paths are used, so the checkout may lie in a folder whose name contains spaces.
SHELL := /bin/bash
.DELETE_ON_ERROR:
# Compiled modules are kept, whatever the environment says: each of the many processes starts in half the time
unexport PYTHONDONTWRITEBYTECODE
.PHONY: verify smoke exhaustive test test-deep bench kit wheels docs doctor lint lock clean venv compiler

PYTHON ?= $(shell for p in python3.11 python3 python; do $$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1 && echo $$p && break; done)
PY := .venv/bin/python
STAMP := .venv/requirements.lock
AWLSIM := .venv/awlsim.lock
GRAMMAR := .venv/grammar.lock
SITE := build/site-env/requirements.lock

# What has not changed since it was judged is kept; `$(PY) -m modeproof verify --anew` judges all
verify: $(STAMP) $(GRAMMAR)
	@$(PY) -m modeproof verify

smoke: $(STAMP) $(GRAMMAR)
	@$(PY) -m modeproof verify --lane smoke

# Hours: every run of TLC, every mutant by rule, every edit of our wiring. What fits already is kept, so it can be stopped and started again.
exhaustive: $(STAMP) $(GRAMMAR)
	@$(PY) -m modeproof verify --lane exhaustive
	@$(PY) -m modeproof mutate spec
	@$(PY) -m modeproof mutate impl
	@$(PY) -m modeproof mutate impl --judge vectors
	@$(PY) -m modeproof machine --trial

# Two processes; tests that share what is made once are in one of them (tests/groups.py). The first tier sees every kind of
# check fail once; the second (marked deep) has every planted fault, samples of the campaigns and the compiled programs.
test: $(STAMP) $(AWLSIM) $(GRAMMAR)
	@$(PY) -m pytest -n 2 --dist loadscope -m "not deep"

test-deep: $(STAMP) $(AWLSIM) $(GRAMMAR)
	@$(PY) -m pytest -n 2 --dist loadscope -m deep

bench: $(STAMP) $(AWLSIM)
	@$(PY) -m tests.bench

# One file for a PLC developer: build/modeproof-kit.pyz
kit: $(STAMP)
	@$(PY) -m modeproof vectors pack

# The docs as a site with search: build/site/index.html. What makes it is installed for this alone.
docs: $(SITE)
	@$(dir $(SITE))bin/python docs/site/build.py

# All that `pip install --no-index --find-links build/wheels modeproof` needs, on this system; EXTRAS="tlc report" adds theirs
wheels: $(STAMP) $(GRAMMAR)
	@$(PY) -m modeproof.lane.wheelhouse build/wheels $(EXTRAS)

doctor:
	@if [ -x $(PY) ]; then $(PY) -m modeproof doctor; else $(if $(PYTHON),$(PYTHON),false) -m modeproof doctor; fi

lint: $(STAMP)
	@$(PY) -m ruff format --check . && $(PY) -m ruff check . && $(PY) -m mypy

venv: $(STAMP) $(AWLSIM) $(GRAMMAR)

# Said before anything is fetched; who has the grammar needs no compiler
compiler:
	@if [ -n "$(PYTHON)" ] && ! cmp -s programs/requirements.lock $(GRAMMAR) && ! $(PYTHON) -c 'import os, shutil, sysconfig as s, sys; \
	  sys.exit(not shutil.which((os.environ.get("CC") or s.get_config_var("CC") or "cc").split()[0]))'; then \
	  echo "modeproof: a C compiler is missing: it builds the grammar of Structured Text; install gcc, or a wheel of modeproof (docs/install.md)" >&2; \
	  exit 2; fi

# The stamp is a copy of the lock, written last: a build that was cut short is built again, and a lock whose date
# changed but whose text did not is no reason to build.
$(STAMP): requirements.lock pyproject.toml setup.py | compiler
	@if [ -z "$(PYTHON)" ]; then echo "modeproof: Python 3.11 or newer is missing; install it, or name it: make PYTHON=/path/to/python3" >&2; exit 2; fi
	@if cmp -s requirements.lock $(STAMP) && $(PY) -c 'import modeproof' 2>/dev/null; then touch $(STAMP); else \
	  echo "modeproof: building .venv from requirements.lock (once; needs PyPI)"; \
	  $(PYTHON) -m venv --clear .venv && \
	  $(PY) -m pip --disable-pip-version-check install --quiet --require-hashes --only-binary :all: -r requirements.lock && \
	  $(PY) -m pip --disable-pip-version-check install --quiet --no-index --no-deps --no-build-isolation -e . && \
	  $(PY) -m modeproof.tlc.start_up && \
	  cp requirements.lock $(STAMP); \
	fi

# For tests and the example only (GPL): the simulator of S7 statement list, which PyPI has as source. It is built with the
# setuptools that is pinned above, without network but for the one file.
$(AWLSIM): examples/awl/requirements.lock $(STAMP)
	@if cmp -s $< $@ && $(PY) -c 'import awlsim' 2>/dev/null; then touch $@; else \
	  AWLSIM_CYTHON_BUILD=0 $(PY) -m pip --disable-pip-version-check install --quiet --require-hashes --no-deps \
	    --no-build-isolation --no-binary awlsim -r $< && \
	  cp $< $@; \
	fi

# The grammar of Structured Text, which PyPI has as source: a wheel of it is built (its C part with gcc), and installed.
$(GRAMMAR): programs/requirements.lock $(STAMP)
	@if cmp -s $< $@ && $(PY) -c 'import tree_sitter_iec61131_3_st' 2>/dev/null; then touch $@; else \
	  rm -rf .venv/wheels && \
	  $(PY) -m pip --disable-pip-version-check wheel --quiet --require-hashes --no-deps --no-build-isolation \
	    --no-binary tree-sitter-iec61131-3-st -w .venv/wheels -r $< && \
	  $(PY) -m pip --disable-pip-version-check install --quiet --no-index --no-deps --force-reinstall .venv/wheels/*.whl && \
	  cp $< $@; \
	fi

$(SITE): docs/requirements.lock
	@if [ -z "$(PYTHON)" ]; then echo "modeproof: Python 3.11 or newer is missing; install it, or name it: make PYTHON=/path/to/python3" >&2; exit 2; fi
	@$(PYTHON) -m venv --clear $(@D) && \
	  $(@D)/bin/python -m pip --disable-pip-version-check install --quiet --require-hashes --only-binary :all: -r $< && \
	  cp $< $@

lock:
	@rm -rf build/lock && $(PYTHON) -m venv build/lock && build/lock/bin/python -m pip --quiet install uv==0.13.8
	@sed '/^[^#]/,$$d' requirements.lock > build/lock/new
	@build/lock/bin/python -m uv pip compile --quiet --upgrade --universal --python-version 3.11 --generate-hashes --no-header requirements.in >> build/lock/new
	@mv build/lock/new requirements.lock && rm -rf build/lock

clean:
	rm -rf build .venv .pytest_cache .mypy_cache .ruff_cache .hypothesis *.egg-info
