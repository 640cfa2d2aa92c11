# What a user and a developer run. Every target sets up what it needs first; `make` alone lists them.
PY := .venv/bin/python

.PHONY: help demo test laws right bench experiments setup setup-dev lock clean

help:  ## list the targets
	@sed -n 's/^\([a-z-]*\):.*## */\1\t/p' $(MAKEFILE_LIST) | while IFS="$$(printf '\t')" read -r name doc; do printf '  make %-11s %s\n' "$$name" "$$doc"; done

demo: setup  ## the paper's questions about a dropped and a grasped egg, answered; a video in out/
	@$(PY) examples/demo.py

test: setup-dev  ## ruff, pyright, import-linter, pytest
	.venv/bin/ruff check
	.venv/bin/ruff format --check
	.venv/bin/pyright
	.venv/bin/lint-imports --no-cache
	.venv/bin/pytest -q -n 2 --dist worksteal

laws: setup-dev  ## the longer suites
	.venv/bin/pytest -q -n 2 --dist worksteal -m laws

right: setup-dev  ## compare with closed forms and published numbers, and write docs/how_right.md
	@OPENBLAS_NUM_THREADS=1 $(PY) tools/how_right.py

bench: setup-dev  ## the benchmarks, as one table; ARGS='--help' tells more
	@$(PY) benchmarks/run.py $(ARGS)

experiments: setup  ## run the experiments and write docs/experiments; ARGS='--only grasping'
	@OPENBLAS_NUM_THREADS=1 $(PY) examples/experiments/pages.py $(ARGS)

setup:  ## what `make demo` needs: Debian packages, .venv, the locked packages
	@tools/setup.sh runtime

setup-dev:  ## what the checks need
	@tools/setup.sh dev

lock:  ## write the lock files anew (needs uv)
	uv pip compile -q pyproject.toml --group build $(LOCK) -o requirements.lock
	uv pip compile -q pyproject.toml --group build --group dev -c requirements.lock $(LOCK) -o requirements-dev.lock
LOCK := --upgrade --universal --python-version 3.11 --generate-hashes \
	--no-header --no-annotate --no-emit-index-url --no-emit-find-links

clean:  ## remove the environment, caches and outputs
	rm -rf .venv out dist .pytest_cache .ruff_cache .hypothesis .import_linter_cache
