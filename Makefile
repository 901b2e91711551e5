# The FMB query service. Two commands for a bare Debian machine:
#
#   make deps demo          installs what building needs, then lets the service answer a scene
#   make deps-test test     installs what the tests need, then runs them
#
# Build:    all (default), examples, install, install-strip, uninstall, clean
# Test:     test (12 minutes), test-fast (one), unit-tests; headers, format, format-check
# Longer:   validate, accuracy, soak, fuzz, fuzz-afl, fuzz-merge (deps-fuzz first)
# Measure:  bench (deps-bench first, for other libraries), bench-bus, bench-replay, bench-mesh,
#           report (deps-report first)
# Rewrite:  logs, goldens: the regression logs, and the results that they are compared with
#
# Variables:
#   MODE=release|debug|asan|fuzz   optimised, for a debugger, with sanitizers, with fuzzers (clang)
#   OPENMP=1                       batches may run on several threads (fmb_batch.threads)
#   INSTRUCTIONS=sse2              leaves out the AVX2 and AVX-512 kernels, which compile slowly
#   PEERS=none                     leaves out other libraries from the benchmarks
#   WERROR=1                       warnings are errors
#   CC, CPPFLAGS, CFLAGS, LDFLAGS, PREFIX, LIBDIR, DESTDIR   as usual

VERSION := 0.1.0
MODE ?= release
OPENMP ?=
INSTRUCTIONS ?=
ifeq ($(origin CC),default)
CC := $(if $(filter fuzz,$(MODE)),clang,gcc)
endif
PREFIX ?= /usr/local
override PREFIX := $(if $(filter /%,$(firstword $(PREFIX))),$(PREFIX),$(shell realpath -m '$(PREFIX)'))
LIBDIR ?= $(PREFIX)/lib
INSTALL ?= install
OBJCOPY ?= objcopy

# The default build lies in build/, others in build/VARIANT. OpenMP changes batch.o and its test
# alone: objects that do not depend on it lie in O, those of unit tests in V.
compiler := $(notdir $(firstword $(CC)))
openmp_flag := $(if $(filter-out 0,$(OPENMP)),-fopenmp)
objects := $(MODE)$(if $(filter-out gcc cc,$(compiler)),-$(compiler))$(INSTRUCTIONS:%=-%)
variant := $(objects)$(openmp_flag:-f%=-%)
B := $(if $(filter release,$(variant)),build,build/$(variant))
O := build/obj/$(objects)
V := build/obj/$(variant)
GEN := build/msgs

.PHONY: all
all: programs

.PHONY: help
help:
	@sed -n '/^#/!q; s/^# \{0,1\}//p' Makefile

# ---- Flags ----

mode_flags_release := -O2 -g1 -DNDEBUG
mode_flags_debug := -O0 -g3
mode_flags_asan := -O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=all \
	-fno-omit-frame-pointer
mode_flags_fuzz := $(mode_flags_asan) -fsanitize=fuzzer-no-link
ifeq ($(mode_flags_$(MODE)),)
$(error MODE is release, debug, asan or fuzz)
endif
ifneq ($(filter-out sse2,$(INSTRUCTIONS)),)
$(error INSTRUCTIONS is sse2 or empty)
endif
mode_link_asan := -fsanitize=address,undefined
mode_link_fuzz := $(mode_link_asan)

# -ffp-contract=off: the same bits on every machine. -fPIC: archives fit into shared objects too;
# without interposition it costs the programs nothing.
flags := -std=c17 -D_POSIX_C_SOURCE=200809L -DFMB_VERSION='"$(VERSION)"' -ffp-contract=off \
	-fPIC -fno-semantic-interposition \
	-Wall -Wextra -Wshadow -Wvla -Wstrict-prototypes -Wmissing-prototypes -Wwrite-strings \
	$(if $(WERROR),-Werror) $(mode_flags_$(MODE)) $(CPPFLAGS) $(CFLAGS)
# Release builds are hardened. The engine is compiled without stack protector and _FORTIFY_SOURCE:
# its loops write into arrays of known size, and every instruction of them counts. A user's own
# _FORTIFY_SOURCE is kept.
hardened_release := -fstack-protector-strong
hardened_link_release := -pie -Wl,-z,relro,-z,now
ifeq ($(findstring _FORTIFY_SOURCE,$(CPPFLAGS) $(CFLAGS)),)
hardened_release += -D_FORTIFY_SOURCE=2
endif
hardened := $(hardened_$(MODE))
$(O)/service/fmb/%.o $(O)/kernels/%.o: hardened :=
compile = $(CC) $(flags) $(hardened) $(whole) -MMD -MP -c $< -o $@
link_user := $(mode_link_$(MODE)) $(hardened_link_$(MODE)) $(openmp_flag) $(CFLAGS) $(LDFLAGS)

# The path of a query, from its bytes to those of its result, is faster by a tenth with -O3, and by
# another tenth where gcc optimises the whole program. Tests and libraries link the same objects
# without that: names in libraries are hidden by objcopy.
link_flags := $(link_user) -fno-lto
link_whole := $(link_flags)
whole := -fno-lto
ifeq ($(MODE),release)
$(O)/service/%.o $(O)/msgs/%.o $(O)/clients/log/%.o $(O)/clients/replay/%.o: flags += -O3
ifneq ($(filter gcc%,$(compiler)),)
link_whole := $(link_user) -flto=auto -O3
$(O)/service/%.o $(O)/msgs/%.o $(O)/clients/log/%.o $(O)/clients/replay/%.o: \
	whole := -flto=auto -ffat-lto-objects
$(O)/service/fmb/%.o: whole := -fno-lto
# Vectors of three doubles that are stored one by one and loaded in pairs would stall.
$(O)/service/fmb/gap/%.o: flags += -fno-tree-slp-vectorize
endif
endif

