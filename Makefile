# The FMB query service. Two commands for a bare Debian machine:
#
#   make deps demo          installs what building needs, then lets the service answer a scene
#   make deps-test test     installs what the tests need, then runs them
#
# Others: all, examples, tests (builds them), test-fast, validate, accuracy, soak, fuzz, fuzz-afl,
# fuzz-merge, bench, bench-bus, bench-replay, report, logs, goldens, headers, format,
# format-check, install, install-strip, uninstall, clean; deps-fuzz, deps-bench and deps-report
# install what is only good for these.
# MODE=release|debug|asan|fuzz. OPENMP=1: batches may be spread over threads (fmb_batch.threads).
# INSTRUCTIONS=sse2: without the kernels of newer ones, which take long to compile.
# CC, CPPFLAGS, CFLAGS, LDFLAGS, PREFIX, LIBDIR and DESTDIR are the user's.

VERSION := 0.1.0
MODE ?= release
OPENMP ?=
INSTRUCTIONS ?=
ifeq ($(origin CC),default)
CC := $(if $(filter fuzz,$(MODE)),clang,gcc)
endif
CFLAGS ?=
CPPFLAGS ?=
LDFLAGS ?=
PREFIX ?= /usr/local
override PREFIX := $(if $(filter /%,$(firstword $(PREFIX))),$(PREFIX),$(CURDIR)/$(PREFIX))
LIBDIR ?= $(PREFIX)/lib
DESTDIR ?=
INSTALL ?= install
OBJCOPY ?= objcopy

# What the default mode builds lies in build/, what another mode or compiler does beside it. OpenMP
# changes batch.o and its test alone: objects lie in O with and without it, those of unit tests in V.
compiler := $(notdir $(firstword $(CC)))
openmp_flag := $(if $(filter-out 0,$(OPENMP)),-fopenmp)
objects := $(MODE)$(if $(filter-out gcc cc,$(compiler)),-$(compiler))$(INSTRUCTIONS:%=-%)
variant := $(objects)$(openmp_flag:-f%=-%)
B := $(if $(filter release,$(variant)),build,build/$(variant))
O := build/obj/$(objects)
V := build/obj/$(variant)
GEN := build/msgs

mode_flags_release := -O2 -g1 -DNDEBUG
mode_flags_debug := -O0 -g3
mode_flags_asan := -O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=all \
	-fno-omit-frame-pointer
mode_flags_fuzz := $(mode_flags_asan) -fsanitize=fuzzer-no-link
ifeq ($(mode_flags_$(MODE)),)
$(error MODE is release, debug, asan or fuzz)
endif
mode_link_asan := -fsanitize=address,undefined
mode_link_fuzz := $(mode_link_asan)

# -ffp-contract=off: the same bits on every machine.
flags := -std=c17 -D_POSIX_C_SOURCE=200809L -DFMB_VERSION='"$(VERSION)"' -ffp-contract=off \
	-Wall -Wextra -Wshadow -Wvla -Wstrict-prototypes -Wmissing-prototypes -Wwrite-strings \
	$(if $(WERROR),-Werror) $(mode_flags_$(MODE)) $(CPPFLAGS) $(CFLAGS)
# Release builds are hardened. The engine is not: its loops write into arrays whose sizes the
# compiler sees, and every instruction of them counts. A user who sets _FORTIFY_SOURCE keeps it.
hardened_release := -fstack-protector-strong -fPIE
hardened_link_release := -pie -Wl,-z,relro,-z,now
ifeq ($(findstring _FORTIFY_SOURCE,$(CPPFLAGS) $(CFLAGS)),)
hardened_release += -D_FORTIFY_SOURCE=2
endif
hardened := $(hardened_$(MODE))
$(O)/service/fmb/%.o $(O)/run/%.o: hardened := -fPIE
compile = $(CC) $(flags) $(hardened) $(whole) -MMD -MP -c $< -o $@
link_user := $(mode_link_$(MODE)) $(hardened_link_$(MODE)) $(openmp_flag) $(CFLAGS) $(LDFLAGS)

# What each query goes through, from its bytes to those of its result: faster by a tenth with -O3, and
# by another where the compiler, if it is gcc, sees all of a program. Tests, and the libraries, whose
# names are hidden by objcopy, are linked from what it saw of files.
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
# Vectors of three doubles that are written one by one and read as pairs wait for the writes.
$(O)/service/fmb/gap%.o: flags += -fno-tree-slp-vectorize
endif
endif

# ---- The parts, and who may see whom: an arrow in the wrong direction fails to build ----

# run.c is there four times for each instruction set: for verdicts, with fused operations where there
# are any; for the second pass, for times and for boxes, whose bits are promised; alone.c likewise, for
# pairs alone.
# Asked before 'make deps' has installed the compiler, it is the machine that answers.
x86 := $(filter x86_64%,$(shell $(CC) -dumpmachine 2> /dev/null || uname -m))
run_flags_plain := -DLANES=1
run_flags_sse2 := -DLANES=2
run_flags_avx2 := -DLANES=4 -mavx2 -mfma
run_flags_avx512 := -DLANES=8 -mavx512f -mavx512dq -mavx512vl -mfma -mprefer-vector-width=512
run_alone_plain := -DLANES=1
run_alone_sse2 := -DLANES=2
run_alone_avx2 := -DLANES=2 -mavx2 -mfma
run_sets := plain $(if $(x86),sse2 $(if $(INSTRUCTIONS),,avx2 avx512))
run_alone_sets := $(if $(x86),sse2 $(if $(INSTRUCTIONS),,avx2),plain)
run_verdicts := $(run_sets:%=$(O)/run/%.o)
run_exact := $(run_sets:%=$(O)/run/exact_%.o)
run_times := $(run_sets:%=$(O)/run/times_%.o)
run_boxes := $(run_sets:%=$(O)/run/boxes_%.o)
# What other machines take for pairs alone, for the programs of tests that take nothing else.
alone_plain := $(addprefix $(O)/run/,alone_plain.o exact_alone_plain.o times_alone_plain.o)
alone_verdicts := $(run_alone_sets:%=$(O)/run/alone_%.o)
alone_exact := $(run_alone_sets:%=$(O)/run/exact_alone_%.o)
alone_times := $(run_alone_sets:%=$(O)/run/times_alone_%.o)
run_objects := $(run_verdicts) $(run_exact) $(run_times) $(run_boxes) $(alone_verdicts) \
	$(alone_exact) $(alone_times)
