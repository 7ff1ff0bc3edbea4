# libraries.mk: how the libraries are found that krs is built on: by pkg-config, and by their usual names
# where it does not know them.  CPPFLAGS, CFLAGS, CXXFLAGS and LDFLAGS are the user's.
#
# It looks when something is first built, and once: `make deps` installs what it looks for.

PKG_CONFIG ?= pkg-config
CXXFLAGS   ?= $(CFLAGS)
OBJCOPY    ?= objcopy

# A variable whose text is found by a function when it is first used.  None of these uses another: make 4.4 finds
# nothing then.
once      = $(eval $(1) := $(call $(2)))$($(1))
# What pkg-config says of modules, each by itself: one that is missing hides no other.
described = $(foreach module,$(2),$(shell $(PKG_CONFIG) --silence-errors $(1) $(module)))
# The options that link a library: its module of pkg-config, and its name.
linked    = $(or $(shell $(PKG_CONFIG) --silence-errors --libs $(1)),-l$(2))
# Those of these names that the compiler finds a library of.
found     = $(foreach name,$(1),$(if $(filter /%,$(foreach end,so a dylib,$(shell $(CC) -print-file-name=lib$(name).$(end)))),-l$(name)))

# Only the part of OpenEXR in C is needed.
core_libs  = $(or $(filter -L% -lOpenEXRCore%,$(shell $(PKG_CONFIG) --silence-errors --libs OpenEXR)),-lOpenEXRCore)
front_libs = $(call linked,harfbuzz,harfbuzz) $(call linked,freetype2,freetype) \
             $(call linked,fontconfig,fontconfig) $(call linked,expat,expat) $(core_libs) \
             $(call linked,libpng,png) $(call linked,qhull_r,qhull_r) -lmeshoptimizer
# glslang consists of other libraries in each of its versions.
glsl_libs  = $(call found,glslang MachineIndependent GenericCodeGen OSDependent OGLCompiler SPIRV \
             SPVRemapper glslang-default-resource-limits SPIRV-Tools-opt SPIRV-Tools)
libs       = $(glsl_libs) $(front_libs) $(call linked,libdeflate,deflate) \
             $(call linked,libxxhash,xxhash) $(call linked,vulkan,vulkan) -lstdc++ -lm -pthread
has_chafa  = $(shell $(PKG_CONFIG) --silence-errors --exists chafa && echo chafa)
window     = $(call described,--libs,$(has_chafa)) $(call linked,imgui,imgui) $(call linked,glfw3,glfw) \
             $(call linked,gl,GL) $(call linked,x11,X11)
mesh_libs  = $(call linked,tinygltf,tinygltf) $(call linked,libzip,zip)
json_libs  = $(call linked,jansson,jansson)
seccomp    = $(call linked,libseccomp,seccomp)
vdb_libs   = $(if $(call found,openvdb),$(call found,openvdb tbb))
# Their warnings are not ours.
headers    = $(patsubst -I%,-isystem %,$(call described,--cflags,$(has_chafa) freetype2 harfbuzz fontconfig \
             expat OpenEXR libpng qhull_r libdeflate libxxhash vulkan glfw3 imgui x11 libzip tinygltf jansson libseccomp))

# What the compiler needs but for glslang, which the fuzzers leave out.
FRONT_LIBS  = $(call once,FRONT_LIBS,front_libs)
LIBS        = $(call once,LIBS,libs)
# The command alone needs it.  Without libchafa `krs view --terminal` says so.
CHAFA       = $(call once,CHAFA,has_chafa)
WINDOW_LIBS = $(call once,WINDOW_LIBS,window)
MESH_LIBS   = $(call once,MESH_LIBS,mesh_libs)
JSON_LIBS   = $(call once,JSON_LIBS,json_libs)
SECCOMP_LIBS = $(call once,SECCOMP_LIBS,seccomp)
# The module for OpenVDB needs it; without the library `krs grid` says so.
VDB_LIBS    = $(call once,VDB_LIBS,vdb_libs)
HEADERS     = $(call once,HEADERS,headers)
