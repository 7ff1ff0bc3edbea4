# make            build/krs, build/libkrs.a, build/libkrs.so; WERROR=1: warnings are errors
# make demo       set up, build, render the best examples in two minutes: open build/demo/index.html
# make gallery    all of them, as the README has them, to build/gallery/: about an hour
# make test       set up, build, run every test but the longest; the last line is `N passed, N failed`, and
#                 `, N skipped` where some were; DEVICE=...: on another device (krs devices)
# make test-long  the longest, with sanitizers, clang and the fuzzers; test-all: both (docs/building.md)
# make test-meshes    300 random meshes within their error, and what CGAL finds of them; half an hour
# make sanitize   the same programs under ASan and UBSan, in build/asan/
# make bench      measures, writes bench/results/; bench-quick: only whether it can
# make bench-normals    how normals are found
# make bench-algebraic  algebraic surfaces beside other programs
# make check-device DEVICE=...  what to know of a Vulkan device first, in ten minutes
# make bench-registers  registers, waves and spills of each shader on a graphics card
# make bench-view       how fast the viewer follows edits, sliders and the camera
# make bench-edits      how long a saved number takes to its picture, by krs watch and by krs render
# make bench-web        how large the package for pages is, and how fast a page follows edits
# make minify     how well one sample shows what is finer than a pixel
# make fuzz       the front end under libFuzzer for FUZZ_SECONDS (20)
# make golden     pictures under every option, bit for bit as they were: after changes that nobody should see
# make lint       shaders by themselves, shell scripts, style of C
# make format     brings that style about
# make bless      writes the expected text of tests/errors/; read the difference
# make deps       installs what building and rendering need (Debian packages); test-deps: also what tests need
# make wasm       the compiler for web pages, in build/wasm/ (web/core/README.md); tools/deps.sh wasm installs what it needs
# make web        the package `krs` for pages, in build/web/ (web/package/README.md); web-pack: its archive
# make python     the package for Python, in build/python/; make wheel: as a file for pip (docs/python.md)
# make playground the playground, a static folder in build/playground/ (docs/playground.md); serve: shows it at localhost
# make site       the site: documents, references, gallery and playground, in build/site/ (site/README.md); serve-site: shows it
# make kernels    the runtime's shaders as WGSL, in build/kernels (web/tracer/README.md), with packages of npm
# make vscode     the extension for VS Code, in build/vscode, with packages of npm
# make dist       the sources as one file; make deb: packages for Debian, both in build/dist (docs/packaging.md)
# make install    to PREFIX (/usr/local), below DESTDIR; uninstall: takes it away

B       ?= build
# A folder of this one has one name only: those that the compiler writes into build/*.d are taken as they are.
override B := $(patsubst $(CURDIR)/%,%,$(abspath $(B)))
CFLAGS  ?= -g -O2
FUZZ_SECONDS ?= 20
CLANG   ?= clang
DEVICE  ?= $(KRS_DEVICE)
# How many jobs `make test` has while it builds.
JOBS    ?= $(shell nproc)

