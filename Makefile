# What a person, a hook and CI call; `make` prints the list.

SHELL := /bin/bash
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
RUST := $(shell find crates -name '*.rs' -o -name Cargo.toml) Cargo.toml Cargo.lock
DEMO ?= demo

.DEFAULT_GOAL := help
.PHONY: help setup build demo test test-all check instructions bench lint format

help: ## This list
	@awk -F':.*## ' '/^[a-z-]+:.*## /{printf "  make %-12s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

setup: $(VENV)/.built ## .venv with the program and all tools (done once, then only what changed)

build: setup ## The same, under the name that one tries first

demo: setup ## Make a part, simulate a scan of it, segment it; results in ./demo
	$(BIN)/python examples/01_first_scan.py $(DEMO)

test: setup ## Rust and Python tests (a few minutes)
	cargo test -p quadrics --locked
	$(BIN)/pytest

test-all: setup ## The slow ones too
	cargo test -p quadrics --locked
	$(BIN)/pytest -m ''

lint: setup ## Formatters in check mode, clippy, ruff, mypy, stubs against the module
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --locked -- -D warnings
	$(BIN)/ruff format --check python tests examples benchmarks
	$(BIN)/ruff check python tests examples benchmarks
	$(BIN)/mypy
	$(BIN)/python -m mypy.stubtest quadrics._core

check: lint test ## What a commit must pass

instructions: setup ## Fails where a stage takes more instructions than on record (needs valgrind)
	$(BIN)/python benchmarks/instructions.py

bench: setup ## Algorithms one by one, then whole programs, ours and rivals that are built (minutes)
	cargo bench -p quadrics-benches --locked
	$(BIN)/python benchmarks/whole.py --faces 10000 100000 1000000

format: setup ## Put the sources in shape
	cargo fmt --all
	$(BIN)/ruff format python tests examples benchmarks
	$(BIN)/ruff check --fix python tests examples benchmarks

$(BIN)/python:
	@$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); tools/debian-venv $(PYTHON) $(VENV); }

# The tools follow pyproject.toml only: a change of the sources must not ask the network.
$(VENV)/.tools: pyproject.toml tools/requirements.py | $(BIN)/python
	@$(BIN)/python tools/requirements.py > $(VENV)/requirements.txt
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r $(VENV)/requirements.txt
	@touch $@

$(VENV)/.built: $(VENV)/.tools $(RUST)
	@command -v cargo >/dev/null || { echo "make: cargo not found; Rust 1.89 or newer is needed" >&2; exit 1; }
	VIRTUAL_ENV="$(CURDIR)/$(VENV)" $(BIN)/maturin develop --release --locked --quiet
	@touch $@
