# package.mk: `make web`, the package `krs` for pages (web/package/README.md), in build/web/, from `make wasm` and what
# pages have of their own.  Nothing is bundled: to host it is to copy the folder.

P          := $(B)/web
FONTS_AT   ?= /usr/share/fonts/truetype/dejavu
PAGE_FILES := $(notdir $(wildcard web/package/*.mjs)) krs.d.ts package.json README.md
PAGE_FONTS := DejaVuSans.ttf DejaVuSans-Bold.ttf DejaVuSerif.ttf DejaVuSerif-Bold.ttf

web: $(PAGE_FILES:%=$(P)/%) $(addprefix $(P)/,krs.wasm krs.mjs letters.wasm letters.mjs core.mjs shaders.mjs albedos.bin LICENSE) $(PAGE_FONTS:%=$(P)/fonts/%)
$(PAGE_FILES:%=$(P)/%): $(P)/%: web/package/%
	@mkdir -p $(@D) && cp $< $@
$(addprefix $(P)/,krs.wasm krs.mjs letters.wasm letters.mjs core.mjs): $(P)/%: $(W)/%
	@mkdir -p $(@D) && cp $< $@
$(W)/%.mjs: $(W)/%.wasm ;
$(P)/shaders.mjs: web/picture/flatten.mjs $(wildcard web/picture/*.frag web/picture/*.glsl) $(SHADERS) $(HELPERS) $(wildcard include/krs/*.def)
	@mkdir -p $(@D) && node $< >$@
$(P)/albedos.bin: web/picture/albedos.mjs $(B)/albedo_tables.c
	@mkdir -p $(@D) && node $^ >$@
$(P)/LICENSE: LICENSE
	@mkdir -p $(@D) && cp $< $@
$(PAGE_FONTS:%=$(P)/fonts/%): $(P)/fonts/%: $(FONTS_AT)/%
	@mkdir -p $(@D) && cp $< $@
# The archive that `npm install` takes.
web-pack: web
	@cd $(P) && npm pack --silent --pack-destination ..
.PHONY: web web-pack
