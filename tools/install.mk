# install.mk: `make install` and `make uninstall`: the command, the library with its headers and
# krs.pc, pages of the manual, and completion for bash, zsh and fish.  PREFIX says where they
# belong, LIBDIR where libraries do below it, DESTDIR where they are put for now, as for a package.

PREFIX  ?= /usr/local
LIBDIR  ?= lib
DESTDIR ?=
TARGET   = $(DESTDIR)$(PREFIX)
COMMANDS = $(shell sed -n 's/^COMMAND.[A-Z]*, "\([a-z]*\)".*/\1/p' cli/commands.def)
INSTALLED = bin/krs $(LIBDIR)/libkrs.a $(LIBDIR)/$(SONAME) $(LIBDIR)/libkrs.so $(LIBDIR)/pkgconfig/krs.pc include/krs.h include/krs_mesh.h include/krs_slice.h include/krs_grid.h include/krs_measure.h include/krs_camera.h include/krs_vulkan.h include/krs_film.h include/krs_choices.h \
            include/krs_planes.def include/krs_choices.def include/krs_surface.def \
            share/bash-completion/completions/krs share/zsh/site-functions/_krs \
            share/fish/vendor_completions.d/krs.fish share/man/man1/krs.1 \
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
	@install -d $(sort $(dir $(INSTALLED:%=$(TARGET)/%)))
	@install -m 755 $(B)/krs $(TARGET)/bin/krs
	@$(if $(VDB),install -m 644 $(VDB) $(TARGET)/lib/krs/krs-vdb.so)
	@install -m 644 $(B)/libkrs.a $(B)/$(SONAME) $(TARGET)/$(LIBDIR)
	@ln -sf $(SONAME) $(TARGET)/$(LIBDIR)/libkrs.so
	@for header in compiler/krs.h compiler/krs_mesh.h compiler/krs_slice.h compiler/krs_grid.h compiler/krs_measure.h compiler/krs_camera.h runtime/krs_vulkan.h runtime/krs_film.h runtime/krs_choices.h; do \
	    sed 's|"[a-z]*/\(krs[a-z_]*.h\)"|"\1"|; s|^#include ".*/\(.*\.def\)"|#include "krs_\1"|' $$header \
	        >$(TARGET)/include/$${header##*/} || exit 1; \
	done
	@install -m 644 runtime/planes.def $(TARGET)/include/krs_planes.def
	@install -m 644 runtime/choices.def $(TARGET)/include/krs_choices.def
	@install -m 644 compiler/shape/surface.def $(TARGET)/include/krs_surface.def
	@echo "$$KRS_PC" >$(TARGET)/$(LIBDIR)/pkgconfig/krs.pc
	@$(B)/krs --completion bash >$(TARGET)/share/bash-completion/completions/krs
	@$(B)/krs --completion zsh >$(TARGET)/share/zsh/site-functions/_krs
	@$(B)/krs --completion fish >$(TARGET)/share/fish/vendor_completions.d/krs.fish
	@$(B)/krs --manual >$(TARGET)/share/man/man1/krs.1
	@for command in $(COMMANDS); do \
	    $(B)/krs --manual $$command >$(TARGET)/share/man/man1/krs-$$command.1 || exit 1; \
	done
	@echo "installed in $(TARGET)"
uninstall:
	@rm -f $(INSTALLED:%=$(TARGET)/%)
	@echo "removed from $(TARGET)"
.PHONY: install uninstall