# Sources by folder, in the order of the pipeline: reading down this list is reading the program.
ROOMS    := base image outline graph graph/bounds graph/lanes graph/rewrite graph/symbolic graph/instances shape lower lower/research family front eval eval/declared eval/view eval/data eval/hulls eval/builtins print print/glsl print/essl print/wgsl target scene passes refute field service
sources   = $(sort $(wildcard $(1)/*.c))
COMPILER := $(foreach room,$(ROOMS),$(call sources,compiler/$(room)))
# Clients of the compiler: it knows nothing of them.
CLIENTS  := $(foreach room,mesh/common mesh/contour mesh/proof mesh/flat mesh/simplify mesh slice grid measure denoise rays export,$(call sources,$(room)))
# What the system is asked for.
PLATFORM := $(call sources,platform/linux)
# Points and rays side by side, once for each instruction set.
OTHERS   := $(if $(filter x86_64-%,$(shell $(CC) -dumpmachine)),%/sets_plain.c,%_avx2.c %_avx512.c %/sets_x86.c)
COMPILER := $(filter-out $(OTHERS),$(COMPILER))
CLIENTS  := $(filter-out $(OTHERS),$(CLIENTS))
LANES    := $(filter compiler/graph/lanes/lanes_% rays/lanes_%,$(COMPILER) $(CLIENTS))
TARGET   := $(call sources,compiler/target)
BRIDGE   := compiler/target/glslang_bridge.cpp
RUNTIME  := $(foreach room,device tracer/research tracer integrators film display writer,$(call sources,runtime/$(room)))
# What programs link with of other versions, too (api/README.md).
API      := $(call sources,api)
IMPORT   := $(foreach room,import/common import/csg import/surfer import/pov import,$(call sources,$(room)))
LIVE     := $(foreach room,profile live/text live/pictures live/window live,$(call sources,$(room)))
LIVE_BRIDGE := live/window/gui.cpp
CLI      := $(foreach room,cli/options cli/pack cli/sandbox cli/shell cli/picture cli/farm cli/mesh cli/grid cli/slice cli/denoise cli/lsp cli,$(call sources,$(room)))
CLI_BRIDGE := cli/mesh/glb_materials.cpp cli/mesh/glb.cpp cli/shell/terminate.cpp
# OpenVDB is loaded when a .vdb is written: it takes longer to load than most commands to run.
VDB       = $(if $(VDB_LIBS),$(B)/krs-vdb.so)

# Text files that the program carries: the standard library, what scenes and shaders share, shaders.
LIBRARY  := $(sort $(wildcard compiler/library/*.krs compiler/library/std/*.krs))
HELPERS  := $(sort $(wildcard compiler/print/glsl/*.glsl))
ESSL     := $(sort $(wildcard compiler/print/essl/*.glsl))
EXPORTS  := $(sort $(wildcard export/templates/*))
SHADERS  := $(sort $(wildcard $(addprefix runtime/shaders/,*.comp *.glsl research/*.comp research/*.glsl) runtime/shared/*.h)) \
            include/krs/surface.def include/krs/light_types.def
# Shaders without a scene are compiled here and now, not on every machine again; what is optimized
# here, drivers need not.
MODULES  := $(shell grep -L 'include "scene.glsl"' runtime/shaders/*.comp)
MODULES  := $(MODULES:runtime/shaders/%=$(B)/modules/%.spv) \
            $(addprefix $(B)/modules/, escape.comp-PATH_RAYS.spv background.comp-SKY_MAP.spv \
                                       aim.comp-MIXED_RAYS.spv arrive.comp-MIXED_RAYS.spv \
                                       shade.comp-SURFACES.spv shade.comp-SURFACES-LAYERS.spv \
                                       shade.comp-SURFACES-MIRRORS-MIXED_RAYS.spv \
                                       shade.comp-SURFACES-MIRRORS-MIXED_RAYS-LAYERS.spv)
# lavapipe reads the frame as texels (frame.glsl).
MODULES  += $(MODULES:%.spv=%-FRAME_TEXELS.spv)
# Lanes draw first pictures there, of scenes with a lens as well.
MODULES  += $(patsubst %,$(B)/modules/%-PANORAMIC-LENS-FRAME_TEXELS.spv, \
                       background.comp unproven.comp penumbrae.comp shadow.comp occlusion.comp aim.comp aim.comp-MIXED_RAYS \
                       shade.comp-SURFACES shade.comp-SURFACES-MIRRORS-MIXED_RAYS)
EXAMPLES := $(sort $(wildcard examples/*.krs))

# WERROR=1 makes an error of each warning: for developers, `make test` and CI.  Compilers of users are newer.
WERROR   ?=
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow $(if $(filter 1,$(WERROR)),-Werror)
# All can be linked into a shared library, and no name of ours is seen outside but those of the public headers.
# Structs of programs here have the size that the library knows (KRS_SIZED in krs/krs.h).
COMMON   := -I. -Iinclude -DKRS_LIBRARY -MMD -MP -pthread -fPIC -fvisibility=hidden
# Numbers are rounded as they are written: a scene has the same text on every machine (base/elementary.h).
STYLE    := -std=c17 -D_GNU_SOURCE -ffp-contract=off $(WARNINGS) $(COMMON)
CC_C     = $(CC) $(STYLE) $(HEADERS) $(CPPFLAGS) $(CFLAGS)
# Headers of libraries in C++ are long: under the sanitizers -O1 would take three times as long as -O0.
CC_CXX   = $(CXX) -std=c++17 -Wall -Wextra $(COMMON) $(HEADERS) $(CPPFLAGS) $(CXXFLAGS) \
           $(if $(findstring -fsanitize,$(CXXFLAGS)),-O0)
# What static libraries define, programs do not lend to shared ones.
CC_LINK  = $(CC) $(CFLAGS) $(LDFLAGS) -Wl,--exclude-libs,ALL
# The command is loaded anywhere, and what calls to libraries go by is read-only from its start on.
HARDENED := -pie -Wl,-z,relro -Wl,-z,now
include tools/libraries.mk

OBJECTS  := $(COMPILER:%.c=$(B)/%.o) $(PLATFORM:%.c=$(B)/%.o) $(CLIENTS:%.c=$(B)/%.o) $(BRIDGE:%.cpp=$(B)/%.o) $(B)/library_files.o \
            $(B)/helper_files.o $(B)/essl_files.o $(B)/export_files.o $(RUNTIME:%.c=$(B)/%.o) $(API:%.c=$(B)/%.o) $(B)/shader_files.o $(B)/module_files.o \
            $(B)/albedo_tables.o $(B)/fingerprints.o

# Programs of this project are linked with the library's parts; others with the library, which shows its API alone.
INTERNAL := $(B)/libkrs-internal.a
# The library is loaded by a name that says what it is compatible with: before 1.0 the minor version.
VERSION  := $(shell sed -n 's/^.define KRS_VERSION  *"\(.*\)"/\1/p' include/krs/krs.h)
SONAME   := libkrs.so.$(basename $(VERSION))
SHARED   := libkrs.so.$(VERSION)

all: $(B)/krs $(B)/libkrs.a $(B)/libkrs.so $(VDB)
$(B)/krs: $(CLI:%.c=$(B)/%.o) $(B)/commit.o $(CLI_BRIDGE:%.cpp=$(B)/%.o) $(B)/live.a $(B)/import.a $(INTERNAL)
	@echo "link   $@"
	@$(CC_LINK) $(HARDENED) -o $@ $^ $(WINDOW_LIBS) $(MESH_LIBS) $(JSON_LIBS) $(SECCOMP_LIBS) $(LIBS)
# Its headers take a minute to compile, and twice that with names for a debugger.
$(B)/cli/grid/openvdb.o: CXXFLAGS += -O1 -g0
$(B)/krs-vdb.so: $(B)/cli/grid/openvdb.o
	@echo "link   $@"
	@$(CXX) $(CXXFLAGS) $(LDFLAGS) -shared -o $@ $< $(VDB_LIBS)
# What the command has for scenes that are open, and for files of other programs: clients of the library, and no
# part of it.
$(B)/live.a: $(LIVE:%.c=$(B)/%.o) $(LIVE_BRIDGE:%.cpp=$(B)/%.o)
$(B)/import.a: $(IMPORT:%.c=$(B)/%.o)
$(B)/live.a $(B)/import.a: $(B)/members
	@rm -f $@
	@$(AR) rcs $@ $(filter %.o, $^)
$(INTERNAL): $(OBJECTS) $(B)/members
	@echo "pack   $@"
	@rm -f $@
	@$(AR) rcs $@ $(filter %.o, $^)
# One object whose hidden names are local.  Its sections are in no groups any more: a linker would drop
# those of which another library has the like, and what names are local could not be found there.
$(B)/krs.o: $(OBJECTS)
	@$(CC) $(CFLAGS) -r -nostdlib -o $@ $^
	@$(OBJCOPY) --remove-section=.group --localize-hidden --wildcard --localize-symbol='_Z*' $@
$(B)/libkrs.a: $(B)/krs.o
	@echo "pack   $@"
	@rm -f $@
	@$(AR) rcs $@ $^
$(B)/$(SHARED): $(B)/krs.o
	@echo "link   $@"
	@$(CC_LINK) -shared -Wl,-soname,$(SONAME) -o $@ $^ $(LIBS)
$(B)/libkrs.so: $(B)/$(SHARED)
	@ln -sf $(SHARED) $(B)/$(SONAME)
	@ln -sf $(SONAME) $@
# What archives hold: one whose list has changed is packed again, although a new member may be older.
MEMBERS  := $(OBJECTS) $(IMPORT:%.c=$(B)/%.o) $(LIVE:%.c=$(B)/%.o) $(LIVE_BRIDGE:%.cpp=$(B)/%.o)
ifneq ($(file <$(B)/members),$(MEMBERS))
.PHONY: $(B)/members
endif
$(B)/members:
	@mkdir -p $(@D)
	@echo '$(MEMBERS)' >$@
# What is compiled with other options is compiled again; an error for a warning changes no object.
FLAGS    := $(filter-out ccache,$(CC) $(CXX)) $(filter-out -Werror,$(STYLE)) $(CPPFLAGS) $(CFLAGS) / $(CXXFLAGS)
ifneq ($(file <$(B)/flags),$(FLAGS))
.PHONY: $(B)/flags
endif
$(B)/flags:
	@mkdir -p $(@D)
	@echo '$(FLAGS)' >$@
$(B)/%.o: %.c $(B)/flags
	@mkdir -p $(@D)
	@echo "compile $<"
	@$(CC_C) $(FAST) -c -o $@ $<
$(B)/live/window/cells.o: FAST = $(if $(CHAFA),-DKRS_HAS_CHAFA)
# Loops over lanes become vector instructions; results are the same on every machine.  What sanitizers
# watch cannot become such: trying it takes minutes, and clang warns that it failed.
$(LANES:%.c=$(B)/%.o): FAST := $(if $(findstring -fsanitize,$(CFLAGS)),-Wno-pass-failed,-O3) \
                               -fno-math-errno -fno-trapping-math
# Its series are loops.
$(B)/compiler/base/elementary.o: FAST := -O3
$(B)/compiler/graph/lanes/lanes_avx2.o $(B)/rays/lanes_avx2.o: FAST += -mavx2
$(B)/compiler/graph/lanes/lanes_avx512.o $(B)/rays/lanes_avx512.o: FAST += -mavx512f -mavx512dq -mavx512vl -mprefer-vector-width=512
# Intervals are two numbers that come in registers: joined into a vector they would go through memory, and wait there.
$(B)/compiler/graph/range.o $(B)/compiler/graph/lanes/lane_ranges.o $(B)/compiler/graph/lanes/lane_slopes.o $(B)/compiler/graph/lanes/lane_hessians.o $(B)/compiler/graph/bounds/numbers.o: FAST := -fno-tree-slp-vectorize
$(B)/%.o: %.cpp $(B)/flags
	@mkdir -p $(@D)
	@echo "compile $<"
	@$(CC_CXX) -c -o $@ $<
$(B)/%.o: $(B)/%.c $(B)/flags
	@$(CC_C) -c -o $@ $<
$(B)/library_files.c: $(B)/embed $(LIBRARY)
	@$(B)/embed library_files compiler/library/ -- $(LIBRARY) >$@
$(B)/helper_files.c: $(B)/embed $(HELPERS)
	@$(B)/embed helper_files compiler/print/glsl/ -- $(HELPERS) >$@
$(B)/essl_files.c: $(B)/embed $(ESSL)
	@$(B)/embed essl_files compiler/print/essl/ -- $(ESSL) >$@
$(B)/export_files.c: $(B)/embed $(EXPORTS)
	@$(B)/embed export_files export/templates/ -- $(EXPORTS) >$@
$(B)/shader_files.c: $(B)/embed $(SHADERS)
	@$(B)/embed shader_files runtime/shaders/ include/ -- $(SHADERS) >$@
$(B)/module_files.c: $(B)/embed $(MODULES)
	@$(B)/embed module_files $(B)/modules/ -- $(MODULES) >$@
# A module of a shader: FILE.spv, or FILE-NAME-NAME.spv with these names defined.
define MAKE_MODULE
	@mkdir -p $(@D)
	@echo "shader $<$(addprefix -D,$(1))"
	@glslangValidator -V --target-env vulkan1.1 $(addprefix -D,$(1)) -I. -Iinclude -Iruntime/shaders -Icompiler/print/glsl -o $@ $< >/dev/null
	@spirv-opt --target-env=vulkan1.1 -O $@ -o $@
	@spirv-val --target-env vulkan1.1 $@
endef
module_words = $(subst -, ,$(1:$(B)/modules/%.spv=%))
define MODULE_RULE
$(1): runtime/shaders/$(firstword $(module_words)) $(SHADERS) $(HELPERS)
	$$(call MAKE_MODULE,$(wordlist 2,$(words $(module_words)),$(module_words)))
endef
$(foreach module,$(MODULES),$(eval $(call MODULE_RULE,$(module))))
# Tables of the light that rough surfaces reflect are means over many points, rounded.
$(B)/albedo_tables.c: $(B)/albedo_tables
	@$(B)/albedo_tables >$@
$(B)/albedo_tables: tools/albedo_tables.c runtime/tracer/albedos.h runtime/shared/blocks.h
	@mkdir -p $(@D)
	@$(CC) $(STYLE) $(CPPFLAGS) -O3 -ffast-math $(LDFLAGS) -o $@ $< -lm
$(B)/embed: compiler/base/embed/embed.c
	@mkdir -p $(@D)
	@$(CC) $(STYLE) $(CPPFLAGS) -O1 $(LDFLAGS) -o $@ $<

include tools/fingerprints.mk
include web/core/core.mk
include editors/vscode/vscode.mk
include python/python.mk
include web/package/package.mk
include web/playground/playground.mk
include web/tracer/tracer.mk
include site/site.mk
include tests/tests.mk
include bench/bench.mk
include tools/install.mk
include tools/packages.mk
include tools/faces.mk

# ---- what a newcomer types ----
demo: deps
	@$(MAKE) --no-print-directory -j$(JOBS) all
	@tools/gallery.sh $(B) demo
gallery: deps
	@$(MAKE) --no-print-directory -j$(JOBS) all
	@tools/gallery.sh $(B) gallery
deps:
	@tools/deps.sh
test-deps:
	@tools/deps.sh test
libs:
	@echo $(LIBS)
clean:
	rm -rf build
.PHONY: all demo gallery deps test-deps libs clean
.DELETE_ON_ERROR:
-include $(shell find $(B) -name '*.d' 2>/dev/null)
