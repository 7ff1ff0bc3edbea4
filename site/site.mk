# site.mk: `make site`, the static site in build/site (site/README.md), from the documents, the library, the headers and
# what the command says, and `make serve-site`, which shows it.  Pictures are kept in build/site-pictures.

S         := $(B)/site
SITE      := $(wildcard site/*.mjs)

site: $(B)/krs $(B)/site-words $(NPM)/site.mjs playground
	@node $(NPM)/site.mjs $(CURDIR) $(B) $(S) $(SITE_OPTIONS)
# Packages are found beside it.
$(NPM)/site.mjs: $(SITE) $(addprefix $(PLAY)/,language.mjs pictured.mjs share.mjs smaller.mjs) $(NPM)/words.json $(NPM)/.package-lock
	@echo "bundle $@"
	@esbuild site/build.mjs --bundle --platform=node --format=esm --packages=external --alias:krs-words=$(abspath $(NPM)/words.json) \
	    --log-level=warning --outfile=$@
$(B)/site-words: site/words.c $(B)/libkrs.a
	@$(CC) $(STYLE) $(CPPFLAGS) $(CFLAGS) $(LDFLAGS) -o $@ $< $(B)/libkrs.a $(LIBS)
serve-site: site
	@node $(PLAY)/serve.mjs $(S) $(PORT)
.PHONY: site serve-site
