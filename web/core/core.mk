# core.mk: `make wasm`, the core of web pages (web/core/README.md): the compiler, what answers questions, and the mesher as
# WebAssembly, by Debian's emscripten, with libraries of Debian's source packages.
#
# emcc says which options objects need, and links.  clang compiles them by itself: emcc's start takes longer than most files.

W         := $(B)/wasm
EMCC      ?= emcc
emcc_root  = $(shell em-config LLVM_ROOT)
emcc_flags = $(shell $(EMCC) --cflags)
EMCC_ROOT  = $(call once,EMCC_ROOT,emcc_root)
EMCC_FLAGS = $(call once,EMCC_FLAGS,emcc_flags)
WASM_CC    = $(shell command -v ccache) $(EMCC_ROOT)/clang $(EMCC_FLAGS)
# A page waits for bytes first: only what takes most of the time is compiled for speed.  Linking by -Oz would make
# compilations a third slower.
WASM_FLAGS = $(if $(filter $(wildcard compiler/graph/*.c) compiler/base/elementary.c compiler/shape/box.c compiler/shape/cover.c mesh/contour/%,$<),-O2,-Os) \
             -ffunction-sections -fdata-sections -ffp-contract=off

# ---- sources ----

# Left out: what makes SPIR-V, what reads OpenEXR, and what reads fonts.
WASM_SOURCES := $(filter-out $(TARGET) compiler/outline/letters.c %/exr.c %/exr_chunks.c %_avx2.c %_avx512.c %/sets_x86.c,$(COMPILER)) \
                compiler/graph/lanes/sets_plain.c $(call sources,platform/web) \
                $(foreach room,mesh/common mesh/contour mesh/proof mesh/flat mesh/simplify mesh,$(call sources,$(room))) \
                $(call sources,web/core)
WASM_OBJECTS := $(WASM_SOURCES:%.c=$(W)/%.o) $(W)/library_files.o $(W)/helper_files.o $(W)/essl_files.o
# A module of its own, which few pages need.
LETTER_SOURCES := compiler/outline/letters.c compiler/base/arena.c compiler/base/text.c platform/web/pages.c $(call sources,web/letters)

# ---- libraries ----

WASM_PACKAGES := qhull expat freetype harfbuzz libpng1.6 zlib meshoptimizer
SOURCES_OF    := $(W)/sources
QHULL    := $(addprefix qhull/src/libqhull_r/,geom2_r geom_r global_r io_r libqhull_r mem_r merge_r poly2_r poly_r qset_r \
            random_r stat_r user_r usermem_r)
EXPAT    := $(addprefix expat/expat/lib/,xmlparse xmlrole xmltok)
FREETYPE := $(addprefix freetype/src/,base/ftbase base/ftinit base/ftsystem base/ftdebug base/ftglyph base/ftbbox base/ftbitmap \
            gzip/ftgzip sfnt/sfnt truetype/truetype cff/cff psaux/psaux psnames/psnames)
ZLIB     := $(addprefix zlib/,adler32 crc32 inffast inflate inftrees zutil)
PNG      := $(addprefix libpng1.6/,png pngerror pngget pngmem pngread pngrio pngrtran pngrutil pngset pngtrans)
WASM_LIBRARIES := $(QHULL) $(EXPAT) $(ZLIB) $(PNG) meshoptimizer/src/simplifier
LETTER_LIBRARIES := $(FREETYPE) $(filter %/inffast %/inflate %/inftrees %/zutil %/adler32 %/crc32,$(ZLIB)) harfbuzz/src/harfbuzz
WASM_HEADERS   := $(addprefix -isystem $(SOURCES_OF)/,qhull/src expat/expat/lib freetype/include harfbuzz/src libpng1.6 zlib \
                  meshoptimizer/src) -Iweb/core/libraries
LIBRARY_FLAGS   = $(WASM_CC) -w -Oz -ffunction-sections -fdata-sections $(WASM_HEADERS)
$(QHULL:%=$(SOURCES_OF)/%.o): LIBRARY_FLAGS += -Dqh_NOtrace -Dqh_KEEPstatistics=0 -include web/core/libraries/quiet.h
%/user_r.o: LIBRARY_FLAGS += -DQHULL_USER
$(FREETYPE:%=$(SOURCES_OF)/%.o): LIBRARY_FLAGS += -DFT2_BUILD_LIBRARY "-DFT_CONFIG_OPTIONS_H=<freetype_options.h>" \
                                                  "-DFT_CONFIG_MODULES_H=<freetype_modules.h>"
# Shaping alone, but for tables of Apple's fonts.
%/harfbuzz.o: LIBRARY_FLAGS += -DHB_LEAN -DHB_NO_MT -DHB_NO_AAT -DHB_NO_BORING_EXPANSION -DHAVE_CONFIG_OVERRIDE_H
%/harfbuzz.o %/simplifier.o: LIBRARY_FLAGS += -x c++ -std=c++17 -fno-exceptions -fno-rtti -fno-threadsafe-statics \
                              -isystem $(patsubst --sysroot=%,%,$(filter --sysroot=%,$(EMCC_FLAGS)))/include/c++/v1

$(W)/libraries: web/core/sources.sh
	@echo "sources $(SOURCES_OF)"
	@web/core/sources.sh $(SOURCES_OF) $(WASM_PACKAGES)
	@touch $@
# Of libpng, what reads pixels; no comments, times and profiles.
PNG_PARTS := 16BIT ALIGNED_MEMORY BENIGN_ERRORS BENIGN_READ_ERRORS EASY_ACCESS ERROR_TEXT FIXED_POINT FLOATING_ARITHMETIC FLOATING_POINT \
             INFO_IMAGE POINTER_INDEXING READ READ_16BIT READ_ANCILLARY_CHUNKS READ_EXPAND READ_INTERLACING READ_INT_FUNCTIONS READ_OPT_PLTE \
             READ_SWAP READ_TRANSFORMS READ_tRNS SEQUENTIAL_READ SETJMP SET_USER_LIMITS USER_LIMITS USER_MEM WARNINGS tRNS
$(SOURCES_OF)/libpng1.6/pnglibconf.h: $(W)/libraries web/core/core.mk
	@awk -v parts="$(PNG_PARTS)" 'BEGIN { split(parts, names); for (i in names) kept["PNG_" names[i] "_SUPPORTED"] = 1 } \
	    !/_SUPPORTED/ || kept[$$2]' $(@D)/scripts/pnglibconf.h.prebuilt >$@
$(PNG:%=$(SOURCES_OF)/%.o): $(SOURCES_OF)/libpng1.6/pnglibconf.h
$(sort $(WASM_LIBRARIES:%=$(SOURCES_OF)/%.o) $(LETTER_LIBRARIES:%=$(SOURCES_OF)/%.o)): $(W)/libraries web/core/core.mk $(wildcard web/core/libraries/*.h)
	@echo "compile $(@:$(W)/%.o=%)"
	@$(LIBRARY_FLAGS) -c -o $@ $(firstword $(wildcard $(@:.o=.c) $(@:.o=.cc) $(@:.o=.cpp)))

# ---- objects ----

$(W)/%.o: %.c web/core/core.mk | $(W)/libraries $(SOURCES_OF)/libpng1.6/pnglibconf.h
	@mkdir -p $(@D)
	@echo "compile $< for pages"
	@$(WASM_CC) -std=c17 -D_GNU_SOURCE $(WARNINGS) -I. -Iinclude -DKRS_LIBRARY $(WASM_HEADERS) -MMD -MP $(WASM_FLAGS) -c -o $@ $<
EMBEDDED = $(WASM_CC) -std=c17 -I. -O1 -c -o $@ $<
$(W)/%_files.o: $(B)/%_files.c | $(W)/libraries
	@$(EMBEDDED)
# A page waits for the library, too.
WASM_LIBRARY := $(LIBRARY:%=$(W)/%)
$(WASM_LIBRARY): $(W)/%: % web/core/without_comments.awk
	@mkdir -p $(@D) && awk -f web/core/without_comments.awk $< >$@
$(W)/library_files.c: $(B)/embed $(WASM_LIBRARY)
	@$(B)/embed library_files $(W)/compiler/library/ -- $(WASM_LIBRARY) >$@
$(W)/library_files.o: $(W)/library_files.c | $(W)/libraries
	@$(EMBEDDED)
# There are no vectors, and nothing traces rays by cells.
$(LANES:%.c=$(W)/%.o) $(W)/compiler/graph/lanes/sets_plain.o: WASM_FLAGS += -Os -fno-unroll-loops -Wno-pass-failed -DWITHOUT_CELLS
# Each call in a function that has setjmp takes much space.
JUMPING := $(shell grep -lw 'jmp_buf' $(WASM_SOURCES) $(LETTER_SOURCES))
$(JUMPING:%.c=$(W)/%.o): WASM_FLAGS += -fno-inline-functions

# ---- the module ----

# What a page calls: core.h, and functions of the library that take numbers and arrays.
open      := (
core_names = $(shell grep -o 'core_[a-z]*$(open)' web/core/core.h | tr -d '$(open)')
ASKED     := scene_free state_free state_set state_set_time state_fit_camera state_set_zones parameter_slots state_parameters \
             value_slots state_values table_rows table_cells state_tables state_table_inputs distance normal mesh_free
comma     := ,
empty     :=
exported   = $(subst $(empty) $(empty),$(comma),$(patsubst %,_%,malloc free $(1)))
# The options of a module, by its functions and what its page supplies.
module_of  = -sMODULARIZE=1 -sEXPORT_NAME=Krs -sEXPORTED_FUNCTIONS=$(call exported,$(1)) -sINCOMING_MODULE_JS_API=$(2) -sFILESYSTEM=0 \
             -sENVIRONMENT=web,worker -sALLOW_MEMORY_GROWTH=1 -sMAXIMUM_MEMORY=2GB -sEXPORTED_RUNTIME_METHODS=HEAPU8
# Links a module, whose options are given.
define LINK_MODULE
@echo "link   $@"
@NODE_PATH=/usr/share/nodejs $(EMCC) -Os $(1) -o $(@:.wasm=.js) $(filter %.o,$^)
@{ cat $(@:.wasm=.js); echo 'export default Krs;'; } >$(@:.wasm=.mjs)
@rm $(@:.wasm=.js)
endef

wasm: $(addprefix $(W)/,krs.wasm letters.wasm core.mjs)
$(W)/krs.wasm: $(WASM_OBJECTS) $(WASM_LIBRARIES:%=$(SOURCES_OF)/%.o) web/core/page.js web/core/core.h web/core/core.mk
	$(call LINK_MODULE,--js-library web/core/page.js -sINITIAL_MEMORY=16MB -sTOTAL_STACK=4MB \
	    $(call module_of,$(core_names) $(ASKED:%=krs_%),instantiateWasm$(comma)load$(comma)font$(comma)letters$(comma)progress))
$(W)/letters.wasm: $(LETTER_SOURCES:%.c=$(W)/%.o) $(LETTER_LIBRARIES:%=$(SOURCES_OF)/%.o) web/core/core.mk
	$(call LINK_MODULE,$(call module_of,letters_of,instantiateWasm))
$(W)/core.mjs: web/core/core.mjs
	@cp $< $@
.PHONY: wasm
