# playground.mk: `make playground`, a static folder in build/playground (docs/playground.md), and `make serve`, which shows it.
#
# Packages of npm are those of package-lock.json; Debian's esbuild makes one file of them and of what is here.

Y        := $(B)/playground
NPM      := $(B)/npm
PLAY     := web/playground
PAGES    := $(addprefix $(PLAY)/,index.html style.css logo.svg manifest.webmanifest)
PORT     ?= 8000

playground: $(Y)/service.js
$(NPM)/.package-lock: $(PLAY)/package.json $(PLAY)/package-lock.json
	@echo "npm    $(NPM)"
	@mkdir -p $(NPM) && cp $^ $(NPM)
	@cd $(NPM) && npm ci --ignore-scripts --no-audit --no-fund --silent
	@touch $@
$(NPM)/words.json: $(PLAY)/words.mjs compiler/front/token.def
	@mkdir -p $(NPM)
	@node $^ >$@
$(Y)/app.js: $(wildcard $(PLAY)/*.mjs) $(NPM)/words.json $(NPM)/.package-lock
	@echo "bundle $@"
	@mkdir -p $(Y)
	@NODE_PATH=$(NPM)/node_modules esbuild $(PLAY)/app.mjs --bundle --minify --format=esm --target=es2022 --charset=utf8 \
	    --external:./krs/index.mjs --alias:krs-words=$(abspath $(NPM)/words.json) --log-level=warning --outfile=$@
$(Y)/examples.json: $(addprefix $(PLAY)/,build.mjs pictured.mjs smaller.mjs) tools/pictures.txt $(EXAMPLES) $(wildcard examples/parts/* docs/pictures/*.png) $(NPM)/.package-lock
	@echo "thumbs $(Y)/examples"
	@mkdir -p $(Y)
	@cd $(NPM) && node $(abspath $<) examples $(CURDIR) $(abspath $(Y))
# It knows all others.
$(Y)/service.js: $(PLAY)/service.mjs $(PAGES) $(Y)/app.js $(Y)/examples.json web
	@cp $(PAGES) $(Y)
	@rm -rf $(Y)/krs && cp -r $(P) $(Y)/krs && rm -f $(Y)/krs/*.md $(Y)/krs/*.ts
	@cd $(NPM) && node $(abspath $(PLAY)/build.mjs) licenses $(abspath $(Y))
	@cd $(NPM) && node $(abspath $(PLAY)/build.mjs) service $(abspath $(Y)) $(abspath $<)
serve: playground
	@node $(PLAY)/serve.mjs $(Y) $(PORT)
.PHONY: playground serve
