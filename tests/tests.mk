# tests.mk: what `make test`, `make test-long` and `make test-all` run.
#
# Every test speaks TAP; tests/run.sh counts.  `make test DEVICE=...` runs all on another Vulkan
# device, in the words of `krs --device`; `DEVICE=swiftshader` on one that every Debian can have.
# In `make test-long` what needs no device runs under the address and undefined-behaviour sanitizers,
# and everything compiles under clang as well.

# What tests of several kinds share; nothing of it knows what is tested.
SUPPORT     := $(addprefix tests/support/, agreement.c bench.c instance_texts.c device.c folder.c random.c \
               renderer.c same_scene.c scarce.c scattered.c triangles.c)
# What tests of one kind share.
ORACLE      := $(addprefix tests/oracle/, brute.c solids.c expand.c judge.c product.c exact.c \
               formulas.c montecarlo.c quaternions.c chain.c chain_random.c map_chain.c \
               deformed.c methods.c primitive_solids.c primitive_figures.c random_scene.c \
               device_answers.c known_solid.c mesh_distance.c mesh_shape.c outline_truth.c path_fixture.c rooms.c shadow_fixture.c shadow_truth.c truetype.c twigs.c)
UNIT_SHARED := $(addprefix tests/unit/, reading.c traced_scenes.c tracer_fixture.c queried.c \
               cache_folder.c compiled_files.c crossings.c instance_scene.c closed_forms.c)
PROPERTY_SHARED := $(addprefix tests/property/, instance_parts.c garden.c op_trial.c reach_instances.c)
UNIT        := specks exact texts watchdog front service service_random synonyms arguments visibility diagnostics shape parts passes display devices tracer film plates saved noise pixel_filters lens rendering lights light_groups sky_table daylight methods schedules paths writer \
               image_files image_reading memory validate search refute state state_floor framing query zones surroundings cache cache_limits \
               compiled pipelines per_component mixed_rays stencils glslang flatten loader watcher drivers grid instance_grid instances \
               instance_shaders instance_ends instance_pictures few_parts tables device_tables table_files printing printers elementary gathered_noises answers structure update coordinates reload live saved_texts camera_text resolution painter saver profile profiler edits values lane_math mesh mesh_progress mesh_bounds mesh_tets mesh_around mesh_fields mesh_collapse mesh_marks mesh_near mesh_handles mesh_sides mesh_proofs mesh_flat_proofs assembly denoise
PROPERTY    := ops noise textures graph simplify facts derive series zeros local along rebase slope \
               parity reach reach_trees iteration_boxes instances instances_apart instances_deformed instance_sums blends_of_many fillets moving_instances moving_scenes overlaps lanes lane_rows lane_instances lane_balls lane_cells found_surfaces csg_nodes iterations
ORACLES     := research/moebius_images research/enhanced self distant patterns bumps primitives krs_expand folds trees maps moebius operators cells \
               combinations deform deform_bounds chains chain_pictures moving normals fields \
               surfaces rays algebraic fractals metasurfaces device essl query query_limits picture executors \
               albedo furnace thin_film anisotropy tangents subsurface paths direct_glass caustics emissive sky sky_means plate_light detail media volumes cornell touching shading coverage chords area_shadows soft_shadows hard_shadows upsampling closed_rooms \
               occlusion curves sweeps corners hulls lofts boundaries nothing places underestimates bounds stencils light sides steep scales agree far open_surfaces ray_lists specialize outlines glyphs drawings \
               imports imports_csg imports_csg_sizes imports_pov imports_pov_looks imports_pov_open_surfaces flat_meshes round_meshes slices grids measures meshes mesh_forms mesh_examples
FUZZ        := sentences
# On SwiftShader, unless another device is tested: what shows that drivers agree.
DRIVERS     := tests/oracle/drivers
SECOND      := $(DRIVERS) $(addprefix tests/, unit/devices unit/tracer \
               oracle/device oracle/picture oracle/query oracle/query_limits)
PROGRAMS    := $(UNIT:%=tests/unit/%) $(PROPERTY:%=tests/property/%) $(ORACLES:%=tests/oracle/%) \
               $(FUZZ:%=tests/fuzz/%)
