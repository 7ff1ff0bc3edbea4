# tests.mk: what `make test` runs.
#
# Every test speaks TAP; tests/run.sh counts.  `make test DEVICE=...` runs all on another Vulkan
# device, in the words of `krs --device`; `DEVICE=swiftshader` on one that every Debian can have.
# The compiler's tests run a second time under the address and undefined-behaviour sanitizers, and
# everything compiles under clang as well.

# What tests of several kinds share; nothing of it knows what is tested.
SUPPORT     := $(addprefix tests/support/, agreement.c bench.c device.c random.c \
               renderer.c scarce.c)
ORACLE      := $(addprefix tests/oracle/, brute.c solids.c expand.c judge.c product.c chain.c \
               exact.c formulas.c rooms.c montecarlo.c)
UNIT        := front passes film tracer methods writer memory validate refute frame query cache \
               compiled per_component stencils glslang loader drivers grid
PROPERTY    := ops noise graph derive series zeros local along rebase slope parity reach
ORACLES     := self primitives krs_expand trees maps moebius operators combinations deform chains \
               chain_pictures moving normals fields surfaces rays algebraic fractals device query \
               picture touching shading coverage shadows occlusion underestimates bounds stencils light sides \
               steep scales agree far sheets
FUZZ        := sentences
# On SwiftShader, unless another device is tested: what shows that drivers agree.
DRIVERS     := tests/oracle/drivers
SECOND      := $(DRIVERS) $(addprefix tests/, unit/tracer oracle/device oracle/picture oracle/query)
PROGRAMS    := $(UNIT:%=tests/unit/%) $(PROPERTY:%=tests/property/%) $(ORACLES:%=tests/oracle/%) \
               $(FUZZ:%=tests/fuzz/%)
# Without a device: what runs under the sanitizers, too (drivers leak by design).
SANITIZED   := tests/unit/front tests/unit/passes tests/unit/film tests/unit/writer \
               tests/unit/validate tests/unit/loader tests/unit/grid \
               tests/unit/refute tests/unit/memory tests/unit/cache tests/unit/frame \
               tests/unit/query tests/property/ops tests/property/noise tests/property/graph \
               tests/property/derive tests/property/series tests/property/zeros \
               tests/property/local \
               tests/property/along tests/property/rebase tests/property/slope \
               tests/property/parity tests/property/reach tests/oracle/primitives \
               tests/oracle/krs_expand tests/oracle/bounds tests/oracle/maps tests/oracle/moebius \
               tests/oracle/operators tests/oracle/moving tests/oracle/fractals \
               tests/oracle/normals tests/fuzz/sentences
SCRIPTS     := tests/run_selftest.sh tests/layers.sh tests/grammar.sh tests/editors.sh \
               tests/lint.sh tests/errors.sh tests/golden.sh tests/examples.sh tests/library.sh tests/docs.sh \
               $(sort $(filter-out tests/cli/common.sh, $(wildcard tests/cli/*.sh)))

$(B)/tests/oracle/oracle.a: $(ORACLE:%.c=$(B)/%.o)
	@rm -f $@
	@$(AR) rcs $@ $^
$(B)/tests/support/support.a: $(SUPPORT:%.c=$(B)/%.o)
	@rm -f $@
	@$(AR) rcs $@ $^
$(B)/tests/oracle/%: $(B)/tests/oracle/%.o $(B)/tests/oracle/oracle.a \
                     $(B)/tests/support/support.a $(B)/libkrs.a
	@$(CC) $(STYLE) $(CFLAGS) -o $@ $^ $(LIBS) -lcmocka
$(B)/tests/%: $(B)/tests/%.o $(B)/tests/support/support.a $(B)/libkrs.a
	@$(CC) $(STYLE) $(CFLAGS) -o $@ $^ $(LIBS) -lcmocka
.SECONDARY:

# Pictures under every option, bit for bit as they were: for changes that should not be seen.
golden: all $(B)/tests/golden/pictures
	@B=$(B) tests/golden/pictures.sh

test-programs: $(PROGRAMS:%=$(B)/%) $(DRIVERS:%=$(B)/%)
sanitized-programs: $(SANITIZED:%=$(B)/%) $(B)/krs
sanitize:
	@$(MAKE) --no-print-directory sanitized-programs B=$(B)/asan \
	    CFLAGS='-g -O1 -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=undefined'

# clang must like every file as well; its objects are not linked.
clang-check: $(B)/library_files.c $(B)/shader_files.c
	@$(MAKE) --no-print-directory clang-objects B=$(B)/clang CC=$(CLANG) CFLAGS=-O1
clang-objects: $(COMPILER:%.c=$(B)/%.o) $(RUNTIME:%.c=$(B)/%.o) $(CLI:%.c=$(B)/%.o)

# The front end (lexer, parser, names) and the whole compiler but glslang under libFuzzer.
HARNESSES   := front_fuzz scene_fuzz
FUZZED      := $(filter-out $(TARGET), $(COMPILER))
fuzz-programs: $(HARNESSES:%=$(B)/tests/fuzz/%)
$(HARNESSES:%=$(B)/tests/fuzz/%): $(B)/tests/fuzz/%: $(B)/tests/fuzz/%.o \
                                    $(FUZZED:%.c=$(B)/%.o) $(B)/library_files.o \
                                    $(B)/helper_files.o
	@$(CC) $(CFLAGS) -fsanitize=fuzzer -o $@ $^ -lm
fuzzers:
	@$(MAKE) --no-print-directory fuzz-programs B=$(B)/fuzz CC=$(CLANG) \
	    CFLAGS='-g -O1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined'
fuzz: fuzzers
	@B=$(B) FUZZ_SECONDS=$(FUZZ_SECONDS) tests/fuzz/fuzz.sh

lint:
	@tests/lint.sh
format:
	@clang-format-14 -i $$(find bench cli compiler runtime tests -name '*.[ch]' -o -name '*.cpp')
bless: $(B)/krs
	@tests/errors.sh --bless

test: deps
	@$(MAKE) --no-print-directory -j$(JOBS) all test-programs clang-check fuzzers
	@$(MAKE) --no-print-directory -j$(JOBS) sanitize
	@B=$(B) FUZZ_SECONDS=$(FUZZ_SECONDS) KRS=$(B)/krs KRS_TEST_SECONDS=300 \
	    tests/run.sh $(if $(DEVICE),KRS_DEVICE="$(DEVICE)") $(PROGRAMS:%=$(B)/%) $(SCRIPTS) \
	    $(SANITIZED:%=$(B)/asan/%) tests/errors-sanitized.sh tests/fuzz/fuzz.sh \
	    $(if $(DEVICE),$(DRIVERS:%=$(B)/%),KRS_DEVICE=swiftshader $(SECOND:%=$(B)/%))
.PHONY: test golden test-programs sanitize sanitized-programs clang-check clang-objects fuzz fuzzers \
        fuzz-programs lint format bless