# ---- Which folder may include from which: a wrong arrow fails to build ----

fmb = service/fmb $(addprefix service/fmb/,$1)
wire := msgs/codec msgs/bus service/common service/fmb
see_service/fmb/number := service/fmb
see_service/fmb/frame := $(call fmb,number)
see_service/fmb/filter := $(call fmb,number frame)
see_service/fmb/article := $(call fmb,number frame)
see_service/fmb/tree := $(call fmb,number frame)
see_service/fmb/exact := $(call fmb,number frame filter)
see_service/fmb/gap := $(call fmb,number frame exact)
see_service/fmb/certificate := $(call fmb,number frame exact)
see_service/fmb/decide := $(call fmb,number frame filter article tree exact gap)
see_msgs/codec := service/fmb $(GEN)
see_service/common := msgs/codec service/fmb
see_service/answer := service/common msgs/codec service/fmb
see_service := service/answer $(wire)
see_clients/lib := $(wire) $(GEN)
see_clients/common := clients/lib service/common service/fmb msgs/bus
see_clients/query := clients/common clients/lib msgs/codec service/common service/fmb
see_clients/log := clients/common clients/lib $(wire)
see_clients/page := clients/log $(see_clients/log)
see_clients/record := clients/log $(see_clients/log)
see_clients/mesh := clients/page clients/common service/common service/fmb
see_clients/replay := clients/page clients/log service/answer $(see_clients/log)
see_clients := $(addprefix clients/,query record mesh replay) $(see_clients/replay)
# The oracle shares no code with the engine, but the pair of frames that both are given.
see_tests/oracle := service/fmb service/fmb/frame
see_tests/campaign := tests/oracle $(call fmb,number frame filter exact decide)
see_tests/bench := tests/campaign tests/oracle $(call fmb,number frame filter article tree exact decide) \
	clients/common
see_tests/bench/peers := tests/bench
see_tests/bus := tests/bench $(see_tests/bench) service $(see_service)
see_tests/robot := tests/bus tests/bench tests/oracle service $(wire)
see_tests/hostile := $(GEN)
see_tests/system := tests/hostile $(GEN)
see_tests/mesh := clients/mesh clients/common tests/bench service/fmb
see_tests/logs := tests/campaign tests/oracle service/answer $(wire) service/fmb/frame $(GEN)
see_tests/soak := clients/lib $(wire)
see_tests/page := clients/page $(see_clients/replay)
see_tests/replay := clients/replay $(see_clients/replay) tests/unit tests/bench
see_tests/fuzz := clients clients/common $(see_clients) tests/unit tests/hostile $(GEN)
see_tests/fuzz/planted := tests/fuzz $(see_tests/fuzz)
see_tests/unit := $(call fmb,number frame filter article tree exact gap decide) service clients \
	$(see_clients) tests/oracle tests/campaign tests/hostile tests/mesh $(GEN)
see_clients/demo :=
see_clients/examples := clients/lib service/fmb

# Evaluated when it is needed: 'make deps' may just have installed GLib.
glib_flags = $(shell pkg-config --cflags glib-2.0)
sees = $(addprefix -I,$(see_$(<D))) \
	$(if $(filter msgs/codec tests/hostile tests/fuzz%,$(<D)),$(glib_flags))
$(O)/%.o: %.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) $(sees)
$(V)/tests/unit/%.o: tests/unit/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) $(sees) $(openmp_flag)

# ---- Objects and archives ----