# Without a device: what runs under the sanitizers (drivers leak by design).  `make test-all` runs it only
# there, but for BOTH, whose machine code depends on the compiler's options.
SANITIZED   := $(addprefix tests/, unit/texts unit/watchdog unit/front unit/service unit/service_random unit/synonyms unit/diagnostics unit/shape unit/parts unit/passes unit/display \
               unit/writer unit/image_files unit/image_reading unit/validate unit/loader unit/watcher unit/grid unit/instance_grid unit/instances unit/few_parts unit/tables unit/search \
               unit/refute unit/memory unit/cache unit/cache_limits unit/state unit/state_floor unit/framing unit/query \
               unit/zones unit/printers unit/elementary unit/gathered_noises unit/structure unit/update unit/coordinates unit/reload unit/saved_texts unit/camera_text unit/resolution unit/profile unit/values unit/lane_math unit/mesh unit/mesh_progress unit/mesh_tets unit/mesh_around unit/mesh_bounds unit/mesh_collapse unit/mesh_marks unit/mesh_near unit/mesh_handles unit/mesh_sides unit/mesh_flat_proofs unit/assembly unit/denoise property/ops property/noise property/textures property/graph property/simplify \
               property/facts property/derive property/series property/zeros property/local \
               property/along property/rebase property/slope property/parity property/reach \
               property/reach_trees property/iteration_boxes property/instances property/instances_apart property/instances_deformed property/instance_sums property/blends_of_many property/fillets property/moving_instances property/moving_scenes property/overlaps property/lanes property/lane_rows property/lane_instances property/lane_balls property/lane_cells property/found_surfaces property/csg_nodes property/iterations oracle/primitives \
               oracle/krs_expand oracle/folds oracle/bounds \
               oracle/cells oracle/maps oracle/operators oracle/moving \
               oracle/fractals oracle/metasurfaces oracle/normals oracle/tangents oracle/drawings oracle/imports \
               oracle/imports_csg oracle/imports_csg_sizes oracle/imports_pov oracle/imports_pov_looks oracle/imports_pov_open_surfaces fuzz/sentences)
BOTH        := $(addprefix tests/, property/lanes unit/mesh)
PLAIN       := $(filter-out $(filter-out $(BOTH), $(SANITIZED)), $(PROGRAMS))
# Scripts that run alone: events of a window, and measurements.  The others run beside programs, the longest first.
ALONE       := $(addprefix tests/, cli/view.sh cli/view_limits.sh cli/view_random.sh fuzz/fuzz.sh)
LONGEST     := $(addprefix tests/, examples.sh extend/extend.sh errors-sanitized.sh cli/signals.sh gallery.sh lint.sh cli/resume.sh \
               errors.sh cli/watch.sh cli/untrusted.sh cli/silent.sh cli/cache.sh cli/fingerprints.sh cli/failures.sh)
