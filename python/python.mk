# python.mk: `make python`, the package for Python in build/python, and `make wheel`, a file for pip in build/python/dist
# (python/README.md).

PY           := $(B)/python
# One that has NumPy and cffi.
find_python   = $(shell for p in python3 /usr/bin/python3; do $$p -c 'import cffi, numpy' 2>/dev/null && echo $$p && break; done)
PYTHON       ?= $(or $(find_python),$(error `make python` needs NumPy and cffi: python3-numpy and python3-cffi of Debian))
PY_SOURCES   := $(wildcard python/krs/*.py) python/krs/view.html python/krs/py.typed
PY_PACKAGE   := $(PY_SOURCES:python/%=$(PY)/%) $(PY)/krs/_declarations.py $(PY)/krs/libkrs.so

# What `krs.view` shows scenes by is taken along as it is, where `make web` has made it, or makes it now.
python: $(PY)/krs/words.pyi $(filter web,$(MAKECMDGOALS))
	@[ ! -e $(B)/web/index.mjs ] || { mkdir -p $(PY)/krs/web && cp -ru $(B)/web/. $(PY)/krs/web; }
$(PY)/krs/%: python/krs/%
	@mkdir -p $(@D)
	@cp $< $@
$(PY)/krs/_declarations.py: python/tools/declare.py $(wildcard include/krs/*)
	@mkdir -p $(@D)
	@echo "declare $@"
	@CC='$(CC)' $(PYTHON) python/tools/declare.py include $(@D)
# Without names for a debugger.
$(PY)/krs/libkrs.so: $(B)/libkrs.so
	@mkdir -p $(@D)
	@$(OBJCOPY) --strip-debug $< $@
$(PY)/krs/words.pyi: python/tools/stubs.py $(PY_PACKAGE)
	@echo "stubs   $@"
	@PYTHONPATH=$(PY) $(PYTHON) python/tools/stubs.py $@
wheel: python
	@rm -rf $(PY)/build $(PY)/dist $(PY)/krs.egg-info
	@cp python/pyproject.toml python/setup.py LICENSE $(PY)
	@cp docs/python.md $(PY)/README.md
	@cd $(PY) && $(PYTHON) -m build --wheel --no-isolation . >build.log 2>&1 || { cat build.log; exit 1; }
	@echo "wheel   $$(ls $(PY)/dist/*.whl)"
.PHONY: python wheel
