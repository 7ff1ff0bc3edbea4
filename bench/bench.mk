# bench.mk: `make bench` measures, and writes bench/results/; `make bench-quick` tries out that it
# can, on small pictures, and writes to the build folder.  bench/README.md says what is measured.

BENCH    := $(sort $(filter-out bench/fixture.c, $(wildcard bench/*.c)))
REVISION  = $(shell git describe --always --dirty 2>/dev/null || echo unknown)

$(B)/bench/bench: $(BENCH:%.c=$(B)/%.o) $(INTERNAL)
	@echo "link   $@"
	@$(CC_LINK) -o $@ $^ $(LIBS)
bench: deps
	@$(MAKE) --no-print-directory $(B)/bench/bench $(B)/krs
	@$(B)/bench/bench --krs $(B)/krs --revision $(REVISION)
bench-quick: $(B)/bench/bench $(B)/krs
	@$(B)/bench/bench --krs $(B)/krs --revision $(REVISION) --quick --folder $(B)/bench/results

# How well one sample shows what is finer than a pixel (bench/minify/README.md).
FIXTURE := $(addprefix $(B)/bench/, fixture.o sheet.o measure.o)
MINIFY := $(addprefix $(B)/bench/, minify/minify.o minify/pixel_filter.o)
$(B)/bench/minify/minify: $(MINIFY) $(FIXTURE) $(INTERNAL)
	@$(CC_LINK) -o $@ $^ $(LIBS)
minify: $(B)/bench/minify/minify
	@REVISION=$(REVISION) $(B)/bench/minify/minify

# How many evaluations a pixel takes, as pictures in bench/results/.
$(B)/bench/iterations/iterations: $(B)/bench/iterations/iterations.o $(FIXTURE) $(INTERNAL)
	@$(CC_LINK) -o $@ $^ $(LIBS)
iterations: $(B)/bench/iterations/iterations
	@REVISION=$(REVISION) $(B)/bench/iterations/iterations

# Every way to trace sequences with maps that invert.
$(B)/bench/inverted/inverted: $(B)/bench/inverted/inverted.o $(FIXTURE) $(INTERNAL)
	@$(CC_LINK) -o $@ $^ $(LIBS)
inverted: $(B)/bench/inverted/inverted
	@REVISION=$(REVISION) $(B)/bench/inverted/inverted

# With and without each method of the enhanced-sphere-tracing paper.
ENHANCED := $(addprefix $(B)/bench/, enhanced/enhanced.o enhanced/convex.o)
$(B)/bench/enhanced/enhanced: $(ENHANCED) $(FIXTURE) $(INTERNAL)
	@$(CC_LINK) -o $@ $^ $(LIBS)
bench-enhanced: $(B)/bench/enhanced/enhanced
	@REVISION=$(REVISION) $(B)/bench/enhanced/enhanced

# How well and how fast normals are found (bench/README.md).
$(B)/bench/normals/normals: $(B)/bench/normals/normals.o $(FIXTURE) $(INTERNAL)
	@$(CC_LINK) -o $@ $^ $(LIBS)
bench-normals: $(B)/bench/normals/normals
	@REVISION=$(REVISION) $(B)/bench/normals/normals

# How long an editor waits for answers of `krs lsp` and of pages.
$(B)/bench/service/service: $(B)/bench/service/service.o $(INTERNAL)
	@$(CC_LINK) -o $@ $^ $(LIBS)
bench-service: $(B)/bench/service/service
	@$(B)/bench/service/service

# How long first pictures take, with empty and with full caches.
bench-starts: $(B)/krs
	@bench/starts.sh $(B)/krs

# How large the package for pages is, and how fast a page follows edits, in Chromium.
bench-web: web
	@node bench/web/web.mjs $(P)

# What textures and patterns cost beside a plain material.
bench-textures: $(B)/krs
	@bench/textures/textures.sh $(B)/krs

# How fast paths of light are followed.
bench-paths: $(B)/krs
	@bench/paths/paths.sh $(B)/krs

# A room by POV-Ray's radiosity and by paths in the same time, where POV-Ray is installed.
bench-radiosity: $(B)/krs
	@bench/radiosity/radiosity.sh $(B)/krs

# Algebraic surfaces: our tracers, POV-Ray and surf where they are installed (bench/README.md).
ALGEBRAIC := $(addprefix bench/algebraic/, algebraic.o estimates.o judge.o processes.o programs.o \
               trees.o julias.o polynomial.o)
$(B)/bench/algebraic/algebraic: $(ALGEBRAIC:%=$(B)/%) $(B)/tests/oracle/oracle.a \
                             $(B)/tests/support/support.a $(INTERNAL)
	@$(CC_LINK) -o $@ $^ $(LIBS) -lcmocka
bench-algebraic: $(B)/bench/algebraic/algebraic $(B)/krs
	@$(B)/bench/algebraic/algebraic $(B)/krs

# What one wants to know of a device first, in ten minutes (bench/README.md).
DEVICES := $(addprefix $(B)/bench/device/, device.o limits.o accuracy.o examples.o methods.o \
             kernels.o)
$(B)/bench/device/device: $(DEVICES) $(FIXTURE) $(B)/tests/support/support.a $(INTERNAL)
	@$(CC_LINK) -o $@ $^ $(LIBS) -lcmocka
CHECKED := $(addprefix tests/, unit/methods unit/schedules oracle/device property/ops \
             oracle/coverage oracle/chords)
check-device: test-deps
	@$(MAKE) --no-print-directory $(B)/krs $(B)/bench/device/device $(CHECKED:%=$(B)/%)
	@B=$(B) KRS_DEVICE="$(DEVICE)" REVISION=$(REVISION) tools/check-device.sh $(CHECKED:%=$(B)/%)

# Registers of each kernel, as a compiler for a graphics card that is not there has them.
$(B)/bench/registers/registers: $(B)/bench/registers/registers.o $(FIXTURE) $(INTERNAL)
	@$(CC_LINK) -o $@ $^ $(LIBS)
bench-registers: $(B)/bench/registers/registers $(B)/krs
	@B=$(B) REVISION=$(REVISION) tools/bench-registers.sh

# How long each pass of the compiler takes for many parts.
$(B)/bench/parts/parts: $(B)/bench/parts/parts.o $(INTERNAL)
	@$(CC_LINK) -o $@ $^ $(LIBS)
bench-parts: $(B)/bench/parts/parts
	@$(B)/bench/parts/parts

# Scenes of many parts, beside POV-Ray (bench/README.md).
bench-large: deps
	@$(MAKE) --no-print-directory $(B)/krs
	@bench/large/large.sh $(B)/krs

# How fast the viewer follows edits, sliders and the camera (bench/README.md).
NUMBER_EDIT := $(B)/bench/view/number_edit.o
TRIAL       := $(B)/bench/view/trial.o
$(B)/bench/view/view: $(B)/bench/view/view.o $(TRIAL) $(NUMBER_EDIT) $(FIXTURE) $(B)/live.a $(INTERNAL)
	@$(CC_LINK) -o $@ $^ $(LIBS)
$(B)/bench/view/first: $(B)/bench/view/first.o $(TRIAL) $(FIXTURE) $(B)/live.a $(INTERNAL)
	@$(CC_LINK) -o $@ $^ $(LIBS)
bench-view: $(B)/bench/view/view $(B)/bench/view/first $(B)/krs
	@REVISION=$(REVISION) bench/view/view.sh $(B) $(SCENES)

# From a saved number to a written picture.
$(B)/bench/edits/edits: $(B)/bench/edits/edits.o $(NUMBER_EDIT) $(FIXTURE) $(B)/live.a $(INTERNAL)
	@$(CC_LINK) -o $@ $^ $(LIBS)
bench-edits: $(B)/bench/edits/edits $(B)/krs
	@REVISION=$(REVISION) bench/edits/edits.sh $(B) $(SCENES)

# How fast distances are evaluated, and meshes made.
$(B)/bench/lanes/lanes: $(B)/bench/lanes/lanes.o $(INTERNAL)
	@$(CC_LINK) -o $@ $^ $(LIBS)
bench-lanes: $(B)/bench/lanes/lanes
	@$(B)/bench/lanes/lanes
# CGAL meshes some surfaces, too, where it is installed.
PEER := $(if $(wildcard /usr/include/CGAL/make_surface_mesh.h),$(B)/bench/mesh/peer)
$(B)/bench/mesh/peer: $(B)/bench/mesh/peer.o
	@$(CXX) $(CFLAGS) -o $@ $^ -lgmp -lmpfr
bench-mesh: $(B)/krs $(PEER) $(MESH_JUDGE)
	@bench/mesh/mesh.sh $(B)/krs $(PEER)
	@bench/mesh/parts.sh $(B)/krs $(MESH_JUDGE)

# For `make test`.
ALONE += tests/bench.sh
test-programs: $(B)/bench/bench
clang-objects: $(BENCH:%.c=$(B)/%.o) $(FIXTURE) $(MINIFY) \
               $(B)/bench/iterations/iterations.o $(B)/bench/inverted/inverted.o \
               $(B)/bench/normals/normals.o $(ALGEBRAIC:%=$(B)/%) $(DEVICES) \
               $(B)/bench/registers/registers.o $(B)/bench/parts/parts.o \
               $(B)/bench/view/view.o $(B)/bench/view/first.o $(TRIAL) $(NUMBER_EDIT) $(B)/bench/edits/edits.o $(ENHANCED)
.PHONY: bench bench-quick minify iterations inverted bench-enhanced bench-normals bench-service bench-textures bench-paths bench-algebraic check-device \
        bench-registers bench-parts bench-large bench-radiosity bench-starts \
        bench-lanes bench-mesh bench-view bench-edits
