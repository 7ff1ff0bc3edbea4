# fingerprints.mk: hashes of the sources that decide what is kept for a later run, and the commit.
#
# What one program has kept is good for another of the same sources alone.  A fingerprint is the hash of
# such sources by name and content, whatever they are compiled with, and whether or not there is git.

sources_of = $(sort $(foreach end,c h cpp def krs glsl comp,$(wildcard $(addsuffix /*.$(end),$(1)))))
folders_of = $(shell find $(1) -type d)

# Compiled shaders are found by their text: what makes SPIR-V of a text, and the layout of entries.
KEEPS_cache      := $(call sources_of,compiler/target) runtime/device/shader.c runtime/device/cache.h \
                    runtime/device/cache.c cli/specialize.c
# The sums of a film's samples: the library, less what only meshes, judges or says something, or writes files.
KEEPS_film       := $(filter-out compiler/front/format% compiler/front/synonyms% \
                    compiler/base/diag% include/krs/mesh.h include/krs/slice.h include/krs/grid.h include/krs/measure.h, $(call sources_of,include/krs $(filter-out compiler/refute compiler/field \
                    compiler/base/embed runtime/writer runtime/display, $(call folders_of,compiler platform/linux runtime)))) tools/albedo_tables.c
# A picture that has begun: also the layout of the file, and what the command makes of its options.
KEEPS_checkpoint := $(KEEPS_film) $(wildcard $(addprefix cli/, render.c parse_options.c options/options.* options/choices.[ch] options/values.[ch] \
                    $(addprefix picture/, checkpoint.[ch] render.h picture.[ch] light_groups.[ch] frame_paths.[ch] read_exr.[ch])))
KEEPS            := cache film checkpoint

fingerprint = LC_ALL=C sha256sum $(sort $(1)) | sha256sum | cut -c 1-16
$(B)/fingerprints.c: $(sort $(foreach kind,$(KEEPS),$(KEEPS_$(kind)))) tools/fingerprints.mk
	@mkdir -p $(@D)
	@{ echo '#include "compiler/base/fingerprints.h"' \
	    $(foreach kind,$(KEEPS),&& echo "const char fingerprint_$(kind)[] = \"$$($(call fingerprint,$(KEEPS_$(kind))))\";"); } >$@
fingerprints:
	@:$(foreach kind,$(KEEPS),; echo "$(kind) $$($(call fingerprint,$(KEEPS_$(kind))))")

# The commit, where this folder is one of git's; written where it is another than before.
commit := $(shell [ ! -e .git ] || git describe --always --dirty --abbrev=12 --exclude '*' 2>/dev/null)
ifneq ($(file <$(B)/commit.c),const char commit[] = "$(commit)";)
.PHONY: $(B)/commit.c
endif
$(B)/commit.c:
	@mkdir -p $(@D)
	@echo 'const char commit[] = "$(commit)";' >$@
.PHONY: fingerprints
