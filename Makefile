# Two commands do everything on a fresh machine: make demo, make test.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
EXTRAS := diagnostics,cnn,recordings,mdf,dev
DEMO := runs/quickstart
# TARGETS only exists after an install that was complete; a change of the pins installs again.
STAMP := $(VENV)/.installed

.PHONY: demo test test-slow test-lowest lint bench pages reference docs wheel draft container locks holes clean

$(STAMP): pyproject.toml constraints.txt
	@echo "installing into $(VENV), once: about 2 minutes, and the download; 2 GB with the CPU build of PyTorch, more with the CUDA build"
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install -c constraints.txt -e '.[$(EXTRAS)]'
	touch $(STAMP)

# What builds the site is not needed for anything else.
$(VENV)/.documented: $(STAMP)
	$(BIN)/python -m pip install -q -c constraints.txt -e '.[docs]'
	touch $@

demo: $(STAMP)
	$(BIN)/siggen generate configs/quickstart.yaml --out $(DEMO)
	$(BIN)/siggen-diagnostics report $(DEMO) --out $(DEMO)_report

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

# Files go whole to one of two processes, since their fixtures are sets that all their tests read, long files first
# (tests/conftest.py). Bytecode is written whatever the environment says: tests start hundreds of processes, each of
# which would compile the sources anew.
test: lint
	OMP_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -n 2 --dist loadfile --no-loadscope-reorder

test-slow: $(STAMP) $(VENV)/.documented
	$(BIN)/python -m pytest -m slow

# The lowest versions that pyproject.toml allows, in an environment of their own. Old libraries warn: no errors here.
test-lowest:
	$(PYTHON) -m venv $(VENV)-lowest
	$(VENV)-lowest/bin/python -m pip install -q -r locks/lowest.txt pytest pytest-timeout hypothesis jsonschema
	$(VENV)-lowest/bin/python -m pip install -q --no-deps -e .
	$(VENV)-lowest/bin/python -m pytest -W default tests/cli/test_app.py tests/dataset/test_shard.py

bench: $(STAMP)
	$(BIN)/python -m benchmarks --json runs/benchmarks.json

# SETS=DIR takes sets from there instead of generating them.
pages: $(STAMP)
	$(BIN)/python docs/scripts/report_pages.py $(if $(SETS),--sets $(SETS))

# The pages that are printed by a script; tests compare them with what it prints.
reference: $(STAMP)
	for page in yaml:yaml command:commands column:columns python:python; do \
		$(BIN)/python docs/scripts/$${page%%:*}_reference.py > docs/reference/$${page##*:}.md || exit 1; \
	done
	$(BIN)/python docs/scripts/gallery.py > docs/start/gallery.md

docs: $(VENV)/.documented
	rm -rf site
	$(BIN)/python docs/scripts/documentation_site.py site

# All files of a release, in dist/; the wheel is tried where nothing else is, with the hashes of locks/siggen.txt.
wheel: demo
	rm -rf dist
	$(BIN)/python docs/scripts/release_files.py dist $(DEMO) $(DEMO)_report/report.html

# Gives them to the draft of a release (TAG=v0.3.0), which a person publishes. Refused if the wheel has another version.
draft:
	ls dist/siggen_gears-$(TAG:v%=%)-py3-none-any.whl
	gh release create $(TAG) --draft --verify-tag --title $(TAG) --notes "CHANGELOG.md says what changed." dist/*

container:
	docker build --file Containerfile --tag siggen .

# Pins with the hashes of every file that the package index has of them; again after a change of constraints.txt.
LOCK := compile pyproject.toml --constraint constraints.txt --generate-hashes --universal --python-version 3.11.5 --no-header --no-annotate --no-emit-index-url
LOWEST := compile pyproject.toml --extra diagnostics --resolution lowest-direct --universal --python-version 3.11.5 --no-header --no-annotate --no-emit-index-url
locks: $(STAMP)
	$(PYTHON) -m venv $(VENV)/locks
	$(VENV)/locks/bin/python -m pip install -q -c constraints.txt uv
	$(VENV)/locks/bin/uv pip $(LOCK) --output-file locks/siggen.txt
	$(VENV)/locks/bin/uv pip $(LOCK) --all-extras --group pyproject.toml:release --output-file locks/all.txt
	$(VENV)/locks/bin/uv pip $(LOWEST) --output-file locks/lowest.txt

# Known holes of all locked and of the lowest versions, asked of the public package index: needs the network.
holes:
	$(PYTHON) -m venv $(VENV)-holes
	$(VENV)-holes/bin/python -m pip install -q -c constraints.txt pip-audit
	$(VENV)-holes/bin/pip-audit --strict --no-deps --disable-pip --requirement locks/all.txt
	$(VENV)-holes/bin/pip-audit --strict --no-deps --disable-pip --requirement locks/lowest.txt

clean:
	rm -rf $(VENV) $(VENV)-lowest $(VENV)-holes runs build dist site
