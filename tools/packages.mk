# packages.mk: `make dist`, the sources as one reproducible file; `make deb`, Debian's packages of them; `make
# test-packages`, which installs these in bare systems, tries them there and removes them.

DIST := krs-$(VERSION)
# The time of the commit stands for that of the files, and gzip notes none, so equal commits give equal bytes.
dist:
	@mkdir -p $(B)/dist
	@git archive --format=tar --prefix=$(DIST)/ HEAD | gzip -9n >$(B)/dist/$(DIST).tar.gz
	@echo "wrote $(B)/dist/$(DIST).tar.gz"
deb: dist
	@cd $(B)/dist && rm -rf $(DIST) && cp $(DIST).tar.gz krs_$(VERSION).orig.tar.gz && tar -xf $(DIST).tar.gz
	@cd $(B)/dist/$(DIST) && dpkg-buildpackage -us -uc >../build.log 2>&1 || { tail -n 30 ../build.log; exit 1; }
	@cd $(B)/dist && ls ./*.deb
test-packages: deb
	@tools/try-packages.sh $(B)/dist
.PHONY: dist deb test-packages
