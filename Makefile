PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

.PHONY: run test prove lint clean

# A window where there is a display (macOS always has one), otherwise the same job without it.
run: $(VENV)/.prepared
	@if [ -n "$$DISPLAY$$WAYLAND_DISPLAY" ] || [ "$$(uname)" = Darwin ]; then $(BIN)/efase; \
	else $(BIN)/efase demo --out out; fi

test: $(VENV)/.prepared $(VENV)/.tools lint
	$(BIN)/python -m pytest -q -m "not prove" -n 2 --dist loadfile

prove: $(VENV)/.prepared $(VENV)/.tools
	$(BIN)/python -m pytest -q -m prove -o faulthandler_timeout=3600

lint: $(VENV)/.tools
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

$(VENV)/.installed: pyproject.toml requirements.lock resources/setup/debian-packages.txt
	@sh resources/setup/system-packages.sh
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	@echo "Installing Python packages into $(VENV)"
	@$(BIN)/python -m pip install -q --disable-pip-version-check -r requirements.lock
	@$(BIN)/python -m pip install -q --disable-pip-version-check --no-deps -e .
	@touch $@

$(VENV)/.tools: $(VENV)/.installed requirements-dev.lock
	@$(BIN)/python -m pip install -q --disable-pip-version-check -r requirements-dev.lock
	@touch $@

# The default face and the demo database, once; both are also made on demand if they are missing later.
$(VENV)/.prepared: $(VENV)/.installed
	@echo "Fetching the default face and building the demo database"
	@$(BIN)/python -m app.prepare
	@touch $@

clean:
	rm -rf $(VENV) out
