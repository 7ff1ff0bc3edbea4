# vscode.mk: `make vscode`, the extension for VS Code in build/vscode (docs/editors.md).

VSCODE := $(B)/vscode
vscode: $(VSCODE)/.packages
$(VSCODE)/.packages: $(wildcard editors/vscode/*.js*) editors/vscode/README.md grammar/editors/krs.tmLanguage.json LICENSE
	@echo "npm    $(VSCODE)"
	@mkdir -p $(VSCODE) && cp $^ $(VSCODE)
	@cd $(VSCODE) && npm ci --ignore-scripts --no-audit --no-fund --silent
	@touch $@
.PHONY: vscode