BESIDE      := $(LONGEST) $(filter-out $(LONGEST) $(ALONE) tests/run.sh tests/second_driver.sh tests/bench.sh tests/cli/common.sh, \
               $(wildcard tests/*.sh tests/cli/*.sh tests/web/*.sh))
# What takes more than 11 s of processor, but for what every change should pass: `make test-long` has it, `make test` all
# else, and `make test-all` both (docs/building.md says what costs what).  The sanitizers, clang and the fuzzers belong
# to it, as they compile everything once more, the judge of meshes, whose headers take a minute, and what
# compares switches of `krs help render --all` with each other.
LONG        := $(addprefix tests/, web/many.sh web/pictures.sh web/wgsl_many.sh web/replay.sh web/exports.sh web/playground_long.sh web/python.sh web/site.sh examples.sh extend/extend.sh errors-sanitized.sh fuzz/fuzz.sh bench.sh \
               $(addprefix cli/, cache.sh compose.sh failures.sh fingerprints.sh format.sh install.sh mesh_csg.sh mesh_judges.sh outputs.sh \
               pictures.sh query.sh resume.sh sandboxed.sh scale.sh view.sh view_limits.sh view_random.sh watch.sh) \
               $(addprefix unit/, arguments compiled instance_grid drivers film light_groups memory mesh_proofs methods noise paths \
               per_component plates printing rendering saved schedules values) \
               $(addprefix property/, blends_of_many instances fillets iteration_boxes iterations) \
               $(addprefix oracle/, agree albedo algebraic area_shadows chain_pictures chains closed_rooms combinations cornell coverage \
               caustics direct_glass distant emissive furnace light measures media meshes mesh_examples mesh_forms moebius occlusion paths plate_light \
               ray_lists open_surfaces sky soft_shadows specialize stencils upsampling volumes))
# What a set has of scripts, of programs, and of programs under the sanitizers.
scripts_short    = $(filter-out $(LONG), $(1))
scripts_long     = $(filter $(LONG), $(1))
# many.sh is core.sh with more scenes, wgsl_many.sh wgsl.sh, exports.sh export.sh.
scripts_all      = $(filter-out tests/web/core.sh tests/web/wgsl.sh tests/web/export.sh, $(1))
programs_short  := $(filter-out $(LONG), $(PROGRAMS))
programs_long   := $(filter $(LONG), $(PLAIN))
programs_all    := $(PLAIN)
sanitized_short :=
sanitized_long  := $(SANITIZED)
sanitized_all   := $(SANITIZED)
# That drivers agree: another device is compared with lavapipe, or else SwiftShader, which is slow.
drivers_short    = $(if $(DEVICE),$(DRIVERS:%=$(B)/%))
drivers_long     = $(if $(DEVICE),,$(SECOND_RUN))
drivers_all      = $(drivers_short) $(drivers_long)

# So many programs run at once: most use one core, as they compile shaders.  A device that is asked
# for is left to one.
TEST_JOBS   ?= $(if $(DEVICE)$(filter 1,$(JOBS)),1,2)

ARCHIVE      = rm -f $@ && $(AR) rcs $@ $^
$(B)/tests/support/support.a: $(SUPPORT:%.c=$(B)/%.o)
	@$(ARCHIVE)
$(B)/tests/oracle/oracle.a: $(ORACLE:%.c=$(B)/%.o)
	@$(ARCHIVE)
$(B)/tests/unit/unit.a: $(UNIT_SHARED:%.c=$(B)/%.o)
	@$(ARCHIVE)
$(B)/tests/property/property.a: $(PROPERTY_SHARED:%.c=$(B)/%.o)
	@$(ARCHIVE)

# 270 programs are linked: the default linker takes three times as long as lld, and twice as gold.
QUICK_LINKER := $(patsubst ld.%,-fuse-ld=%,$(notdir $(firstword $(wildcard /usr/bin/ld.lld /usr/bin/ld.gold))))
LINK         = $(CC_LINK) $(QUICK_LINKER) -o $@ $^ $(LIBS) -lcmocka
LINKED      := $(B)/tests/support/support.a $(INTERNAL)
$(B)/tests/oracle/%: $(B)/tests/oracle/%.o $(B)/tests/oracle/oracle.a $(LINKED)
	@$(LINK)
$(B)/tests/unit/%: $(B)/tests/unit/%.o $(B)/tests/unit/unit.a $(LINKED)
	@$(LINK)
$(B)/tests/property/%: $(B)/tests/property/%.o $(B)/tests/property/property.a $(LINKED)
	@$(LINK)
$(B)/tests/%: $(B)/tests/%.o $(LINKED)
	@$(LINK)
# What node compares with.
$(B)/tests/web/texts $(B)/tests/web/points: %: %.o $(B)/tests/oracle/oracle.a $(LINKED)
	@$(LINK)
# record.c is called before these.
RECORDED    := layouts_create buffer_create buffer_destroy set_bind shader_load_all gpu_copy gpu_fill gpu_write gpu_dispatch \
               gpu_dispatch_counted gpu_finish
$(B)/tests/web/record: %: %.o $(LINKED)
	@$(LINK) $(RECORDED:%=-Wl,--wrap=%)
IMPORTS     := imports imports_csg imports_csg_sizes imports_pov imports_pov_looks imports_pov_open_surfaces
$(IMPORTS:%=$(B)/tests/oracle/%): $(B)/tests/oracle/%: $(B)/tests/oracle/%.o $(B)/tests/oracle/imported.o $(B)/tests/oracle/pov_trees.o \
        $(B)/import.a $(LINKED)
	@$(LINK)
$(B)/tests/oracle/essl: %: %.o $(B)/tests/oracle/oracle.a $(LINKED)
	@$(LINK) -lEGL -lGLESv2
$(B)/tests/unit/watcher: $(B)/live.a
# A reader of JSON that is not ours.
$(B)/tests/unit/service_random: %: %.o $(B)/tests/unit/unit.a $(LINKED)
	@$(LINK) $(JSON_LIBS)
$(addprefix $(B)/tests/unit/, live saved_texts camera_text resolution painter saver profile profiler): $(B)/tests/unit/%: $(B)/tests/unit/%.o $(B)/live.a $(LINKED)
	@$(LINK)
# What CGAL finds of meshes, where it is installed: without it, tests say so.  At -O2 and with names for a
# debugger it takes twice as long to compile.
CGAL        := $(wildcard /usr/include/CGAL/Surface_mesh.h)
JUDGE       := $(if $(CGAL),$(addprefix $(B)/tests/oracle/, mesh_judge csg_solids))
MESH_JUDGE  := $(filter %/mesh_judge, $(JUDGE))
CSG_SOLIDS  := $(addprefix $(B)/tests/oracle/, csg_random.o csg_text.o csg_polyhedra.o csg_truth.o csg_triangles.o truetype.o)
MESH_FAULTS := $(B)/tests/oracle/mesh_faults.o
$(JUDGE:%=%.o) $(CSG_SOLIDS) $(MESH_FAULTS): CXXFLAGS := -O1 -g0
# CGAL checks each step of its set operations otherwise, and gcc warns of its headers.
$(B)/tests/oracle/csg_truth.o: CXXFLAGS += -DNDEBUG -Wno-maybe-uninitialized
$(B)/tests/oracle/csg_solids: $(CSG_SOLIDS)
$(JUDGE): %: %.o $(MESH_FAULTS)
	@$(CXX) $(CFLAGS) -o $@ $^ -lgmp -lmpfr
# Meshes of 300 random scenes, of all examples, and a Menger sponge of three levels, by all judges, and 1,000 solids beside
# CGAL's: two hours.
test-meshes: $(B)/krs $(addprefix $(B)/tests/oracle/, meshes mesh_forms mesh_examples) $(JUDGE)
	@mkdir -p $(B)/meshes && rm -f $(B)/meshes/*.off
	@$(B)/tests/oracle/meshes 300 $(B)/meshes
	@$(B)/tests/oracle/mesh_forms $(B)/meshes
	@$(B)/tests/oracle/mesh_examples examples/*.krs
	@$(if $(JUDGE),$(MESH_JUDGE) $(B)/meshes/*.off && mkdir -p $(B)/solids && \
	    $(B)/tests/oracle/csg_solids $(B)/krs 1000 0 $(B)/solids,echo "no CGAL: nothing else looked at the meshes")
# It runs the command.
$(B)/tests/unit/table_files: | $(B)/krs
# In no archive: system calls that can fail are for those two alone.
$(B)/tests/unit/writer $(B)/tests/unit/image_files: $(B)/tests/unit/file_faults.o
.PRECIOUS: $(B)/%.o

# Pictures under every option, bit for bit as they were: for changes that should not be seen.
golden: all $(B)/tests/golden/pictures
	@B=$(B) tests/golden/pictures.sh

test-programs: $(B)/libkrs.so $(PLAIN:%=$(B)/%) $(DRIVERS:%=$(B)/%) $(JUDGE)
sanitized-programs: $(SANITIZED:%=$(B)/%) $(B)/krs
SANITIZERS  := -g -O1 -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=undefined
sanitize:
	@$(MAKE) --no-print-directory sanitized-programs B=$(B)/asan CFLAGS='$(SANITIZERS)' CXXFLAGS='$(SANITIZERS)'

# clang must like every file as well: those that the fuzzers leave out, and those of lanes, which only
# here become vector instructions.  Its objects are not linked, and no warning needs more than -O0.
clang-check: $(B)/library_files.c $(B)/shader_files.c
	@$(MAKE) --no-print-directory clang-objects B=$(B)/clang CC=$(CLANG) CFLAGS=-O0
clang-objects: $(patsubst %.c,$(B)/%.o,$(LANES) $(TARGET) $(RUNTIME) $(API) $(IMPORT) $(LIVE) $(CLI))

# The front end (lexer, parser, names) and the whole compiler but glslang under libFuzzer.
HARNESSES   := front_fuzz scene_fuzz
FUZZED      := $(filter-out $(TARGET), $(COMPILER))
fuzz-programs: $(HARNESSES:%=$(B)/tests/fuzz/%)
$(HARNESSES:%=$(B)/tests/fuzz/%): $(B)/tests/fuzz/%: $(B)/tests/fuzz/%.o \
                                    $(FUZZED:%.c=$(B)/%.o) $(PLATFORM:%.c=$(B)/%.o) $(B)/library_files.o \
                                    $(B)/helper_files.o $(B)/essl_files.o
	@$(CC) $(CFLAGS) -fsanitize=fuzzer -o $@ $^ $(FRONT_LIBS) -lstdc++ -lm
fuzzers:
	@$(MAKE) --no-print-directory fuzz-programs B=$(B)/fuzz CC=$(CLANG) \
	    CFLAGS='-g -O1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined'
fuzz: fuzzers
	@B=$(B) FUZZ_SECONDS=$(FUZZ_SECONDS) tests/fuzz/fuzz.sh

# All of it for hours, each time by other numbers, with a row in bench/results/soak.md; what is not built is left out, such as
# build/asan/krs (make sanitize), fuzzers (make fuzzers) and build/tsan/krs (make threads).
HOURS       ?= 1
soak: $(B)/krs $(B)/tests/fuzz/sentences
	@nice python3 tests/soak/soak.py --build $(B) --hours $(HOURS) $(if $(SEED),--seed $(SEED)) --row bench/results/soak.md
threads:
	@$(MAKE) --no-print-directory $(B)/tsan/krs B=$(B)/tsan CC=$(CLANG) CXX=$(CLANG)++ CFLAGS='-g -O1 -fsanitize=thread' \
	    CXXFLAGS='-g -O1 -fsanitize=thread'

# For lint, which finds programs that no list has.
list-programs:
	@echo $(PROGRAMS) $(DRIVERS)
lint:
	@tests/lint.sh
layers:
	@tests/layers.sh
docs: $(B)/krs
	@tests/docs.sh
format:
	@clang-format -i $$(find api bench cli compiler denoise examples export grid import include live measure mesh platform rays runtime site slice tests web -name '*.[ch]' -o -name '*.cpp')
bless: $(B)/krs
	@tests/errors.sh --bless

# Found when it is run: `make test` has installed it, where the system has it.
SECOND_RUN   = tests/second_driver.sh $(if $(shell . tests/support/drivers.sh && [ -e "$$swiftshader_driver" ] && echo there), \
               KRS_DEVICE=swiftshader $(SECOND:%=$(B)/%))
test:      SET := short
test-long: SET := long
test-all:  SET := all
# What scripts of tests/web use, which run side by side, where test-deps could install what builds it.  They tell what is missing.
web        = $(if $(and $(shell command -v emcc),$(shell command -v node)),web $(B)/tests/web/texts $(B)/tests/web/points $(B)/tests/web/record)
played     = $(if $(and $(web),$(shell command -v npm),$(shell command -v esbuild)),playground kernels $(NPM)/site.mjs $(B)/site-words)
scripts    = $(call scripts_$(SET), $(1))
programs   = $(patsubst %,$(B)/%,$(programs_$(SET)))
sanitized  = $(patsubst %,$(B)/asan/%,$(sanitized_$(SET)))
test test-long test-all: export WERROR = 1
test test-long test-all: test-deps
	@$(MAKE) --no-print-directory -j$(JOBS) all $(B)/bench/bench $(programs) $(if $(DEVICE),$(DRIVERS:%=$(B)/%)) \
	    $(if $(filter short, $(SET)),,$(JUDGE) $(SECOND:%=$(B)/%) sanitize clang-check fuzzers)
	@$(if $(web),$(MAKE) --no-print-directory -j$(JOBS) $(web) || echo "$(web): not built")
	@$(if $(played),$(MAKE) --no-print-directory -j$(JOBS) $(played) || echo "$(played): not built")
	@B=$(B) FUZZ_SECONDS=$(FUZZ_SECONDS) KRS=$(B)/krs KRS_TEST_SECONDS=900 \
	    tests/run.sh $(if $(DEVICE),KRS_DEVICE="$(DEVICE)") \
	    JOBS=$(TEST_JOBS) $(call scripts, $(BESIDE)) $(programs) $(sanitized) \
	    JOBS=1 $(call scripts, $(ALONE)) JOBS=$(TEST_JOBS) $(drivers_$(SET))
.PHONY: test test-long test-all test-meshes golden list-programs test-programs soak threads sanitize sanitized-programs clang-check clang-objects fuzz fuzzers \
        fuzz-programs lint layers docs format bless
