# make            build/krs, build/libkrs.a
# make demo       set up, build, render the highlights of the examples to build/demo/
# make test       set up, build, run every test; the last line is `N passed, N failed`
# make lint       shaders by themselves, shell scripts, formatting of nothing else
# make fuzz       the front end under libFuzzer for FUZZ_SECONDS
# make deps       install what is missing (Debian packages)

B ?= build

# Sources in the order of the pipeline: reading down this list is reading the program.
BASE     := $(wildcard compiler/base/*.c)
FRONT    := $(wildcard compiler/front/*.c)
GRAPH    := $(wildcard compiler/graph/*.c)
GEOMETRY := $(wildcard compiler/geometry/*.c)
SHADER   := compiler/shader/emit.c compiler/shader/spirv.c
COMPILER := $(BASE) $(FRONT) $(GRAPH) $(GEOMETRY) $(SHADER) compiler/compile.c compiler/query.c
GLSLANG  := compiler/shader/glslang_border.cpp
RUNTIME  := $(wildcard runtime/device/*.c runtime/tracer/*.c runtime/film/*.c runtime/writer/*.c)
CLI      := $(wildcard cli/*.c)

# Text files that the program carries: the standard library and the kernels.
LIBRARY  := $(sort $(wildcard compiler/library/*.krs compiler/library/std/*.krs))
SHADERS  := $(sort $(wildcard runtime/shaders/*.comp runtime/shaders/*.glsl))

CFLAGS   ?= -g -O2
STYLE    := -std=c17 -D_GNU_SOURCE -Wall -Wextra -Wpedantic -Wshadow -Werror -I. -MMD -MP
COMPILE   = $(CC) $(STYLE) -pthread $(CFLAGS)
OPENEXR  := -lOpenEXRCore-3_1
LIBS     := -lglslang -lMachineIndependent -lGenericCodeGen -lOSDependent -lOGLCompiler -lSPIRV \
            -lSPVRemapper -lglslang-default-resource-limits -lSPIRV-Tools-opt -lSPIRV-Tools \
            $(OPENEXR) -lpng -lvulkan -lstdc++ -lm -pthread

OBJECTS_COMPILER := $(COMPILER:%.c=$(B)/%.o) $(GLSLANG:%.cpp=$(B)/%.o) $(B)/library_files.o
OBJECTS_RUNTIME  := $(RUNTIME:%.c=$(B)/%.o) $(B)/shader_files.o
OBJECTS_CLI      := $(CLI:%.c=$(B)/%.o)

all: $(B)/krs
$(B)/krs: $(OBJECTS_CLI) $(B)/libkrs.a
	$(COMPILE) -o $@ $^ $(LIBS)
$(B)/libkrs.a: $(OBJECTS_COMPILER) $(OBJECTS_RUNTIME)
	rm -f $@
	$(AR) rcs $@ $^
$(B)/%.o: %.c
	@mkdir -p $(@D)
	$(COMPILE) -c -o $@ $<
$(B)/%.o: %.cpp
	@mkdir -p $(@D)
	$(CXX) -std=c++17 -Wall -Wextra -I. -I/usr/include/glslang -MMD -MP $(CFLAGS) -c -o $@ $<
$(B)/%.o: $(B)/%.c
	$(COMPILE) -c -o $@ $<

$(B)/library_files.c: $(B)/embed $(LIBRARY)
	$(B)/embed library_files compiler/library/ $(LIBRARY) >$@
$(B)/shader_files.c: $(B)/embed $(SHADERS)
	$(B)/embed shader_files runtime/shaders/ $(SHADERS) >$@
$(B)/embed: compiler/base/embed/embed.c
	@mkdir -p $(@D)
	$(COMPILE) -o $@ $<
