# Two commands do everything on a fresh machine: make demo, make test.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
EXTRAS := diagnostics,cnn,onnx,dev
DEMO := runs/quickstart
# TARGETS only exists after an install that was complete; a change of the pins installs again.
STAMP := $(VENV)/.installed

.PHONY: demo test test-slow lint bench reports clean

$(STAMP): pyproject.toml constraints.txt
	@echo "installing into $(VENV), once: about 2 minutes, and the download; 2 GB with the CPU build of PyTorch, more with the CUDA build"
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install -c constraints.txt -e '.[$(EXTRAS)]'
	touch $(STAMP)

demo: $(STAMP)
	$(BIN)/siggen generate configs/quickstart.yaml --out $(DEMO)
	$(BIN)/siggen-diagnostics report $(DEMO) --out $(DEMO)_report

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

test: lint
	$(BIN)/python -m pytest

test-slow: $(STAMP)
	$(BIN)/python -m pytest -m slow

bench: $(STAMP)
	$(BIN)/python -m benchmarks

reports: $(STAMP)
	$(BIN)/python docs/scripts/report_pages.py

clean:
	rm -rf $(VENV) runs build dist
