# install.mk: `make install` and `make uninstall`: the command, the library with its headers and
# krs.pc, pages of the manual, completion for bash, zsh and fish, and what desktops know of
# scenes (tools/desktop).  PREFIX says where they belong, LIBDIR where libraries do below it, DESTDIR where they are put for now, as for a package.

PREFIX  ?= /usr/local
LIBDIR  ?= lib
DESTDIR ?=
INTO     = $(DESTDIR)$(PREFIX)
COMMANDS = $(shell sed -n 's/^COMMAND.[A-Z]*, "\([a-z]*\)".*/\1/p' cli/options/commands.def)
# Programs include <krs/krs.h>, and older ones <krs.h>: names of 0.2, which only lead to these.
PUBLIC   = $(sort $(wildcard include/krs/*))
OLD_NAMES = krs.h krs_vulkan.h krs_camera.h
INSTALLED = bin/krs $(LIBDIR)/libkrs.a $(LIBDIR)/$(SHARED) $(LIBDIR)/$(SONAME) $(LIBDIR)/libkrs.so $(LIBDIR)/pkgconfig/krs.pc $(PUBLIC) $(OLD_NAMES:%=include/%) \
            share/bash-completion/completions/krs share/zsh/site-functions/_krs \
            share/fish/vendor_completions.d/krs.fish share/man/man1/krs.1 \
            share/applications/krs.desktop share/icons/hicolor/scalable/apps/krs.svg share/mime/packages/krs.xml \
            share/thumbnailers/krs.thumbnailer share/metainfo/krs.metainfo.xml \
            $(COMMANDS:%=share/man/man1/krs-%.1) $(if $(VDB),lib/krs/krs-vdb.so)

define KRS_PC
prefix=$(PREFIX)
includedir=$${prefix}/include
libdir=$${prefix}/$(LIBDIR)

Name: krs
Description: compiles and renders scenes of implicit surfaces
Version: $(VERSION)
Cflags: -I$${includedir}
Libs: -L$${libdir} -lkrs
Libs.private: $(LIBS)
endef
export KRS_PC

install: $(B)/krs $(B)/libkrs.a $(B)/libkrs.so $(VDB)
	@install -d $(sort $(dir $(INSTALLED:%=$(INTO)/%)))
	@install -m 755 $(B)/krs $(INTO)/bin/krs
	@$(if $(VDB),install -m 644 $(VDB) $(INTO)/lib/krs/krs-vdb.so)
	@install -m 644 $(B)/libkrs.a $(B)/$(SHARED) $(INTO)/$(LIBDIR)
	@ln -sf $(SHARED) $(INTO)/$(LIBDIR)/$(SONAME)
	@ln -sf $(SONAME) $(INTO)/$(LIBDIR)/libkrs.so
	@install -m 644 $(PUBLIC) $(INTO)/include/krs
	@for name in $(OLD_NAMES); do \
	    echo "#include \"krs/$${name#krs_}\"" >$(INTO)/include/$$name || exit 1; \
	done
	@echo "$$KRS_PC" >$(INTO)/$(LIBDIR)/pkgconfig/krs.pc
	@$(B)/krs --completion bash >$(INTO)/share/bash-completion/completions/krs
	@$(B)/krs --completion zsh >$(INTO)/share/zsh/site-functions/_krs
	@$(B)/krs --completion fish >$(INTO)/share/fish/vendor_completions.d/krs.fish
	@$(B)/krs --manual >$(INTO)/share/man/man1/krs.1
	@for command in $(COMMANDS); do \
	    $(B)/krs --manual $$command >$(INTO)/share/man/man1/krs-$$command.1 || exit 1; \
	done
	@cd tools/desktop && install -m 644 krs.desktop $(INTO)/share/applications
	@cd tools/desktop && install -m 644 krs.svg $(INTO)/share/icons/hicolor/scalable/apps
	@cd tools/desktop && install -m 644 krs.mime.xml $(INTO)/share/mime/packages/krs.xml
	@cd tools/desktop && install -m 644 krs.thumbnailer $(INTO)/share/thumbnailers
	@cd tools/desktop && install -m 644 krs.metainfo.xml $(INTO)/share/metainfo
	@echo "installed in $(INTO)"
uninstall:
	@rm -f $(INSTALLED:%=$(INTO)/%)
	@rmdir $(INTO)/include/krs 2>/dev/null || :
	@echo "removed from $(INTO)"
.PHONY: install uninstall