lib_objects := $(patsubst %.c,$(O)/%.o,$(filter-out %/run.c %/alone.c,$(wildcard service/fmb/*.c))) \
	$(run_objects)
lib_objects := $(lib_objects:%/batch.o=%/batch$(openmp_flag:-f%=_%).o)
message_names := body_t definition_query_t definition_t pair_query_t pair_result_t placement_t \
	scene_query_t scene_result_t status_t
message_objects := $(message_names:%=$(O)/msgs/fmb_msgs_%.o)
message_headers := $(message_names:%=$(GEN)/fmb_msgs_%.h)
codec_objects := $(patsubst %.c,$(O)/%.o,$(wildcard msgs/codec/*.c))
receiver_objects := $(patsubst %.c,$(O)/%.o,$(wildcard msgs/bus/*.c))
wire_objects := $(codec_objects) $(receiver_objects) $(addprefix $(O)/service/,clock.o random_id.o)
bus_objects := $(wire_objects) $(addprefix $(O)/service/,say.o signals.o)
answer_objects := $(addprefix $(O)/service/,answerer.o answer_pair.o answer_scene.o \
	answer_definition.o check.o cache.o body.o runs.o histogram.o)
server_objects := $(answer_objects) $(addprefix $(O)/service/,server.o queue.o turns.o expect.o \
	jobs.o meter.o malformed.o)
page_names := replay mesh
client_objects := $(patsubst %.c,$(O)/%.o,$(filter-out clients/fmb.c,$(wildcard clients/*.c \
	clients/log/*.c clients/mesh/*.c clients/page/*.c clients/record/*.c clients/replay/*.c))) \
	$(page_names:%=$(O)/page/%.o)
asking_objects := $(patsubst %.c,$(O)/%.o,$(wildcard clients/lib/*.c))

programs := $(B)/fmbd $(B)/fmb
capped_sets := plain $(if $(x86),sse2 avx2)
capped_programs := $(foreach p,fmbd fmb generate,$(capped_sets:%=$(B)/capped/$p-%))
demo_programs := $(B)/netns $(B)/arm
# Beside the programs in tests of them; and those that measure.
helpers := $(addprefix $(B)/,plain poke poison soak-asker soak-memory soak-rate soak-blast soak-fair \
	soak-relay logs/generate logs/tell mesh/make-mesh edit-log events)
measures := $(addprefix $(B)/,validate accuracy accuracy-planted bench/bench bus/bench-bus bus/echo \
	replay/bench-replay mesh/bench-mesh make-page)

.PHONY: all
all: $(programs) $(B)/libfmb.a $(B)/libfmb-client.a $(demo_programs)

# One object that shows the names of the header alone, so that no program's own names meet ours; and
# names.o, which is the same in both libraries: who links them both takes it once.
names := $(O)/service/fmb/names.o
define archive
	@mkdir -p $(@D)
	$(CC) -r -nostdlib -fno-lto -o $(@:.a=.o) $(filter-out $(names),$^)
	$(OBJCOPY) --wildcard --keep-global-symbol='$(1)' -R '.gnu.*lto*' $(@:.a=.o)
	rm -f $@
	$(AR) rcs $@ $(@:.a=.o) $(names)
	rm $(@:.a=.o)
endef

$(B)/libfmb.a: $(lib_objects)
	$(call archive,fmb_*)

$(B)/libfmb-client.a: $(asking_objects) $(wire_objects) $(message_objects) $(names)
	$(call archive,fmb_client_*)

fmbd_objects := $(addprefix $(O)/service/,main.o daemon.o confine.o notify.o) $(server_objects) \
	$(bus_objects) $(message_objects)
fmbd_libraries := -llcm -lglib-2.0 -lseccomp -lgmp -lm
$(B)/fmbd: $(fmbd_objects) $(B)/libfmb.a
	$(CC) $(link_whole) -o $@ $^ $(fmbd_libraries)

# It asks the bus through the library alone; logs it reads, answers and plays itself.
fmb_objects := $(O)/clients/fmb.o $(client_objects) $(answer_objects) $(bus_objects) \
	$(message_objects)
$(B)/fmb: $(fmb_objects) $(B)/libfmb-client.a $(B)/libfmb.a
	$(CC) $(link_whole) -o $@ $^ -lcjson -llcm -lglib-2.0 -lgmp -lm

$(B)/arm: $(O)/clients/demo/arm.o
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -lm

$(B)/netns: $(O)/clients/demo/netns.o
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^

ifneq ($(INSTRUCTIONS),)
$(if $(filter-out sse2,$(INSTRUCTIONS)),$(error INSTRUCTIONS is sse2 or empty))
$(O)/service/fmb/instructions.o: flags += -DINSTRUCTIONS_MOST=2
endif

# The engine sees nothing but itself, GMP and libc.
$(O)/service/fmb/%.o: service/fmb/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile)

$(O)/service/fmb/batch_openmp.o: service/fmb/batch.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -fopenmp

compile_run = @mkdir -p $(@D) && \
	$(compile) -DRUN_NAME=$(basename $(@F)) -Wno-psabi
$(run_verdicts): $(O)/run/%.o: service/fmb/run.c $(O)/settings
	$(compile_run) $(run_flags_$*) -ffp-contract=fast
$(run_exact): $(O)/run/exact_%.o: service/fmb/run.c $(O)/settings
	$(compile_run) $(run_flags_$*) -DRUN_EXACT
$(run_times): $(O)/run/times_%.o: service/fmb/run.c $(O)/settings
	$(compile_run) $(run_flags_$*) -DRUN_TIMES
$(run_boxes): $(O)/run/boxes_%.o: service/fmb/run.c $(O)/settings
	$(compile_run) $(run_flags_$*) -DRUN_BOXES
$(sort $(alone_verdicts) $(O)/run/alone_plain.o): $(O)/run/alone_%.o: service/fmb/alone.c $(O)/settings
	$(compile_run) $(run_alone_$*) -DRUN_ALONE -ffp-contract=fast
$(sort $(alone_exact) $(O)/run/exact_alone_plain.o): $(O)/run/exact_alone_%.o: service/fmb/alone.c $(O)/settings
	$(compile_run) $(run_alone_$*) -DRUN_ALONE -DRUN_EXACT
$(sort $(alone_times) $(O)/run/times_alone_plain.o): $(O)/run/times_alone_%.o: service/fmb/alone.c $(O)/settings
	$(compile_run) $(run_alone_$*) -DRUN_ALONE -DRUN_TIMES

# The wire: bytes <-> structs.
glib_flags = $(shell pkg-config --cflags glib-2.0)
codec_see := -Imsgs/codec -Iservice/fmb
$(O)/msgs/codec/%.o: msgs/codec/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) $(codec_see) -I$(GEN) $(glib_flags)

$(O)/service/%.o: service/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) -Iservice $(codec_see) -Imsgs/bus -I$(GEN)

$(O)/msgs/bus/%.o: msgs/bus/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -Imsgs/bus

clients_see := -Iclients $(addprefix -Iclients/,lib log mesh page record replay) -Iservice \
	-Imsgs/codec -Imsgs/bus -Iservice/fmb

$(O)/clients/lib/%.o: clients/lib/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) -Iclients/lib -Iservice -Imsgs/codec -Imsgs/bus -Iservice/fmb -I$(GEN)

$(O)/clients/%.o: clients/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) $(clients_see)

$(O)/tests/system/%.o: tests/system/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -Itests/hostile

# The pages without their data: text, style and scripts of each in one, and then numbers of C. Their
# policy lets nothing run but what has the hash of all between the tags, line ends included.
page_source := clients/page/template/
page_shared := $(addprefix $(page_source),page.html stage.html)
page_styles_replay := $(addprefix $(page_source),page.css timeline.css)
page_scripts_replay := $(addprefix $(page_source),numbers.js verdict.js data.js dom.js clock.js timeline.js \
	world.js camera.js canvas.js raster.js picture.js scene.js stage.js play.js hands.js window.js panel.js \
	main.js)
page_styles_mesh := $(addprefix $(page_source),page.css mesh.css)
page_scripts_mesh := $(addprefix $(page_source),numbers.js verdict.js mesh_data.js dom.js world.js camera.js \
	canvas.js raster.js picture.js mesh_shade.js mesh_stage.js play.js hands.js mesh_panel.js mesh_main.js)
page_hash = sha256-$$({ echo; cat $1; } | sha256sum | cut -c 1-64 | tr a-f A-F | \
	basenc --base16 -d | base64)
define page_rule
build/page/$1.html: $$(page_source)$1.html $$(page_shared) $$(page_styles_$1) $$(page_scripts_$1) Makefile
	@mkdir -p $$(@D)
	@! grep -n -e '</' -e '<!--' $$(page_scripts_$1) $$(page_styles_$1)
	@cat $$(page_scripts_$1) > $$(@D)/$1.scripts
	@cat $$(page_styles_$1) > $$(@D)/$1.styles
	sed -e '/^@PAGE@$$$$/{r $$<' -e 'd;}' $$(page_source)page.html | \
		sed -e '/^@STAGE@$$$$/{r $$(page_source)stage.html' -e 'd;}' | \
		sed -e "s|@SCRIPT_HASH@|$$(call page_hash,$$(@D)/$1.scripts)|" \
		-e "s|@STYLE_HASH@|$$(call page_hash,$$(@D)/$1.styles)|" \
		-e '/^@STYLE@$$$$/{r $$(@D)/$1.styles' -e 'd;}' \
		-e '/^@SCRIPT@$$$$/{r $$(@D)/$1.scripts' -e 'd;}' > $$@
	@[ "$$$$(grep -c '@[A-Z_]*@' $$@)" = 1 ] # @DATA@
endef
$(foreach name,$(page_names),$(eval $(call page_rule,$(name))))

build/page/%.c: build/page/%.html
	@{ echo '#include "page_template.h"'; echo 'static const unsigned char bytes[] = {'; \
		od -An -v -tu1 $< | sed 's/ *\([0-9]\{1,\}\)/\1,/g'; echo '};'; \
		echo 'const struct page_template page_template_$* = {bytes, sizeof bytes};'; } > $@

$(O)/page/%.o: build/page/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -Iclients/page

# lcm-gen's own code is not ours to warn about, nor that its decoders copy no bytes to NULL.
$(O)/msgs/%.o: $(GEN)/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) -w -fno-sanitize=nonnull-attribute

$(foreach m,$(message_names),$(GEN)/fmb_msgs_$(m).c $(GEN)/fmb_msgs_$(m).h) &: \
		$(message_names:%=msgs/%.lcm)
	@mkdir -p $(GEN)
	lcm-gen -c --c-cpath $(GEN) --c-hpath $(GEN) $^

# Changes when the flags or the lists of files do, and then everything is built again.
settings := $(CC) $(flags) $(hardened) $(filter-out -fopenmp,$(link_flags) $(link_whole)) \
	$(lib_objects:%_openmp.o=%.o) $(client_objects) $(asking_objects)
$(O)/settings: Makefile FORCE
	@mkdir -p $(@D)
	@echo '$(subst ','\'',$(settings))' | cmp -s - $@ && [ $@ -nt Makefile ] || \
		echo '$(subst ','\'',$(settings))' > $@
.PHONY: FORCE

# ---- Examples -------------------------------------------------------------------------------

# One client for each language, and the message types in it; the same in all modes. Whether there
# is a Java compiler is asked when it is needed: 'make deps-test examples' has just installed one.
E := build/examples
message_files := $(message_names:%=msgs/%.lcm)
lcm_jar := /usr/share/java/lcm.jar

.PHONY: examples
examples: $(E)/lua/fmb_msgs/init.lua
	@if command -v javac > /dev/null && [ -f $(lcm_jar) ]; then \
		$(MAKE) -s $(E)/java/PosedPair.class; \
	else echo 'make $@: not the one in Java: there is no javac, or no $(lcm_jar)'; fi

# A type that is gone would stay: each begins afresh.
$(E)/lua/fmb_msgs/init.lua: $(message_files) Makefile
	@rm -rf $(E)/lua
	@mkdir -p $(E)/lua
	lcm-gen -l --lpath $(E)/lua $(message_files)

$(E)/java/PosedPair.class: clients/examples/PosedPair.java tests/system/Largest.java $(message_files) Makefile
	@rm -rf $(E)/java
	@mkdir -p $(E)/java
	lcm-gen -j --jpath $(E)/java $(message_files)
	javac -Xlint:all,-cast,-rawtypes -cp $(lcm_jar):$(E)/java -d $(E)/java $(filter %.java,$^)

# ---- Tests ----------------------------------------------------------------------------------

unit_names := $(patsubst tests/unit/%.c,%,$(wildcard tests/unit/test_*.c))
unit_tests := $(unit_names:%=$(B)/tests/%)
hostile_objects := $(O)/tests/hostile/hostile.o
oracle_objects := $(patsubst %.c,$(O)/%.o,$(wildcard tests/oracle/*.c))
engine_tests := $(filter test_engine_% test_frame test_oracle test_integer,$(unit_names))
# Those that see inside of it.
internal_tests := test_bounds test_limbs test_outward test_kernels test_placing
# Those that draw from the hard families of the campaigns.
family_tests := test_kernels test_engine_batch test_engine_gap test_engine_tree
# Those of what answers queries; they see no bus and no clients.
answer_tests := $(filter test_answer_%,$(unit_names)) test_cache test_runs test_answer
comma := ,
family_objects := $(V)/tests/unit/pair_draw.o $(addprefix $(O)/tests/campaign/,cell.o contact.o \
	family.o meet.o meeting.o odd.o scene.o solids.o)

# What tests share, and what they test of the service and of clients: archives, of which the linker
# takes what a test needs. The engine is the library, or what lies in it.
shared := $(V)/shared.a
$(shared): $(patsubst tests/unit/%.c,$(V)/tests/unit/%.o,$(filter-out %/slab_truth.c %/slab_kernel.c,\
		$(filter-out tests/unit/test_%,$(wildcard tests/unit/*.c)))) $(family_objects) \
		$(O)/tests/campaign/climb.o $(oracle_objects) $(hostile_objects) \
		$(addprefix $(O)/tests/mesh/,bumpy.o formats.o)
product := $(O)/product.a
$(product): $(server_objects) $(client_objects) $(asking_objects) $(bus_objects) $(message_objects)
$(sort $(shared) $(product)):
	@rm -f $@
	$(AR) rcs $@ $(sort $^)

# A client over plain LCM: it shares nothing with ours but the message types.
$(B)/plain: $(O)/tests/system/plain.o $(message_objects)
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -llcm

$(O)/tests/system/plain.o: tests/system/plain.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) -I$(GEN)

$(B)/poke: $(O)/tests/system/poke.o $(hostile_objects) $(message_objects)
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -llcm -lglib-2.0

$(B)/events: $(O)/tests/system/events.o
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -llcm -lglib-2.0

$(B)/poison: $(O)/tests/system/poison.o
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^

$(B)/make-page: $(O)/tests/page/make_page.o $(O)/tests/page/sample_log.o $(client_objects) $(asking_objects) \
		$(answer_objects) $(bus_objects) $(message_objects) $(B)/libfmb.a
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -lcjson -llcm -lglib-2.0 -lgmp -lm

$(O)/tests/page/%.o: tests/page/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) $(clients_see)

$(B)/edit-log: $(O)/tests/replay/edit_log.o $(V)/tests/unit/log_draft.o $(client_objects) \
		$(answer_objects) $(bus_objects) $(message_objects) \
		$(asking_objects) $(B)/libfmb.a
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -lcjson -llcm -lglib-2.0 -lgmp -lm

# Tests of the engine link neither LCM nor the service.
$(engine_tests:%=$(B)/tests/%): $(B)/tests/%: $(V)/tests/unit/%.o $(shared) $(B)/libfmb.a
	@mkdir -p $(@D)
	$(CC) $(link_flags) $(wraps_$*) -o $@ $^ -lcmocka -lgmp -lm

# slabs.c is there three times: as it is, with fused operations (which a compiler makes only where
# it optimises), with a bound that is wrong. So is what the kernels make of a pair.
slab_objects := $(V)/tests/unit/slab_truth.o $(addprefix $(O)/slabs/,fused.o planted.o kernel.o \
	kernel_fused.o kernel_planted.o)

$(internal_tests:%=$(B)/tests/%): $(B)/tests/%: $(V)/tests/unit/%.o $(slab_objects) \
		$(shared) $(lib_objects)
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -lcmocka -lgmp -lm

slabs_names := slabs_prepare slabs_list slabs_refine slab_inequalities
slabs_fused := -ffp-contract=fast $(if $(x86),-mfma)
slabs_planted := -DSLABS_ROUNDING=0x1p-54
# Optimised, and without sanitizers, whatever the mode: they would take long for what another object
# of theirs has seen. What is not inlined is not seen to be initialised.
compile_bare = $(subst $(mode_flags_$(MODE)),$(mode_flags_release),$(compile)) -DINLINED_NOT \
	-Wno-unknown-warning-option -Wno-maybe-uninitialized -Wno-psabi
$(O)/slabs/fused.o $(O)/slabs/planted.o: $(O)/slabs/%.o: service/fmb/slabs.c $(O)/settings
	@mkdir -p $(@D)
	$(compile_bare) $(slabs_$*) $(foreach f,$(slabs_names),-D$f=$*_$f)

$(O)/slabs/kernel.o $(O)/slabs/kernel_fused.o $(O)/slabs/kernel_planted.o: $(O)/slabs/%.o: \
		tests/unit/slab_kernel.c $(O)/settings
	@mkdir -p $(@D)
	$(compile_bare) -Iservice/fmb -DLANES=1 $(slabs_$(*:kernel_%=%)) \
		$(if $(filter kernel_%,$*),$(foreach f,slab_kernel_list slab_kernel_axes slab_kernel_times,-D$f=$(*:kernel_%=%)_$f))

# run.c with eight lanes, in vectors that every machine has; and with a bound that is wrong.
run_wide := $(addprefix $(O)/run/,wide.o exact_wide.o times_wide.o boxes_wide.o wide_planted.o)
run_wide_exact_wide := -DRUN_EXACT
run_wide_times_wide := -DRUN_TIMES
run_wide_boxes_wide := -DRUN_BOXES
run_wide_wide := -ffp-contract=fast
run_wide_wide_planted := -ffp-contract=fast -DSLABS_ROUNDING=0x1p-58
$(B)/tests/test_kernels: $(run_wide)
$(run_wide): $(O)/run/%.o: service/fmb/run.c $(O)/settings
	@mkdir -p $(@D)
	$(compile_bare) -DLANES=8 -DRUN_NAME=$* $(run_wide_$*)

# The others. Some count what GMP is asked to do, what is read and what our own code allocates, see
# what becomes of each query of a log, or replace the kernel's counter of drops.
wraps = $(addprefix -Wl$(comma)--wrap=,$1)
wraps_test_engine_work := $(call wraps,$(addprefix __gmp,z_mul z_addmul z_submul z_add z_sub \
	z_fdiv_q z_tdiv_q z_tdiv_qr q_mul q_div q_add q_sub q_canonicalize))
wraps_test_log_read := $(call wraps,pread64)
wraps_test_log_cut := $(call wraps,page_open page_take)
wraps_test_answer_scene := $(call wraps,malloc calloc realloc aligned_alloc)
wraps_test_bus := $(call wraps,bus_socket_drops sched_yield)
$(patsubst %,$(B)/tests/%,$(filter-out $(engine_tests) $(internal_tests),$(unit_names))): \
		$(B)/tests/%: $(V)/tests/unit/%.o $(shared) $(product) $(B)/libfmb.a | $(B)/netns
	@mkdir -p $(@D)
	$(CC) $(link_flags) $(wraps_$*) -o $@ $^ -lcmocka -lcjson -llcm -lglib-2.0 -lgmp -lm

$(V)/tests/unit/test_bus.o: tests/unit/test_bus.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -Imsgs/bus

$(O)/tests/oracle/%.o: tests/oracle/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -Iservice/fmb -Itests/oracle

$(O)/tests/hostile/%.o: tests/hostile/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) -I$(GEN) $(glib_flags)

# Tests of the engine see it and the oracle, those of scenes the service too; of all others that
# of meshes alone an oracle.
engine_views := $(engine_tests) $(internal_tests) slab_truth pair_draw
scene_views := $(answer_tests) scene_truth
family_views := $(family_tests) $(scene_views) pair_draw test_engine_work
unit_sees = -Iservice/fmb $(if $(filter $1,$(engine_views) $(scene_views) test_mesh_meet),-Itests/oracle) \
	$(if $(filter $1,$(family_views)),-Itests/campaign) \
	$(if $(filter $1,$(engine_views)),,-Iservice -Imsgs/codec) \
	$(if $(filter $1,$(engine_views) $(scene_views)),,\
		$(clients_see) -Itests/hostile -Itests/mesh -I$(GEN))
$(O)/tests/replay/%.o: tests/replay/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) $(clients_see) -Itests/unit -Itests/bench -I$(GEN)

$(V)/tests/unit/%.o: tests/unit/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) $(openmp_flag) $(call unit_sees,$*)

# ---- Fuzz targets: each in a program that replays its corpus and, with MODE=fuzz, in fuzzers ----

message_fuzz_targets := pair_query pair_result scene_query scene_result definition_query definition \
	status
fuzz_targets := $(message_fuzz_targets) answer scene_json event_log replay_log mesh
replayers := $(if $(filter fuzz,$(MODE)),,$(fuzz_targets:%=$(B)/tests/test_fuzz_%))
fuzz_objects := $(addprefix $(O)/tests/fuzz/,fuzz.o layout.o same.o results_pair.o results_scene.o)
fuzz_pieces_answer := $(O)/tests/fuzz/model.o
fuzz_pieces_scene_json := $(O)/tests/fuzz/pieces.o
fuzz_pieces_event_log := $(O)/tests/fuzz/log_pieces.o
fuzz_pieces_replay_log := $(addprefix $(V)/tests/unit/,log_draft.o replay_report.o)

# Comparisons of numbers deep in the engine are not what inputs should be made for.
ifeq ($(MODE),fuzz)
$(lib_objects): flags += -O2 -fno-sanitize-coverage=trace-cmp
endif

# Archives: the linker takes what a target needs, and what stands before an archive on its command
# line replaces the member of that name. Readers of messages link the codec and the engine, answer
# the service too, the others everything.
fuzz_archive_messages := $(O)/fuzz_messages.a
fuzz_archive_answer := $(O)/fuzz_answer.a $(fuzz_archive_messages)
fuzz_archive_all := $(O)/fuzz_clients.a $(fuzz_archive_answer)
fuzz_archives = $(fuzz_archive_$(if $(filter $1,$(message_fuzz_targets)),messages,$(if \
	$(filter $1,answer seeds),answer,all)))
$(fuzz_archive_messages): $(fuzz_objects) $(hostile_objects) $(codec_objects) $(message_objects) \
	$(lib_objects)
$(O)/fuzz_answer.a: $(answer_objects)
$(O)/fuzz_clients.a: $(client_objects) $(asking_objects) $(filter-out $(codec_objects),$(bus_objects))
$(fuzz_archive_all):
	@rm -f $@
	$(AR) rcs $@ $^

fuzz_libraries := -lcjson -llcm -lglib-2.0 -lgmp -lm
.SECONDEXPANSION:
$(fuzz_targets:%=$(B)/tests/test_fuzz_%): $(B)/tests/test_fuzz_%: $(O)/tests/fuzz/replay.o \
		$(O)/tests/fuzz/%.o $$(fuzz_pieces_$$*) $$(call fuzz_archives,$$*)
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ $(fuzz_libraries)

# The compiler links the fuzzer that it brings: libFuzzer, or AFL++'s.
fuzzers := $(fuzz_targets:%=$(B)/fuzz_%)
$(fuzzers): $(B)/fuzz_%: $(O)/tests/fuzz/%.o $$(fuzz_pieces_$$*) $$(call fuzz_archives,$$*)
	@mkdir -p $(@D)
	$(CC) $(link_flags) -fsanitize=fuzzer -o $@ $^ $(fuzz_libraries)

# Each file of planted/ is a copy of one file with one fault, and has the name of the target that
# must find it, followed by a dash and a word where a target has several. One replaces the pieces.
fuzz_plants := $(patsubst tests/fuzz/planted/%.c,%,$(wildcard tests/fuzz/planted/*.c))
planted_fuzzers := $(fuzz_plants:%=$(B)/planted/%)
fuzz_planted_target = $(firstword $(subst -, ,$1))
$(planted_fuzzers): $(B)/planted/%: $(O)/tests/fuzz/planted/%.o \
		$(O)/tests/fuzz/$$(call fuzz_planted_target,$$*).o \
		$$(filter-out $(fuzz_pieces_event_log),$$(fuzz_pieces_$$(call fuzz_planted_target,$$*))) \
		$$(call fuzz_archives,$$(call fuzz_planted_target,$$*))
	@mkdir -p $(@D)
	$(CC) $(link_flags) -fsanitize=fuzzer -o $@ $^ $(fuzz_libraries)

seed_objects := $(addprefix $(O)/tests/fuzz/,seeds.o seeds_message.o seeds_service.o seeds_file.o) \
	$(V)/tests/unit/log_draft.o
$(B)/fuzz_seeds: $(seed_objects) $(call fuzz_archives,seeds)
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ $(fuzz_libraries)

$(O)/tests/fuzz/%.o: tests/fuzz/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) $(clients_see) -Itests/fuzz -Itests/unit -Itests/hostile -I$(GEN) $(glib_flags)

.PHONY: fuzzers fuzz fuzz-afl fuzz-merge deps-fuzz
fuzzers: $(fuzzers) $(planted_fuzzers) $(B)/fuzz_seeds

fuzz fuzz-afl fuzz-merge:
	tests/fuzz/fuzz.sh $@

deps-fuzz:
	$(call install_packages,$(fuzz_packages))

# ---- Running the tests ----

.PHONY: tests fast-tests tested-programs unit-tests replay-set test test-fast check
tests: fast-tests examples $(measures)
fast-tests: tested-programs unit-tests $(capped_programs)
tested-programs: all $(helpers)
unit-tests: $(unit_tests) $(replayers) $(B)/netns
replay-set: $(B)/fmb $(B)/logs/generate $(filter %/fmb-plain %/fmb-sse2 %/fmb-avx2,$(capped_programs))

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

# ---- Campaigns: long tests of the engine, whose names they see all ---------------------------

campaign_objects := $(patsubst %.c,$(O)/%.o,$(filter-out %/accuracy.c %/validate.c,\
	$(wildcard tests/campaign/*.c))) $(filter-out %/referee.o,$(oracle_objects))

$(B)/validate $(B)/accuracy: $(B)/%: $(O)/tests/campaign/%.o $(campaign_objects) $(lib_objects)
	@mkdir -p $(@D)
	$(CC) $(link_flags) -pthread -o $@ $^ -lgmp -lm

# With bounds on rounding that are wrong, which the campaign must find.
campaign_plants := slabs.o gap_distance.o gap_depth.o
$(B)/accuracy-planted: $(O)/tests/campaign/accuracy.o $(campaign_objects) \
		$(filter-out $(addprefix %/,$(campaign_plants)),$(lib_objects)) \
		$(addprefix $(O)/planted/,$(campaign_plants))
	@mkdir -p $(@D)
	$(CC) $(link_flags) -pthread -o $@ $^ -lgmp -lm

# Sanitizers would take long for what another object of theirs has seen.
$(addprefix $(O)/planted/,$(campaign_plants)): $(O)/planted/%.o: service/fmb/%.c $(O)/settings
	@mkdir -p $(@D)
	$(subst $(mode_flags_$(MODE)),$(mode_flags_release),$(compile)) -DINLINED_NOT \
		-DSLABS_ROUNDING=0x1p-70 -DGAP_ROUNDING=0x1p-70

$(O)/tests/campaign/%.o: tests/campaign/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -pthread -Iservice/fmb -Itests/oracle

# validate: some twenty minutes; accuracy: some hours, on two cores.
.PHONY: validate accuracy
validate: $(B)/validate
	$<

accuracy: $(B)/accuracy
	$< --json $<.json

# Clients that know the answers, and a service to which bad things are done; some ten minutes, a
# minute for each trial or SECONDS=.
.PHONY: soak
soak: all $(filter $(B)/soak-% %/poke %/poison,$(helpers))
	tests/soak/soak.sh $(B) $(SECONDS)

$(B)/soak-asker: $(O)/tests/soak/asker.o $(O)/service/clock.o $(B)/libfmb-client.a $(B)/libfmb.a
	@mkdir -p $(@D)
	$(CC) $(link_flags) -pthread -o $@ $^ -llcm -lglib-2.0 -lgmp -lm

$(B)/soak-memory $(B)/soak-rate $(B)/soak-blast: $(B)/soak-%: $(O)/tests/soak/%.o $(bus_objects) $(message_objects) \
		$(B)/libfmb.a
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -llcm -lglib-2.0 -lgmp -lm

$(B)/soak-fair: $(addprefix $(O)/tests/soak/,fair.o attack.o) $(wire_objects) $(message_objects) \
		$(B)/libfmb.a
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -llcm -lglib-2.0 -lgmp -lm

$(B)/soak-relay: $(O)/tests/soak/relay.o
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^

$(O)/tests/soak/%.o: tests/soak/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) -pthread -Iservice -Imsgs/codec -Imsgs/bus -Iservice/fmb -Iclients/lib -I$(GEN)

# ---- Logs: what a service was asked, and answered, for fmb replay ----------------------------

logs_objects := $(patsubst %.c,$(O)/%.o,$(filter-out %/tell.c,$(wildcard tests/logs/*.c))) $(addprefix \
	$(O)/tests/campaign/,cell.o contact.o family.o meet.o meeting.o odd.o scene.o solids.o) \
	$(addprefix $(O)/tests/oracle/,draw.o question.o) $(answer_objects) $(wire_objects) \
	$(message_objects)

$(B)/logs/generate: $(logs_objects) $(B)/libfmb.a
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -llcm -lglib-2.0 -lgmp -lm

# Shares nothing with what is tested but the message types.
$(B)/logs/tell: $(O)/tests/logs/tell.o $(message_objects)
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -llcm -lglib-2.0

# ---- Meshes: closed ones of any size, for tests and benchmarks --------------------------------

mesh_objects := $(patsubst %.c,$(O)/%.o,$(filter-out %/mesh_page.c,$(wildcard clients/mesh/*.c))) \
	$(addprefix $(O)/clients/,allocate.o escape.o json_write.o keyed_hash.o number.o) $(addprefix $(O)/service/,clock.o random_id.o)

$(B)/mesh/make-mesh: $(addprefix $(O)/tests/mesh/,make_mesh.o bumpy.o formats.o) $(mesh_objects) $(B)/libfmb.a
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -lgmp -lm

$(O)/tests/mesh/%.o: tests/mesh/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -Iclients/mesh -Iclients -Iservice -Iservice/fmb -Itests/bench

# The programs with a library that takes no more of the machine than its name says: nothing else of
# them differs. On a machine that has less, they take less.
capped_most_plain := 1
capped_most_sse2 := 2
capped_most_avx2 := 3

$(capped_sets:%=$(O)/capped/%.o): $(O)/capped/%.o: service/fmb/instructions.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -DINSTRUCTIONS_MOST=$(capped_most_$*)

$(B)/capped/libfmb-plain.a: $(alone_plain)
$(capped_sets:%=$(B)/capped/libfmb-%.a): $(B)/capped/libfmb-%.a: $(O)/capped/%.o \
		$(filter-out %/instructions.o $(alone_plain),$(lib_objects))
	$(call archive,fmb_*)

$(capped_sets:%=$(B)/capped/fmbd-%): $(B)/capped/fmbd-%: $(fmbd_objects) $(B)/capped/libfmb-%.a
	$(CC) $(link_flags) -o $@ $^ $(fmbd_libraries)

$(capped_sets:%=$(B)/capped/fmb-%): $(B)/capped/fmb-%: $(fmb_objects) $(B)/libfmb-client.a \
		$(B)/capped/libfmb-%.a
	$(CC) $(link_flags) -o $@ $^ -lcjson -llcm -lglib-2.0 -lgmp -lm

$(capped_sets:%=$(B)/capped/generate-%): $(B)/capped/generate-%: $(logs_objects) \
		$(B)/capped/libfmb-%.a
	$(CC) $(link_flags) -o $@ $^ -llcm -lglib-2.0 -lgmp -lm

# What the set is, made anew: the logs, and the results that they are compared with. Neither changes
# by itself: tests/cli/logs.bats sees to it that this changes nothing.
.PHONY: logs goldens
logs: $(B)/logs/generate
	for kind in $$($< --list | cut -d ' ' -f 1); do $< $$kind tests/logs/$$kind.log || exit; done

goldens: $(B)/fmb
	for log in tests/logs/*.log; do \
		$< replay --force --write-golden $${log%.log}.golden $$log > /dev/null || \
			[ $$log = tests/logs/foreign.log ] || exit; done

$(O)/tests/logs/%.o: tests/logs/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) -Iservice -Iservice/fmb -Itests/oracle -Itests/campaign -Imsgs/codec -Imsgs/bus -I$(GEN)

# ---- Benchmark -------------------------------------------------------------------------------

# The smaller and the larger of two numbers are one instruction each where there is no NaN to think
# of: sat.c says why none is met. Nothing else changes.
$(addprefix $(O)/,service/fmb/sat.o $(addprefix tests/bench/,gpr.o lean_sat.o seidel.o)): flags += -ffinite-math-only -fno-signed-zeros

# Other libraries are raced too where they are installed: make deps-bench, then make bench.
bullet := $(shell for p in bullet-float64 bullet; do pkg-config --exists $$p && echo $$p && break; \
	done 2> /dev/null)
peer_packages := $(shell for p in ccd fcl ode box2d; do pkg-config --exists $$p && echo $$p; \
	done 2> /dev/null) $(bullet)
peer_libraries := $(peer_packages:%-float64=%) \
	$(and $(wildcard /usr/include/CGAL/version.h),$(wildcard /usr/include/mpfr.h),cgal)
peer_objects := $(peer_libraries:%=$(O)/tests/bench/peers/%.o)
peers := $(O)/peers/$(or $(subst $() ,_,$(strip $(peer_libraries))),none).o
bench_objects := $(patsubst %.c,$(O)/%.o,$(filter-out %/peers.c,$(wildcard tests/bench/*.c))) \
	$(peers) $(peer_objects) $(O)/ordered/eliminate.o

$(B)/bench/bench: $(bench_objects) $(campaign_objects) $(lib_objects)
	@[ ! -f $(@D) ] || rm $(@D) # it was a program once
	@mkdir -p $(@D)
	$(CC) $(link_flags) -pthread -o $@ $^ \
		$(if $(peer_packages),$$(pkg-config --libs $(peer_packages))) \
		$(if $(peer_libraries),$(if $(filter cgal,$(peer_libraries)),-lmpfr) -lstdc++) -lgmp -lm

$(O)/tests/bench/%.o: tests/bench/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -Iservice/fmb -Itests/oracle -Itests/campaign

$(peers): tests/bench/peers.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -Iservice/fmb -Itests/oracle -Itests/campaign \
		-DPEER_LIBRARIES='$(patsubst %,X(%),$(peer_libraries))'

# CGAL's intervals change the direction of rounding.
peer_flags_bullet = $$(pkg-config --cflags $(bullet))
peer_flags_cgal = -frounding-math
$(O)/tests/bench/peers/%.o: tests/bench/peers/%.cc $(O)/settings
	@mkdir -p $(@D)
	$(CXX) $(or $(peer_flags_$*),$$(pkg-config --cflags $*)) -std=c++17 -O2 -DNDEBUG -MMD -MP \
		-Itests/bench -c $< -o $@

# The article's elimination once more, with rows in an order that the benchmark chooses.
$(O)/ordered/eliminate.o: service/fmb/eliminate.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -Drows_of_pair=ordered_rows_of_pair -Deliminate_decide=ordered_decide

# Minutes; what it measured is in bench/report.json then.
.PHONY: bench deps-bench
bench: $(B)/bench/bench $(B)/robot/robot
	$< --json $(B)/bench/report.json
	$(B)/robot/robot

deps-bench:
	$(call install_packages,libccd-dev libfcl-dev libbullet-dev libode-dev \
		libbox2d-dev libcgal-dev libmpfr-dev pkg-config)

# States of a robot, beside FCL where it is installed.
fcl := $(shell pkg-config --exists fcl 2> /dev/null && echo fcl)
robot_objects := $(addprefix $(O)/,tests/robot/states.o tests/oracle/draw.o)
$(B)/robot/robot: $(O)/tests/robot/robot.o $(O)/robot/$(or $(fcl),no_fcl).o $(robot_objects) \
		$(O)/tests/bench/stopwatch.o $(B)/libfmb.a
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ $(if $(fcl),$$(pkg-config --libs fcl) -lstdc++) -lgmp -lm

$(O)/tests/robot/%.o: tests/robot/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) $(codec_see) -Iservice -Imsgs/bus -Itests/oracle -Itests/bench -Itests/bus

$(O)/robot/no_fcl.o: tests/robot/no_fcl.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -Iservice/fmb

$(O)/robot/fcl.o: tests/robot/fcl.cc $(O)/settings
	@mkdir -p $(@D)
	$(CXX) $$(pkg-config --cflags fcl) -std=c++17 -O2 -MMD -MP -Iservice/fmb -c $< -o $@

# The bus: fmbd against an echo that does nothing, in a network of their own.
bus_bench_objects := $(patsubst %.c,$(O)/%.o,$(filter-out %/echo.c,$(wildcard tests/bus/*.c))) \
	$(addprefix $(O)/tests/bench/,json.o lean_sat.o machine.o scene.o stopwatch.o)

$(B)/bus/bench-bus: $(bus_bench_objects) $(campaign_objects) $(server_objects) $(bus_objects) \
		$(message_objects) $(lib_objects) | $(B)/bus/echo $(B)/fmbd
	@mkdir -p $(@D)
	$(CC) $(link_flags) -pthread -o $@ $(filter %.o,$^) -llcm -lglib-2.0 -lgmp -lm

# A robot's states, likewise.
$(B)/bus/robot-bus: $(O)/tests/robot/bus.o $(robot_objects) \
		$(addprefix $(O)/tests/bus/,line.o datagram.o guard.o parties.o) \
		$(O)/tests/bench/stopwatch.o $(server_objects) $(bus_objects) $(message_objects) \
		$(lib_objects) | $(B)/bus/echo $(B)/fmbd
	@mkdir -p $(@D)
	$(CC) $(link_flags) -pthread -o $@ $(filter %.o,$^) -llcm -lglib-2.0 -lgmp -lm

$(B)/bus/echo: $(O)/tests/bus/echo.o
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -llcm

$(O)/tests/bus/%.o: tests/bus/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) -Iservice $(codec_see) -Imsgs/bus -Itests/oracle -Itests/campaign -Itests/bench

# Minutes; what it measured is in bus/report.json then.
.PHONY: bench-bus
bench-bus: $(B)/bus/bench-bus $(B)/bus/robot-bus $(B)/netns
	$(B)/netns $< --json $(B)/bus/report.json
	$(B)/netns $(B)/bus/robot-bus

# Logs: replayed, and described, beside the batch alone and beside cat. Some minutes, and some
# hundred megabytes in build/replay/.
$(B)/replay/bench-replay: $(O)/tests/replay/bench_replay.o \
		$(addprefix $(O)/tests/bench/,child.o machine.o stopwatch.o) $(client_objects) \
		$(answer_objects) $(bus_objects) $(message_objects) $(asking_objects) $(B)/libfmb.a
	@mkdir -p $(@D)
	$(CC) $(link_whole) -o $@ $^ -lcjson -llcm -lglib-2.0 -lgmp -lm

blast_scenes := scenes 400
blast_pairs := pairs 500000
blast_pairs-64-bodies := pairs 500000 --bodies 64
blast_pairs-whole := pairs 500000 --whole
blast_pairs-by-handle := pairs 500000 --by-handle
bench_log_names := scenes pairs pairs-64-bodies pairs-whole pairs-by-handle
bench_logs := $(bench_log_names:%=$(B)/replay/%.log)
$(B)/replay/%.log: $(B)/logs/generate
	@mkdir -p $(@D)
	$< --blast $(blast_$*) $@

.PHONY: bench-replay
bench-replay: $(B)/replay/bench-replay $(B)/fmb $(bench_logs)
	$< $(B)/fmb $(bench_logs)

# Meshes: the article's scene, of MESH, whose coordinates it multiplies by 1000 as the article does
# with the Stanford Bunny; or of a mesh that is made, about as large and of as many faces. A minute.
$(B)/mesh/bench-mesh: $(addprefix $(O)/tests/mesh/,bench_mesh.o sweep.o) \
		$(addprefix $(O)/tests/bench/,child.o machine.o stopwatch.o) $(mesh_objects) \
		$(B)/libfmb.a
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -lgmp -lm

.PHONY: bench-mesh
bench-mesh: $(B)/mesh/bench-mesh $(B)/fmb $(if $(MESH),,$(B)/mesh/bumpy.ply)
	$< $(B)/fmb $(or $(MESH),$(B)/mesh/bumpy.ply) $(if $(MESH),1000,60)

$(B)/mesh/bumpy.ply: $(B)/mesh/make-mesh
	$< --faces 70000 --format ply-ascii > $@

# ---- Report ----------------------------------------------------------------------------------

# One page of what 'make bench' and 'make accuracy' measured, and 'make bench-bus' if it did; it runs
# none of them.
.PHONY: report deps-report
report:
	tests/report/report.sh $(B)/bench/report.json $(B)/accuracy.json $(B)/report \
		$(B)/bus/report.json

report_packages := jq
deps-report:
	$(call install_packages,$(report_packages))

# ---- Headers, format -------------------------------------------------------------------------

# Every header compiles alone.
sources := $(shell find service msgs clients tests -name '*.[ch]')
headers := $(wildcard service/fmb/*.h service/*.h msgs/codec/*.h msgs/bus/*.h clients/*.h clients/lib/*.h clients/log/*.h \
	clients/mesh/*.h clients/page/*.h clients/record/*.h clients/replay/*.h tests/oracle/*.h \
	tests/hostile/*.h tests/campaign/*.h tests/bench/*.h tests/bus/*.h tests/fuzz/*.h tests/soak/*.h \
	tests/logs/*.h tests/mesh/*.h tests/page/*.h)
.PHONY: headers
headers: $(headers:%=$(O)/%.ok)
$(O)/%.h.ok: %.h $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(CC) $(flags) $(if $(filter tests/campaign/% tests/bench/% tests/bus/% tests/logs/%,$<),\
		-Itests/oracle -Itests/campaign -Itests/bench) \
		$(clients_see) -I$(GEN) -fsyntax-only -x c $<
	@touch $@

.PHONY: format format-check
format:
	@clang-format -i $(sources)
format-check:
	@clang-format --dry-run -Werror $(sources)

# ---- Demo, installation ------------------------------------------------------------------

.PHONY: demo
demo: # builds on all cores, also where packages are installed first
	+$(MAKE) $(if $(filter -j%,$(MAKEFLAGS)),,-j$$(nproc)) all
	clients/demo/run.sh $(B)

fill_in = sed -e 's|@PREFIX@|$(PREFIX)|' -e 's|@LIBDIR@|$(LIBDIR)|' -e 's|@VERSION@|$(VERSION)|'
.PHONY: install install-strip uninstall
install: all
	$(INSTALL) -d "$(DESTDIR)$(PREFIX)/bin" "$(DESTDIR)$(LIBDIR)/pkgconfig" \
		"$(DESTDIR)$(PREFIX)/include" "$(DESTDIR)$(PREFIX)/share/fmb/lcmtypes" \
		"$(DESTDIR)$(PREFIX)/share/doc/fmb" "$(DESTDIR)$(PREFIX)/lib/systemd/system"
	$(INSTALL) $(strip_option) $(programs) "$(DESTDIR)$(PREFIX)/bin"
	$(INSTALL) -m 644 $(B)/libfmb.a $(B)/libfmb-client.a "$(DESTDIR)$(LIBDIR)"
	$(INSTALL) -m 644 service/fmb/fmb.h clients/lib/fmb_client.h "$(DESTDIR)$(PREFIX)/include"
	$(INSTALL) -m 644 $(message_names:%=msgs/%.lcm) "$(DESTDIR)$(PREFIX)/share/fmb/lcmtypes"
	$(INSTALL) -m 644 LICENSE "$(DESTDIR)$(PREFIX)/share/doc/fmb"
	$(fill_in) $(if $(openmp_flag),-e 's|^Libs:.*|& $(openmp_flag)|') service/fmb/fmb.pc.in \
		> "$(DESTDIR)$(LIBDIR)/pkgconfig/fmb.pc"
	$(fill_in) clients/lib/fmb-client.pc.in > "$(DESTDIR)$(LIBDIR)/pkgconfig/fmb-client.pc"
	$(fill_in) service/fmbd.service.in > "$(DESTDIR)$(PREFIX)/lib/systemd/system/fmbd.service"

install-strip: strip_option := -s
install-strip: install

uninstall:
	cd "$(DESTDIR)$(PREFIX)" && rm -rf bin/fmbd bin/fmb include/fmb.h include/fmb_client.h \
		share/fmb share/doc/fmb lib/systemd/system/fmbd.service
	cd "$(DESTDIR)$(LIBDIR)" && rm -f libfmb.a libfmb-client.a pkgconfig/fmb.pc \
		pkgconfig/fmb-client.pc

.PHONY: clean
clean:
	rm -rf build

# ---- Packages ----------------------------------------------------------------------------

build_packages := gcc libc6-dev liblcm-dev liblcm-bin libcjson-dev libgmp-dev libglib2.0-dev \
	libseccomp-dev pkg-config uthash-dev
test_packages := $(build_packages) libcmocka-dev bats jq clang clang-format libclang-rt-14-dev \
	liblcm-java default-jdk-headless liblcm-lua lua5.2 chromium libxml2-utils

fuzz_packages := $(build_packages) clang libclang-rt-14-dev llvm afl++

as_root = $$([ $$(id -u) = 0 ] || echo sudo)
define install_packages
	@command -v apt-get > /dev/null || { \
		echo 'make $@: no apt-get here; install what these Debian packages hold:' >&2; \
		echo '  $(1)' >&2; exit 1; }
	@missing=$$(for package in $(1); do \
		dpkg-query -W -f '$${db:Status-Abbrev}' $$package 2> /dev/null | grep -q '^ii' \
			|| echo $$package; done); \
	[ -z "$$missing" ] || { $(as_root) apt-get update -q && \
		$(as_root) env DEBIAN_FRONTEND=noninteractive \
			apt-get install -q -y --no-install-recommends $$missing; }
endef

.PHONY: deps deps-test
deps:
	$(call install_packages,$(build_packages))
deps-test:
	$(call install_packages,$(test_packages))

# In 'make deps demo' the packages come first, and in 'make clean all' the cleaning, whatever
# -j says.
ifneq ($(filter deps deps-test deps-fuzz deps-report clean,$(MAKECMDGOALS)),)
.NOTPARALLEL:
endif

.DELETE_ON_ERROR:
.SECONDARY:
.DEFAULT_GOAL := all

-include $(shell find $(O) $(V) -name '*.d' 2> /dev/null)
