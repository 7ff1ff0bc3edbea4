# tracer.mk: `make kernels`, the runtime's shaders as WGSL in build/kernels, from the same files (web/tracer/README.md).

K       := $(B)/kernels
KERNELS := $(patsubst runtime/shaders/%,$(K)/%.spv,$(wildcard runtime/shaders/*.comp)) \
           $(addprefix $(K)/, trace.comp-PATH_RAYS.spv secondary.comp-PATH_RAYS.spv normals.comp-PATH_RAYS.spv shade.comp-LAYERS.spv \
                              escape.comp-PATH_RAYS.spv background.comp-SKY_MAP.spv)

kernel_words = $(subst -, ,$(1:$(K)/%.spv=%))
define KERNEL_RULE
$(1): runtime/shaders/$(firstword $(kernel_words)) $(SHADERS) $(HELPERS)
	@mkdir -p $$(@D)
	@glslangValidator -V --target-env vulkan1.1 -DNO_TEXELS $(addprefix -D,$(wordlist 2,9,$(kernel_words))) -I. -Iinclude -Iruntime/shaders \
	    -Icompiler/print/glsl -o $$@ $$< >/dev/null
endef
$(foreach kernel,$(KERNELS),$(eval $(call KERNEL_RULE,$(kernel))))

kernels: $(K)/.done
$(K)/.done: web/tracer/kernels.mjs $(KERNELS) $(NPM)/.package-lock
	@echo "wgsl   $(K)"
	@node $< $(NPM)/node_modules $(KERNELS)
	@touch $@
.PHONY: kernels