objects_in = $(patsubst %.c,$(O)/%.o,$(wildcard $(addsuffix /*.c,$1)))

# The filter's kernels: filter/run.c (many pairs) and filter/alone.c (one pair), once for each
# instruction set and job: verdicts, with fused operations; and without, since their bits are
# promised, the second pass, times and boxes. The machine answers where no compiler is there:
# 'make deps' has still to install it.
x86 := $(filter x86_64%,$(shell $(CC) -dumpmachine 2> /dev/null || uname -m))
sets := plain $(if $(x86),sse2 $(if $(INSTRUCTIONS),,avx2 avx512))
alone_sets := $(if $(x86),sse2 $(if $(INSTRUCTIONS),,avx2),plain)
# Where there are others, plain C is there to be compared with: it is not worth what inlining takes.
set_plain := -DLANES=1 $(if $(x86),-DINLINED_NOT -Wno-unknown-warning-option -Wno-maybe-uninitialized)
set_sse2 := -DLANES=2
set_avx2 := -DLANES=4 -mavx2 -mfma
set_avx512 := -DLANES=8 -mavx512f -mavx512dq -mavx512vl -mfma -mprefer-vector-width=512
set_alone_plain := $(set_plain)
set_alone_sse2 := -DLANES=2
set_alone_avx2 := -DLANES=2 -mavx2 -mfma
kernel_of = $(addprefix $(O)/kernels/,$(addsuffix .o,$1))
many_kernels := $(call kernel_of,$(foreach s,$(sets),$s exact_$s times_$s boxes_$s))
alone_kernels_of = $(call kernel_of,$(foreach s,$1,alone_$s exact_alone_$s times_alone_$s))
alone_kernels := $(call alone_kernels_of,$(alone_sets))
kernel_set = $(set_$(subst exact_,,$(subst times_,,$(subst boxes_,,$*))))
kernel_job = $(or $(if $(findstring exact_,$*),-DRUN_EXACT),$(if $(findstring times_,$*),-DRUN_TIMES), \
	$(if $(findstring boxes_,$*),-DRUN_BOXES),-ffp-contract=fast)
$(many_kernels): $(O)/kernels/%.o: service/fmb/filter/run.c $(O)/settings
$(sort $(alone_kernels) $(call alone_kernels_of,plain)): \
	$(O)/kernels/%.o: service/fmb/filter/alone.c $(O)/settings
# gcc 12 does not compile kernels of boxes with sanitizers otherwise (internal compiler error).
ifeq ($(MODE)$(filter gcc%,$(compiler)),asangcc)
$(O)/kernels/%.o: flags += -fno-tree-dominator-opts
endif
$(sort $(many_kernels) $(alone_kernels) $(call alone_kernels_of,plain)): $(O)/kernels/%.o:
	@mkdir -p $(@D)
	$(compile) $(sees) -DRUN_NAME=$* -Wno-psabi $(kernel_set) $(kernel_job)

$(O)/service/fmb/filter/instructions.o: flags += $(if $(INSTRUCTIONS),-DINSTRUCTIONS_MOST=2)
$(O)/service/fmb/decide/batch_openmp.o: service/fmb/decide/batch.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) $(sees) -fopenmp

# The article's comparator, and what is measured beside it: minima and maxima are one instruction
# each where there is no NaN. sat.c says why none is met.
fast_math := service/fmb/article/sat tests/bench/gpr tests/bench/lean_sat tests/bench/seidel
$(fast_math:%=$(O)/%.o): flags += -ffinite-math-only -fno-signed-zeros

engine_folders := $(call fmb,number frame filter article tree exact gap certificate decide)
engine_objects := $(many_kernels) $(alone_kernels) $(filter-out %/run.o %/alone.o \
	$(if $(openmp_flag),%/batch.o),$(call objects_in,$(engine_folders))) \
	$(if $(openmp_flag),$(O)/service/fmb/decide/batch_openmp.o)

message_names := body_t definition_query_t definition_t pair_query_t pair_result_t placement_t \
	scene_query_t scene_result_t status_t
message_files := $(message_names:%=msgs/%.lcm)
message_headers := $(message_names:%=$(GEN)/fmb_msgs_%.h)
message_objects := $(message_names:%=$(O)/msgs/fmb_msgs_%.o)
$(message_headers:.h=.c) $(message_headers) &: $(message_files)
	@mkdir -p $(GEN)
	lcm-gen -c --c-cpath $(GEN) --c-hpath $(GEN) $^
# lcm-gen's own code is not ours to warn about, nor that its decoders copy no bytes to NULL.
$(O)/msgs/%.o: $(GEN)/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) -w -fno-sanitize=nonnull-attribute

page_names := replay mesh
wire_objects := $(call objects_in,$(filter-out service/fmb,$(wire))) $(message_objects)
client_objects := $(call objects_in,clients/lib)
product_objects := $(filter-out %/main.o %/fmb.o,$(wire_objects) $(page_names:%=$(O)/page/%.o) \
	$(call objects_in,service service/answer clients \
		$(addprefix clients/,common query log page record mesh replay)))

# Of unmerged archives the linker takes what a program needs; what stands before them on its command
# line replaces the member of that name. Members of two folders may have one name.
engine := $(O)/engine$(openmp_flag:-f%=-%).a
client := $(O)/client.a
product := $(O)/product.a
$(engine): $(engine_objects)
$(client): $(client_objects)
$(product): $(product_objects)
$(engine) $(client) $(product):
	@rm -f $@
	$(AR) qcs $@ $^

# Libraries: one object that shows the names of the header alone, so that no program's names meet
# ours; and names.o, which both have: a program that links both takes it once.
names := $(O)/service/fmb/names.o
define library
	@mkdir -p $(@D)
	$(CC) -r -nostdlib -fno-lto -o $(@:.a=.o) $(filter-out $(names),$^)
	$(OBJCOPY) --wildcard --keep-global-symbol='$(1)' -R '.gnu.*lto*' $(@:.a=.o)
	rm -f $@
	$(AR) rcs $@ $(@:.a=.o) $(names)
	rm $(@:.a=.o)
endef
$(B)/libfmb.a: $(engine_objects)
	$(call library,fmb_*)
$(B)/libfmb-client.a: $(client_objects) $(wire_objects) $(names)
	$(call library,fmb_client_*)

# The same as shared libraries, with the names of their headers alone.
shared_libraries := $(B)/libfmb.so.0 $(B)/libfmb-client.so.0
$(B)/libfmb.so.0: shared_needs := $(openmp_flag) -lgmp -lm
$(B)/libfmb-client.so.0: shared_needs := -llcm -lglib-2.0 -lm
$(shared_libraries): $(B)/%.so.0: $(B)/%.a
	echo '{ local: fmb_client_raw_*; };' > $@.map
	$(CC) $(filter-out -pie,$(link_flags)) -shared -Wl,-soname,$(@F) -Wl,--version-script,$@.map -o $@ \
		-Wl,--whole-archive $< -Wl,--no-whole-archive $(shared_needs)

# ---- Programs ----

define link
	@mkdir -p $(@D)
	$(CC) $(linking) $(wraps_$(@F)) -o $@ $(filter %.o,$^) \
		-Wl,--start-group $(filter %.a,$^) -Wl,--end-group -Wl,--as-needed $(libraries)
endef
linking = $(link_flags)
libraries := -lcjson -llcm -lglib-2.0 -lseccomp -lgmp -lm

# fmb queries the bus through the library alone.
programs := $(B)/fmbd $(B)/fmb
demo_programs := $(B)/netns $(B)/arm
.PHONY: programs
programs: $(programs) $(B)/libfmb.a $(B)/libfmb-client.a $(shared_libraries) $(demo_programs)
$(programs): linking = $(link_whole)
$(B)/fmbd: $(O)/service/main.o $(product) $(B)/libfmb.a
$(B)/fmb: $(O)/clients/fmb.o $(B)/libfmb-client.a $(product) $(B)/libfmb.a
$(demo_programs): $(B)/%: $(O)/clients/demo/%.o

# Programs of tests and measurements: the name, and the main file in tests/.
test_programs := plain:system/plain poke:system/poke events:system/events poison:system/poison \
	make-page:page/make_page edit-log:replay/edit_log logs/generate:logs/generate logs/tell:logs/tell \
	mesh/make-mesh:mesh/make_mesh $(foreach s,asker memory rate blast fair relay,soak-$s:soak/$s)
measures := validate:campaign/validate accuracy:campaign/accuracy bench/bench:bench/bench \
	bus/bench-bus:bus/bench_bus bus/robot-bus:robot/bus bus/echo:bus/echo robot/robot:robot/robot \
	replay/bench-replay:replay/bench_replay mesh/bench-mesh:mesh/bench_mesh
mains := $(foreach p,$(test_programs) $(measures),$(lastword $(subst :, ,$p)))
$(foreach p,$(test_programs) $(measures),$(eval \
	$(B)/$(firstword $(subst :, ,$p)): $(O)/tests/$(lastword $(subst :, ,$p)).o))
program_names = $(foreach p,$1,$(B)/$(firstword $(subst :, ,$p)))
test_programs := $(call program_names,$(test_programs))
measures := $(call program_names,$(measures)) $(B)/accuracy-planted

# What the programs of tests share. Those that look into the engine link its objects, the others
# the library.
test_folders := $(addprefix tests/,oracle hostile campaign mesh bench bus robot soak logs page)
shared := $(V)/shared.a
$(shared): $(filter-out $(mains:%=$(O)/tests/%.o) %/peers.o,$(call objects_in,$(test_folders))) \
		$(patsubst tests/unit/%.c,$(V)/tests/unit/%.o,$(filter-out %/slab_truth.c %/slab_kernel.c \
			tests/unit/test_%,$(wildcard tests/unit/*.c)))
	@rm -f $@
	$(AR) qcs $@ $^
looks_inside := validate accuracy bench/bench bus/bench-bus
$(looks_inside:%=$(B)/%) $(B)/accuracy-planted: $(shared) $(client) $(product) $(engine)
$(filter-out $(looks_inside:%=$(B)/%),$(test_programs) $(measures)): \
	$(shared) $(client) $(product) $(B)/libfmb.a
$(programs) $(demo_programs) $(test_programs) $(measures):
	$(link)

# ---- Pages: each is one file of text, style and scripts, compiled in as an array ----

# Their policy lets nothing run but what has the hash of all between the tags, line ends included.
template := clients/page/template/
page_shared := $(addprefix $(template),page.html stage.html)
page_styles_replay := $(addprefix $(template),page.css timeline.css)
page_scripts_replay := $(addprefix $(template),numbers.js verdict.js data.js dom.js clock.js timeline.js \
	world.js camera.js canvas.js raster.js picture.js scene.js stage.js play.js input.js window.js panel.js \
	main.js)
page_styles_mesh := $(addprefix $(template),page.css mesh.css)
page_scripts_mesh := $(addprefix $(template),numbers.js verdict.js mesh_data.js dom.js world.js camera.js \
	canvas.js raster.js picture.js mesh_shade.js mesh_stage.js play.js input.js mesh_panel.js mesh_main.js)
page_hash = sha256-$$({ echo; cat $1; } | sha256sum | cut -c 1-64 | tr a-f A-F | \
	basenc --base16 -d | base64)
.SECONDEXPANSION:
$(page_names:%=build/page/%.html): build/page/%.html: $(template)%.html $(page_shared) \
		$$(page_styles_$$*) $$(page_scripts_$$*) Makefile
	@mkdir -p $(@D)
	@! grep -n -e '</' -e '<!--' $(page_scripts_$*) $(page_styles_$*)
	@cat $(page_scripts_$*) > $(@D)/$*.scripts
	@cat $(page_styles_$*) > $(@D)/$*.styles
	sed -e '/^@PAGE@$$/{r $<' -e 'd;}' $(template)page.html | \
		sed -e '/^@STAGE@$$/{r $(template)stage.html' -e 'd;}' | \
		sed -e "s|@SCRIPT_HASH@|$(call page_hash,$(@D)/$*.scripts)|" \
		-e "s|@STYLE_HASH@|$(call page_hash,$(@D)/$*.styles)|" \
		-e '/^@STYLE@$$/{r $(@D)/$*.styles' -e 'd;}' \
		-e '/^@SCRIPT@$$/{r $(@D)/$*.scripts' -e 'd;}' > $@
	@[ "$$(grep -c '@[A-Z_]*@' $@)" = 1 ] # @DATA@

build/page/%.c: build/page/%.html
	@{ echo '#include "page_template.h"'; echo 'static const unsigned char bytes[] = {'; \
		od -An -v -tu1 $< | sed 's/ *\([0-9]\{1,\}\)/\1,/g'; echo '};'; \
		echo 'const struct page_template page_template_$* = {bytes, sizeof bytes};'; } > $@
$(O)/page/%.o: build/page/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -Iclients/page

# ---- Settings: everything is built again when flags or lists of files change ----

settings := $(CC) $(flags) $(hardened) $(filter-out -fopenmp,$(link_flags) $(link_whole)) \
	$(filter-out %/batch.o %/batch_openmp.o,$(engine_objects)) $(product_objects) $(client_objects)
$(O)/settings: Makefile FORCE
	@mkdir -p $(@D)
	@echo '$(subst ','\'',$(settings))' | cmp -s - $@ && [ $@ -nt Makefile ] || \
		echo '$(subst ','\'',$(settings))' > $@
.PHONY: FORCE

# ---- Examples: the message types in other languages, and a client in each ----

E := build/examples
lcm_jar := /usr/share/java/lcm.jar
.PHONY: examples
examples: $(E)/lua/fmb_msgs/init.lua
	@if command -v javac > /dev/null && [ -f $(lcm_jar) ]; then \
		$(MAKE) -s $(E)/java/PosedPair.class; \
	else echo 'make $@: not the one in Java: there is no javac, or no $(lcm_jar)'; fi

# Each begins afresh: a type that is gone would stay.
$(E)/lua/fmb_msgs/init.lua: $(message_files) Makefile
	@rm -rf $(E)/lua
	@mkdir -p $(E)/lua
	lcm-gen -l --lpath $(E)/lua $(message_files)
$(E)/java/PosedPair.class: clients/examples/PosedPair.java tests/system/Largest.java $(message_files) Makefile
	@rm -rf $(E)/java
	@mkdir -p $(E)/java
	lcm-gen -j --jpath $(E)/java $(message_files)
	javac -Xlint:all,-cast,-rawtypes -cp $(lcm_jar):$(E)/java -d $(E)/java $(filter %.java,$^)

# ---- Unit tests ----

unit_names := $(patsubst tests/unit/%.c,%,$(wildcard tests/unit/test_*.c))
unit_tests := $(unit_names:%=$(B)/tests/%)
internal_tests := $(addprefix $(B)/tests/,test_bounds test_box_bounds test_limbs test_outward \
	test_kernels test_placing)
comma := ,
wraps = $(addprefix -Wl$(comma)--wrap=,$1)
wraps_test_engine_work := $(call wraps,$(addprefix __gmp,z_mul z_addmul z_submul z_add z_sub \
	z_fdiv_q z_tdiv_q z_tdiv_qr q_mul q_div q_add q_sub q_canonicalize))
wraps_test_log_read := $(call wraps,pread64)
wraps_test_log_write := $(call wraps,fsync)
wraps_test_log_cut := $(call wraps,page_open page_take)
wraps_test_answer_scene := $(call wraps,malloc calloc realloc aligned_alloc)
wraps_test_bus := $(call wraps,bus_socket_drops sched_yield)

# slabs.c and the kernels of test_bounds are there three times: as they are, with fused operations
# (which a compiler makes only where it optimises), and with a wrong bound. They are optimised and
# without sanitizers in all modes, which have seen the same code elsewhere.
compile_bare = $(subst $(mode_flags_$(MODE)),$(mode_flags_release),$(compile)) $(sees) -DINLINED_NOT \
	-Wno-unknown-warning-option -Wno-maybe-uninitialized -Wno-psabi
renamed = $(foreach name,$2,-D$(name)=$1_$(name))
slabs_fused := -ffp-contract=fast $(if $(x86),-mfma)
slabs_planted := -DSLABS_ROUNDING=0x1p-54
$(O)/slabs/fused.o $(O)/slabs/planted.o: $(O)/slabs/%.o: service/fmb/filter/slabs.c $(O)/settings
	@mkdir -p $(@D)
	$(compile_bare) $(slabs_$*) \
		$(call renamed,$*,slabs_prepare slabs_list slabs_refine slab_inequalities)
$(O)/slabs/kernel.o $(O)/slabs/kernel_fused.o $(O)/slabs/kernel_planted.o: $(O)/slabs/%.o: \
		tests/unit/slab_kernel.c $(O)/settings
	@mkdir -p $(@D)
	$(compile_bare) -DLANES=1 $(slabs_$(*:kernel_%=%)) $(if $(filter kernel_%,$*), \
		$(call renamed,$(*:kernel_%=%),slab_kernel_list slab_kernel_axes slab_kernel_times))

# Kernels of eight lanes in vectors that every machine has; and with a wrong bound.
set_wide := -DLANES=8
wide_kernels := $(call kernel_of,wide exact_wide times_wide boxes_wide)
$(wide_kernels): $(O)/kernels/%.o: service/fmb/filter/run.c $(O)/settings
	@mkdir -p $(@D)
	$(compile_bare) -DRUN_NAME=$* $(kernel_set) $(kernel_job)
$(O)/kernels/wide_planted.o: service/fmb/filter/run.c $(O)/settings
	@mkdir -p $(@D)
	$(compile_bare) -DRUN_NAME=wide_planted $(set_wide) -ffp-contract=fast -DSLABS_ROUNDING=0x1p-58
$(B)/tests/test_kernels: $(wide_kernels) $(O)/kernels/wide_planted.o

# Kernels of boxes with bounds that are a sixteenth of theirs, and with none.
box_kernels := $(call kernel_of,boxes_planted boxes_bare)
box_unit_planted := 0x1p-57
box_unit_bare := 0.0
$(box_kernels): $(O)/kernels/boxes_%.o: service/fmb/filter/run.c $(O)/settings
	@mkdir -p $(@D)
	$(compile_bare) -DLANES=1 -DRUN_BOXES -DRUN_NAME=boxes_$* -DBOX_UNIT=$(box_unit_$*)
$(B)/tests/test_box_bounds: $(box_kernels)

$(internal_tests): $(V)/tests/unit/slab_truth.o $(addprefix $(O)/slabs/,fused.o planted.o kernel.o \
	kernel_fused.o kernel_planted.o) $(shared) $(client) $(product) $(engine)
$(filter-out $(internal_tests),$(unit_tests)): $(shared) $(client) $(product) $(B)/libfmb.a
$(unit_tests): libraries += -lcmocka
$(unit_tests): $(B)/tests/%: $(V)/tests/unit/%.o | $(B)/netns
	$(link)

# ---- Fuzz targets: each a program that replays its corpus and, with MODE=fuzz, a fuzzer ----

fuzz_targets := pair_query pair_result scene_query scene_result definition_query definition status \
	answer scene_json event_log replay_log mesh
replayers := $(if $(filter fuzz,$(MODE)),,$(fuzz_targets:%=$(B)/tests/test_fuzz_%))
fuzzers := $(fuzz_targets:%=$(B)/fuzz_%)
# Each file of planted/ is a copy of one file with one fault, and has the name of the target that
# must find it, followed by a dash and a word where a target has several.
planted_fuzzers := $(patsubst tests/fuzz/planted/%.c,$(B)/planted/%,$(wildcard tests/fuzz/planted/*.c))
# Some targets replace readers of files by pieces in memory.
fuzz_pieces_scene_json := $(O)/tests/fuzz/pieces.o
fuzz_pieces_event_log := $(O)/tests/fuzz/log_pieces.o
fuzz_target = $(firstword $(subst -, ,$1))
fuzz_archives := $(O)/fuzz.a $(shared) $(client) $(product) $(engine)
$(O)/fuzz.a: $(addprefix $(O)/tests/fuzz/,fuzz.o layout.o model.o same.o results_pair.o results_scene.o)
	@rm -f $@
	$(AR) rcs $@ $^
# Comparisons of numbers deep in the engine are not what inputs should be made for.
ifeq ($(MODE),fuzz)
$(engine_objects): flags += -O2 -fno-sanitize-coverage=trace-cmp
endif
$(fuzz_targets:%=$(B)/tests/test_fuzz_%): $(B)/tests/test_fuzz_%: $(O)/tests/fuzz/replay.o \
		$(O)/tests/fuzz/%.o $$(fuzz_pieces_$$*) $(fuzz_archives)
	$(link)
# The compiler links the fuzzer that it brings: libFuzzer, or AFL++'s.
$(fuzzers) $(planted_fuzzers): linking = $(link_flags) -fsanitize=fuzzer
$(fuzzers): $(B)/fuzz_%: $(O)/tests/fuzz/%.o $$(fuzz_pieces_$$*) $(fuzz_archives)
	$(link)
# One fault replaces the pieces of event_log.
$(planted_fuzzers): $(B)/planted/%: $(O)/tests/fuzz/planted/%.o \
		$(O)/tests/fuzz/$$(call fuzz_target,$$*).o $$(filter-out $(fuzz_pieces_event_log), \
			$$(fuzz_pieces_$$(call fuzz_target,$$*))) $(fuzz_archives)
	$(link)
$(B)/fuzz_seeds: $(addprefix $(O)/tests/fuzz/,seeds.o seeds_message.o seeds_service.o seeds_file.o) \
		$(fuzz_archives)
	$(link)

.PHONY: fuzzers fuzz fuzz-afl fuzz-merge
fuzzers: $(fuzzers) $(planted_fuzzers) $(B)/fuzz_seeds
fuzz fuzz-afl fuzz-merge:
	tests/fuzz/fuzz.sh $@

# ---- Programs that take no more of the machine than their name says ----

capped_sets := plain $(if $(x86),sse2 avx2)
capped_most_plain := 1
capped_most_sse2 := 2
capped_most_avx2 := 3
capped_programs := $(foreach p,fmbd fmb generate,$(capped_sets:%=$(B)/capped/$p-%))
$(capped_sets:%=$(O)/capped/%.o): $(O)/capped/%.o: service/fmb/filter/instructions.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) $(sees) -DINSTRUCTIONS_MOST=$(capped_most_$*)
$(B)/capped/libfmb-plain.a: $(call alone_kernels_of,plain)
$(capped_sets:%=$(B)/capped/libfmb-%.a): $(B)/capped/libfmb-%.a: $(O)/capped/%.o \
		$(filter-out %/instructions.o $(call alone_kernels_of,plain),$(engine_objects))
	$(call library,fmb_*)
$(capped_sets:%=$(B)/capped/fmbd-%): $(O)/service/main.o
$(capped_sets:%=$(B)/capped/fmb-%): $(O)/clients/fmb.o $(B)/libfmb-client.a
$(capped_sets:%=$(B)/capped/generate-%): $(O)/tests/logs/generate.o $(shared)
$(capped_programs): $(product) $(B)/capped/libfmb-$$(lastword $$(subst -, ,$$@)).a
	$(link)

# ---- Running the tests ----

.PHONY: tests fast-tests tested-programs unit-tests replay-set test test-fast check
tests: fast-tests examples $(measures)
fast-tests: tested-programs unit-tests $(capped_programs)
tested-programs: programs $(test_programs)
unit-tests: $(unit_tests) $(replayers) $(B)/netns
replay-set: $(B)/fmb $(B)/logs/generate $(filter $(B)/capped/fmb-%,$(capped_programs))

# The script builds what it tests, in the modes that it says.
ifneq ($(filter test check test-fast,$(MAKECMDGOALS)),)
ifneq ($(variant),release)
$(error 'make test' chooses modes and compilers itself: leave out MODE, CC and OPENMP)
endif
endif
test check:
	tests/run.sh
test-fast:
	FMB_FAST=1 tests/run.sh

# ---- Campaigns and trials ----

# accuracy with bounds on rounding that are wrong, which it must find.
campaign_plants := $(addprefix $(O)/planted/,filter/slabs.o gap/gap_distance.o gap/gap_depth.o)
$(campaign_plants): $(O)/planted/%.o: service/fmb/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile_bare) -DSLABS_ROUNDING=0x1p-70 -DGAP_ROUNDING=0x1p-70
$(B)/accuracy-planted: $(O)/tests/campaign/accuracy.o $(campaign_plants)

# validate: some twenty minutes; accuracy: some hours, on two cores.
.PHONY: validate accuracy soak
validate: $(B)/validate
	$<
accuracy: $(B)/accuracy
	$< --json $<.json
# Some ten minutes, a minute for each trial or SECONDS=.
soak: programs $(filter $(B)/soak-% %/poke %/poison,$(test_programs))
	tests/soak/soak.sh $(B) $(SECONDS)

# What the regression set is, made anew: the logs, and the results that they are compared with.
# tests/cli/logs.bats checks that this changes nothing.
.PHONY: logs goldens
logs: $(B)/logs/generate
	for kind in $$($< --list | cut -d ' ' -f 1); do $< $$kind tests/logs/$$kind.log || exit; done
goldens: $(B)/fmb
	for log in tests/logs/*.log; do \
		$< replay --force --write-golden $${log%.log}.golden $$log > /dev/null || \
			[ $$log = tests/logs/foreign.log ] || exit; done

# ---- Benchmarks ----

# Other libraries are measured too where they are installed, unless PEERS=none.
installed = $(if $(PEERS),,$(shell for p in $1; do pkg-config --exists $$p && echo $$p; done 2> /dev/null))
bullet := $(firstword $(call installed,bullet-float64 bullet))
peer_packages := $(call installed,ccd fcl ode box2d) $(bullet)
peer_libraries := $(peer_packages:%-float64=%) \
	$(and $(if $(PEERS),,yes),$(wildcard /usr/include/CGAL/version.h),$(wildcard /usr/include/mpfr.h),cgal)
peers := $(O)/peers/$(or $(subst $() ,_,$(strip $(peer_libraries))),none).o
$(peers): tests/bench/peers.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) $(sees) -DPEER_LIBRARIES='$(patsubst %,X(%),$(peer_libraries))'
peer_flags_bullet = $$(pkg-config --cflags $(bullet))
peer_flags_cgal = -frounding-math # its intervals change the direction of rounding
$(O)/tests/bench/peers/%.o: tests/bench/peers/%.cc $(O)/settings
	@mkdir -p $(@D)
	$(CXX) $(or $(peer_flags_$*),$$(pkg-config --cflags $*)) -std=c++17 -O2 -DNDEBUG -MMD -MP \
		$(sees) -c $< -o $@
# The article's elimination once more, with rows in an order that the benchmark chooses.
$(O)/ordered/eliminate.o: service/fmb/article/eliminate.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) $(sees) -Drows_of_pair=ordered_rows_of_pair -Deliminate_decide=ordered_decide
$(B)/bench/bench: $(peers) $(peer_libraries:%=$(O)/tests/bench/peers/%.o) $(O)/ordered/eliminate.o
$(B)/bench/bench: libraries += $(if $(peer_packages),$$(pkg-config --libs $(peer_packages))) \
	$(if $(peer_libraries),$(if $(filter cgal,$(peer_libraries)),-lmpfr) -lstdc++)

fcl := $(call installed,fcl)
$(B)/robot/robot: $(if $(fcl),$(O)/tests/robot/fcl.o)
$(B)/robot/robot: libraries += $(if $(fcl),$$(pkg-config --libs fcl) -lstdc++)
$(O)/tests/robot/fcl.o: tests/robot/fcl.cc $(O)/settings
	@mkdir -p $(@D)
	$(CXX) $$(pkg-config --cflags fcl) -std=c++17 -O2 -MMD -MP $(sees) -c $< -o $@
$(B)/bus/bench-bus $(B)/bus/robot-bus: | $(B)/bus/echo $(B)/fmbd
$(B)/replay/bench-replay: linking = $(link_whole)

# Minutes each. What bench and bench-bus measured is in report.json then, for 'make report'.
.PHONY: bench bench-bus bench-replay bench-mesh report
bench: $(B)/bench/bench $(B)/robot/robot
	$< --json $(B)/bench/report.json
	$(B)/robot/robot
bench-bus: $(B)/bus/bench-bus $(B)/bus/robot-bus $(B)/netns
	$(B)/netns $< --json $(B)/bus/report.json
	$(B)/netns $(B)/bus/robot-bus

# Some hundred megabytes of logs in build/replay/.
blast_scenes := scenes 400
blast_pairs := pairs 500000
blast_pairs-64-bodies := pairs 500000 --bodies 64
blast_pairs-whole := pairs 500000 --whole
blast_pairs-by-handle := pairs 500000 --by-handle
bench_logs := $(patsubst %,$(B)/replay/%.log,scenes pairs pairs-64-bodies pairs-whole pairs-by-handle)
$(B)/replay/%.log: $(B)/logs/generate
	@mkdir -p $(@D)
	$< --blast $(blast_$*) $@
bench-replay: $(B)/replay/bench-replay $(B)/fmb $(bench_logs)
	$< $(B)/fmb $(bench_logs)

# The article's scene of MESH=bunny.ply, whose coordinates it multiplies by 1000 as the article
# does; or of a mesh that is made, about as large and of as many faces.
$(B)/mesh/bumpy.ply: $(B)/mesh/make-mesh
	$< --faces 70000 --format ply-ascii > $@
bench-mesh: $(B)/mesh/bench-mesh $(B)/fmb $(if $(MESH),,$(B)/mesh/bumpy.ply)
	$< $(B)/fmb $(or $(MESH),$(B)/mesh/bumpy.ply) $(if $(MESH),1000,60)

# One page of what bench, accuracy and bench-bus measured; runs none of them.
report:
	tests/report/report.sh $(B)/bench/report.json $(B)/accuracy.json $(B)/report \
		$(B)/bus/report.json

# ---- Headers and format ----

sources := $(shell find service msgs clients tests -name '*.[ch]')
# Every header compiles alone.
.PHONY: headers format format-check
headers: $(patsubst %,$(O)/%.ok,$(filter-out tests/unit/% tests/robot/%,$(filter %.h,$(sources))))
$(O)/%.h.ok: %.h $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(CC) $(flags) $(sees) -fsyntax-only -x c $<
	@touch $@
format:
	@clang-format -i $(sources)
format-check:
	@clang-format --dry-run -Werror $(sources)

# ---- Demo, installation ----

.PHONY: demo
demo: # builds on all cores, also where packages are installed first
	+$(MAKE) $(if $(filter -j%,$(MAKEFLAGS)),,-j$$(nproc)) all
	clients/demo/run.sh $(B)

sed_text = $(subst |,\|,$(subst &,\&,$(subst \,\\,$1)))
fill_in = sed -e 's|@PREFIX@|$(call sed_text,$(PREFIX))|' -e 's|@LIBDIR@|$(call sed_text,$(LIBDIR))|' \
	-e 's|@VERSION@|$(VERSION)|'
.PHONY: install install-strip uninstall
install: all
	$(INSTALL) -d "$(DESTDIR)$(PREFIX)/bin" "$(DESTDIR)$(LIBDIR)/pkgconfig" \
		"$(DESTDIR)$(PREFIX)/include" "$(DESTDIR)$(PREFIX)/share/fmb/lcmtypes" \
		"$(DESTDIR)$(PREFIX)/share/doc/fmb" "$(DESTDIR)$(PREFIX)/lib/systemd/system"
	$(INSTALL) $(strip_option) $(programs) "$(DESTDIR)$(PREFIX)/bin"
	$(INSTALL) -m 644 $(B)/libfmb.a $(B)/libfmb-client.a "$(DESTDIR)$(LIBDIR)"
	$(INSTALL) $(strip_option) -m 644 $(shared_libraries) "$(DESTDIR)$(LIBDIR)"
	for name in $(basename $(notdir $(shared_libraries))); do \
		ln -sf $$name.0 "$(DESTDIR)$(LIBDIR)/$$name" || exit; done
	$(if $(DESTDIR),,$(if $(filter /usr/lib% /usr/local/lib%,$(LIBDIR)),[ $$(id -u) != 0 ] || ldconfig))
	$(INSTALL) -m 644 service/fmb/fmb.h clients/lib/fmb_client.h "$(DESTDIR)$(PREFIX)/include"
	$(INSTALL) -m 644 $(message_files) "$(DESTDIR)$(PREFIX)/share/fmb/lcmtypes"
	$(INSTALL) -m 644 LICENSE "$(DESTDIR)$(PREFIX)/share/doc/fmb"
	$(fill_in) $(if $(openmp_flag),-e 's|^Libs.private:.*|& $(openmp_flag)|') service/fmb/fmb.pc.in \
		> "$(DESTDIR)$(LIBDIR)/pkgconfig/fmb.pc"
	$(fill_in) clients/lib/fmb-client.pc.in > "$(DESTDIR)$(LIBDIR)/pkgconfig/fmb-client.pc"
	$(subst %,%%,$(fill_in)) service/fmbd.service.in > "$(DESTDIR)$(PREFIX)/lib/systemd/system/fmbd.service"

install-strip: strip_option := -s
install-strip: install

uninstall:
	cd "$(DESTDIR)$(PREFIX)" && rm -rf bin/fmbd bin/fmb include/fmb.h include/fmb_client.h \
		share/fmb share/doc/fmb lib/systemd/system/fmbd.service
	cd "$(DESTDIR)$(LIBDIR)" && rm -f libfmb.a libfmb-client.a \
		libfmb.so libfmb.so.0 libfmb-client.so libfmb-client.so.0 pkgconfig/fmb.pc \
		pkgconfig/fmb-client.pc

.PHONY: clean
clean:
	rm -rf build

# ---- Packages ----

packages_deps := gcc libc6-dev liblcm-dev liblcm-bin libcjson-dev libgmp-dev libglib2.0-dev \
	libseccomp-dev pkg-config uthash-dev
packages_deps-test := $(packages_deps) libcmocka-dev bats jq clang clang-format libclang-rt-14-dev \
	liblcm-java default-jdk-headless liblcm-lua lua5.2 chromium libxml2-utils
packages_deps-fuzz := $(packages_deps) clang libclang-rt-14-dev llvm afl++
packages_deps-bench := libccd-dev libfcl-dev libbullet-dev libode-dev libbox2d-dev libcgal-dev \
	libmpfr-dev pkg-config
packages_deps-report := jq
deps := deps deps-test deps-fuzz deps-bench deps-report

as_root = $$([ $$(id -u) = 0 ] || echo sudo)
.PHONY: $(deps)
$(deps):
	@command -v apt-get > /dev/null || { \
		echo 'make $@: no apt-get here; install what these Debian packages hold:' >&2; \
		echo '  $(packages_$@)' >&2; exit 1; }
	@missing=$$(for package in $(packages_$@); do \
		dpkg-query -W -f '$${db:Status-Abbrev}' $$package 2> /dev/null | grep -q '^ii' \
			|| echo $$package; done); \
	[ -z "$$missing" ] || { $(as_root) apt-get update -q && \
		$(as_root) env DEBIAN_FRONTEND=noninteractive \
			apt-get install -q -y --no-install-recommends $$missing; }

# In 'make deps demo' the packages come first, and in 'make clean all' the cleaning, whatever
# -j says.
ifneq ($(filter $(deps) clean,$(MAKECMDGOALS)),)
.NOTPARALLEL:
endif

.DELETE_ON_ERROR:
.SECONDARY:
-include $(shell find $(O) $(V) -name '*.d' 2> /dev/null)
