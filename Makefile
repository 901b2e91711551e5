# The FMB query service. Two commands for a bare Debian machine:
#
#   make deps demo        installs what building needs, then lets the service answer a scene
#   make deps-test test   installs what the tests need, then runs them
#
# Targets, each group after the target that installs the packages it needs:
#
#   deps          all (default), programs, manual, demo, install, install-strip, uninstall, clean, help;
#                 examples: in Java, where it is; headers, layers: what a folder may include and call;
#                 logs, goldens: the regression logs, and the results that they are compared with;
#                 abi: the names, layouts and numbers that programs linked with the libraries depend on
#   deps-test     test, check (all, in two builds), test-fast (one build, small samples), unit-tests;
#                 tests, fast-tests, tested-programs, replay-set: what these build;
#                 format, format-check; picture: that of README.md
#   deps-bench    bench, bench-bus, bench-commands; speed-error: the picture of what accuracy measured;
#                 accuracy, depth, checked, hull-poses, soak: campaigns that take longer
#   deps-fuzz     fuzz, fuzz-afl, fuzz-merge, fuzzers
#   deps-deb      deb: packages of Debian, into build/deb; deb-test: tries them in a chroot (root);
#                 release: tarball, packages and their checksums, into build/release
#                 (tests/deb/readme.sh SUITE follows README.md in a chroot)
#   deps-aarch64  aarch64: fmb for AArch64, which 'make test' then emulates
#
# Variables:
#   MODE=release|debug|asan        optimised, for a debugger, with sanitizers and fuzzers (clang)
#   INSTRUCTIONS=two               leaves out the AVX2 and AVX-512 kernels, which compile slowly
#   PEERS=none                     leaves out other libraries from the benchmarks
#   WERROR=1                       warnings are errors
#   V=1                            shows commands, not one line a file
#   BUILD=FOLDER                   builds programs in FOLDER, not in build/; the tree may be read-only
#   HELP_FROM=build                whose programs print the manual; for those of another machine
#   PYTHONDIR                      where fmb.py goes
#   CC, CPPFLAGS, CFLAGS, LDFLAGS, PREFIX, LIBDIR, DESTDIR   as usual; flags that change numbers are left out

# fmb.h has the version. Until 1.0 each minor version has a soname of its own.
VERSION := $(shell awk '/^.define FMB_VERSION_M/ { printf "%s.", $$3 } /^.define FMB_VERSION_P/ { print $$3 }' service/fmb/fmb.h)
SOVERSION := $(basename $(VERSION))
MODE ?= release
INSTRUCTIONS ?=
ifeq ($(origin CC),default)
CC := $(if $(filter asan,$(MODE)),clang,gcc)
endif
PREFIX ?= /usr/local
override PREFIX := $(if $(filter /%,$(firstword $(PREFIX))),$(PREFIX),$(shell realpath -m '$(PREFIX)'))
LIBDIR ?= $(PREFIX)/lib
INSTALL ?= install
# Debian's Python, and where it finds modules under PREFIX: in /usr those of every version.
python := $(firstword $(wildcard /usr/bin/python3) python3)
PYTHONDIR ?= $(PREFIX)/lib/$(if $(filter /usr,$(PREFIX)),python3,$(shell $(python) -c \
	'import sys; print("python%d.%d" % sys.version_info[:2])' 2> /dev/null || echo python3))/dist-packages
OBJCOPY ?= objcopy

# The default build lies in build/, others in build/VARIANT.
BUILD := build
compiler := $(notdir $(firstword $(CC)))
variant := $(MODE)$(if $(filter-out gcc cc,$(compiler)),-$(compiler))$(INSTRUCTIONS:%=-%)
B := $(if $(filter release,$(variant)),$(BUILD),$(BUILD)/$(variant))
O := $(BUILD)/obj/$(variant)
GEN := $(BUILD)/msgs

.PHONY: all
all: programs manual
	@$(if $(silent),,echo "built $(programs): try 'make demo', or '$(B)/fmb query --local clients/demo/table.json'")

.PHONY: help
help:
	@sed -n '/^#/!q; s/^# \{0,1\}//p' Makefile

# $(call say,WORK,FILE)COMMAND prints one short line: of a command alone with V=1, nothing with -s.
flags_of_make := $(firstword -$(MAKEFLAGS))
silent := $(findstring s,$(flags_of_make))
say = $(quiet)$(if $(V)$(silent)$(findstring n,$(flags_of_make)),,printf '  %-5s %s\n' $1 $2;)
quiet := $(if $(V),,@)

# ---- Flags ----

# Makes the build folder in debug information relative. The linker needs this option too where it optimises; so does
# the assembler, for objects that the linker may optimise ('whole' below).
mode_link_release := -ffile-prefix-map='$(subst ','\'',$(CURDIR))'=.
mode_flags_release := -O2 -g1 -DNDEBUG $(mode_link_release)
mode_flags_debug := -O0 -g3
ifeq ($(MODE)$(findstring clang,$(compiler)),asan)
$(error MODE=asan needs clang, not $(CC): leave out CC)
endif
mode_flags_asan := -O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=all \
	-fno-omit-frame-pointer -fsanitize=fuzzer-no-link
ifeq ($(mode_flags_$(MODE)),)
$(error MODE is release, debug or asan)
endif
ifneq ($(filter-out two,$(INSTRUCTIONS)),)
$(error INSTRUCTIONS is two or empty)
endif
# The places that messages of sanitizers name are 4 MB of pointers: PIE would relocate them in each process.
# LLVM's linker takes a third of the time.
mode_link_asan = -fsanitize=address,undefined -no-pie $(if $(shell command -v ld.lld),-fuse-ld=lld)

# A user's flags that change how numbers are rounded would change verdicts. Programs linked with some of them also
# flush subnormals to zero from their start. integer.h refuses flags that this list misses, if the compiler tells.
rounding := -Ofast -ffast-math -funsafe-math-optimizations -fassociative-math -freciprocal-math -fapprox-func \
	-ffinite-math-only -fno-honor-nans -fno-honor-infinities -fno-signed-zeros -fsingle-precision-constant \
	-ffp-model=% -ffp-eval-method=% -fdenormal-fp-math% -mdaz-ftz -ffp-contract=% -fexcess-precision=% -mfpmath=%
rounding := $(filter-out %=off %=standard %=sse,$(filter $(rounding),$(CC) $(CPPFLAGS) $(CFLAGS) $(LDFLAGS)))
ifneq ($(rounding),)
$(warning left out, as answers would change: $(sort $(rounding)))
$(foreach v,CC CPPFLAGS CFLAGS LDFLAGS,$(eval override $v := $$(filter-out $$(rounding),$$($v))))
endif

# -ffp-contract=off: the same bits on every machine. A user's flags come last, except for those that a file needs.
# -fPIC: archives fit into shared objects too; without interposition it costs the programs nothing.
flags := -std=c17 -D_POSIX_C_SOURCE=200809L -ffp-contract=off -fno-semantic-interposition \
	-Wall -Wextra -Wshadow -Wvla -Wstrict-prototypes -Wmissing-prototypes -Wwrite-strings \
	$(if $(WERROR),-Werror) $(mode_flags_$(MODE))
user_flags := $(CPPFLAGS) $(CFLAGS)
needed := -fPIC
# Release builds are hardened. The engine is compiled without stack protector and _FORTIFY_SOURCE:
# its loops write into arrays of known size, and every instruction of them counts. A user's own
# _FORTIFY_SOURCE is kept.
hardened_release := -fstack-protector-strong
hardened_link_release := -pie -Wl,-z,relro,-z,now
ifeq ($(findstring _FORTIFY_SOURCE,$(user_flags))$(filter -O0,$(user_flags)),)
hardened_release += -D_FORTIFY_SOURCE=2
endif
hardened := $(hardened_$(MODE))
$(O)/service/fmb/%.o: hardened :=
compile = $(call say,CC,$<) $(CC) $(flags) $(hardened) $(user_flags) $(needed) $(whole) -MMD -MP -c $< -o $@
link_user := $(mode_link_$(MODE)) $(hardened_link_$(MODE)) $(CFLAGS) $(LDFLAGS)

# The path of a query, from its bytes to those of its result, is faster by a tenth with -O3, and by
# another tenth where gcc optimises the whole program. Tests and libraries link the same objects
# without that: names in libraries are hidden by objcopy.
link_flags := $(link_user) -fno-lto
link_whole := $(link_flags)
whole := -fno-lto
ifeq ($(MODE),release)
$(O)/service/%.o $(O)/msgs/%.o $(O)/clients/log/%.o $(O)/clients/exchange/%.o $(O)/clients/replay/%.o: flags += -O3
ifneq ($(filter gcc%,$(compiler)),)
link_whole := -O3 $(link_user) -flto=auto
$(O)/service/%.o $(O)/msgs/%.o $(O)/clients/log/%.o $(O)/clients/exchange/%.o $(O)/clients/replay/%.o: \
	whole := -flto=auto -ffat-lto-objects -Xassembler --debug-prefix-map='$(subst ','\'',$(CURDIR))'=.
$(O)/service/fmb/%.o: whole := -fno-lto
# Vectors of three doubles that are stored one by one and loaded in pairs would stall.
$(O)/service/fmb/gap/%.o: flags += -fno-tree-slp-vectorize
endif
endif

# ---- Which folder may include from which: a wrong arrow fails to build ----

fmb = service/fmb $(addprefix service/fmb/,$1)
wire := msgs/codec msgs/bus msgs/common service/fmb
see_service/fmb/number := service/fmb
see_service/fmb/frame := $(call fmb,number)
see_service/fmb/filter := $(call fmb,number frame)
see_service/fmb/article := $(call fmb,number frame filter)
see_service/fmb/tree := $(call fmb,number frame)
see_service/fmb/limbs := $(call fmb,number frame filter)
see_service/fmb/gap := $(call fmb,number frame limbs)
see_service/fmb/certificate := $(call fmb,number frame limbs gap support turn)
see_service/fmb/support := $(call fmb,number frame limbs gap)
see_service/fmb/turn := $(call fmb,number frame limbs gap support)
see_service/fmb/decide := $(call fmb,number frame filter article tree limbs gap support turn)
see_msgs/codec := service/fmb $(GEN)
see_msgs/bus := msgs/common
see_msgs/common := msgs/codec service/fmb
see_service/answer := msgs/codec service/fmb
see_service := service/answer $(wire)
see_clients/lib := $(wire)
see_clients/common := clients/lib msgs/common msgs/codec service/fmb msgs/bus
see_clients/query := clients/page clients/common clients/lib msgs/codec msgs/common service/fmb
see_clients/log := clients/common clients/lib $(wire)
see_clients/exchange := clients/log $(see_clients/log)
see_clients/page := clients/exchange $(see_clients/exchange)
see_clients/record := clients/log $(see_clients/log)
see_clients/mesh := clients/page clients/common clients/lib msgs/common msgs/codec service/fmb
see_clients/robot := clients/mesh clients/common clients/lib msgs/codec msgs/common service/fmb
see_clients/replay := clients/page clients/exchange service/answer $(see_clients/exchange)
see_clients := $(addprefix clients/,query record mesh robot replay) $(see_clients/replay)
see_clients/demo :=
see_clients/examples := clients/lib msgs/codec service/fmb
see_clients/python := clients/lib $(wire)

# Before the rules whose prerequisites they are.
message_names := body_t definition_query_t definition_t names_t pair_query_t pair_result_t placement_t \
	scene_query_t scene_result_t status_t
message_files := $(message_names:%=msgs/%.lcm)
message_headers := $(message_names:%=$(GEN)/fmb_msgs_%.h)

# Evaluated when it is needed: 'make deps' may just have installed GLib.
glib_flags = $(shell pkg-config --cflags glib-2.0)
sees = $(addprefix -I,$(see_$(<D))) \
	$(if $(filter msgs/codec clients/page clients/replay tests/hostile tests/fuzz%,$(<D)),$(glib_flags))
$(O)/%.o: %.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) $(sees)

# ---- Objects and archives ----

# Sorted by make, so that the order does not depend on the locale.
objects_in = $(patsubst %.c,$(O)/%.o,$(sort $(wildcard $(addsuffix /*.c,$1))))

# The filter's kernels: a file of service/fmb/filter for each job and instruction set. Bits of verdicts
# are not promised: they may use fused operations. The machine answers where no compiler is there:
# 'make deps' has still to install it.
x86 := $(filter x86_64%,$(shell $(CC) -dumpmachine 2> /dev/null || uname -m))
filter := $(O)/service/fmb/filter
# Vectors are passed between functions of one file alone.
$(filter)/%.o $(O)/tests/unit/kernels/%.o: flags += -Wno-psabi
$(filter)/%_avx2.o: needed += -mavx2 -mfma
$(filter)/%_avx512.o: needed += -mavx512f -mavx512dq -mavx512vl -mfma -mprefer-vector-width=512
verdict_kernels := $(patsubst %.c,$(O)/%.o,$(wildcard $(addprefix service/fmb/filter/,verdicts_*.c single_*.c)))
$(verdict_kernels): flags += -ffp-contract=fast
ifeq ($(MODE),release)
$(filter)/boxes_%.o: flags += -O3
endif
left_out := $(if $(x86),$(if $(INSTRUCTIONS),%_avx2.o %_avx512.o),%_avx2.o %_avx512.o)

$(O)/service/fmb/filter/instructions.o: flags += $(if $(INSTRUCTIONS),-DINSTRUCTIONS_MOST=2)

# The method that the benchmark compares with handles no NaN: minima and maxima are one instruction each.
$(O)/tests/bench/lean_sat.o: flags += -ffinite-math-only -fno-signed-zeros

engine_folders := $(call fmb,number frame filter article tree limbs gap support turn certificate decide)
engine_objects_in = $(filter-out $(left_out),$(call objects_in,$1))
engine_objects := $(call engine_objects_in,$(engine_folders))

message_objects := $(message_names:%=$(O)/msgs/fmb_msgs_%.o)
$(message_headers:.h=.c) $(message_headers) &: $(message_files)
	@command -v lcm-gen > /dev/null || { \
		echo "make: no lcm-gen here; 'make deps' installs what building needs" >&2; exit 1; }
	@mkdir -p $(GEN)
	$(call say,LCM,$(GEN)) lcm-gen -c --c-cpath $(GEN) --c-hpath $(GEN) $^
# lcm-gen's own code is not ours to warn about, nor that its decoders copy no bytes to NULL.
$(O)/msgs/%.o: $(GEN)/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) -w -fno-sanitize=nonnull-attribute

wire_objects := $(call objects_in,$(filter-out service/fmb,$(wire))) $(message_objects)
client_objects := $(call objects_in,clients/lib clients/python)
product_objects := $(filter-out %/main.o %/fmb.o,$(wire_objects) $(call objects_in,service service/answer clients \
	$(addprefix clients/,common query log exchange page record mesh robot replay))) \
	$(addprefix $(O)/clients/lib/,enclosure.o pose.o turn.o) # the library shows them to nobody

# Of unmerged archives the linker takes what a program needs; what stands before them on its command
# line replaces the member of that name. Members of two folders may have one name.
engine := $(O)/engine.a
client := $(O)/client.a
product := $(O)/product.a
$(engine): $(engine_objects)
$(client): $(client_objects)
$(product): $(product_objects)
$(engine) $(client) $(product):
	@rm -f $@
	$(call say,AR,$@) $(AR) qcs $@ $^

# Every layer links with the folders that it may include from, and nothing else: a call that points up
# fails to link, also where its declaration stands below.
engine_layers := $(filter-out service/fmb,$(engine_folders))
wire_layers := msgs/codec msgs/bus msgs/common service/answer clients/lib clients/python
.PHONY: layers
layers: $(engine_layers:%=$(O)/%/layer.so) $(wire_layers:%=$(O)/%/layer.so)
$(foreach l,$(engine_layers),$(eval $(O)/$l/layer.so: \
	$(call engine_objects_in,$l $(filter $(engine_layers),$(see_$l)))))
$(foreach l,$(wire_layers),$(eval $(O)/$l/layer.so: $(message_objects) $(engine) \
	$(call objects_in,$l $(filter $(wire_layers),$(see_$l)))))
%/layer.so: $(O)/service/fmb/names.o
	$(call say,LD,$@) $(CC) $(filter-out -pie -no-pie,$(link_flags)) -shared -Wl,--no-undefined -o $@ $(filter %.o,$^) \
		$(filter %.a,$^) -Wl,--as-needed $(libraries)

# Libraries: one object that shows the names of the header alone, so that no program's names meet
# ours.
define library
	@mkdir -p $(@D)
	$(call say,AR,$@) $(CC) -r -nostdlib -fno-lto -o $(@:.a=.o) $^
	$(quiet)$(OBJCOPY) --wildcard $(1:%=--keep-global-symbol='%') -R '.gnu.*lto*' $(@:.a=.o)
	@rm -f $@
	$(quiet)$(AR) rcs $@ $(@:.a=.o)
	@rm $(@:.a=.o)
endef
$(B)/libfmb.a: $(engine_objects)
	$(call library,fmb_*)
$(B)/libfmb-client.a: $(client_objects) $(wire_objects)
	$(call library,fmb_client_* fmb_flat_*)
# From the other folders, the linker takes only what these objects need.
$(B)/libfmb-robot.a: $(filter-out %/joints.o %/robot_run.o %/path_proof.o,$(call objects_in,clients/robot)) $(product)
	$(call library,fmb_robot_*)

# The same as shared libraries, with the names of their headers alone.
so := so.$(SOVERSION)
shared_libraries := $(B)/libfmb.$(so) $(B)/libfmb-client.$(so) $(B)/libfmb-robot.$(so)
$(B)/libfmb.$(so): shared_needs := -lgmp -lm
$(B)/libfmb-client.$(so): shared_needs := $(B)/libfmb.$(so) -llcm -lglib-2.0 -lm
$(B)/libfmb-robot.$(so): shared_needs := $(B)/libfmb.$(so) -lexpat -lcjson -lm
$(B)/libfmb-client.$(so) $(B)/libfmb-robot.$(so): $(B)/libfmb.$(so)
$(shared_libraries): $(B)/%.$(so): $(B)/%.a
	@echo '{ local: fmb_client_raw_*; };' > $@.map
	$(call say,LD,$@) $(CC) $(filter-out -pie -no-pie,$(link_flags)) -shared -Wl,-soname,$(@F) -Wl,--version-script,$@.map -o $@ \
		-Wl,--whole-archive $< -Wl,--no-whole-archive $(shared_needs)
	@ln -sf $(@F) $(@:.$(SOVERSION)=)

# ---- Programs ----

define link
	@mkdir -p $(@D)
	$(call say,LD,$@) $(CC) $(linking) $(wraps_$(@F)) -o $@ $(filter %.o,$^) \
		-Wl,--start-group $(filter %.a,$^) -Wl,--end-group -Wl,--as-needed $(libraries)
endef
linking = $(link_flags)
libraries := -lcjson -lexpat -llcm -lglib-2.0 -lseccomp -lz -lgmp -lm

# fmb queries the bus through the library alone.
programs := $(B)/fmbd $(B)/fmb
demo_programs := $(B)/netns
.PHONY: programs
programs: $(programs) $(B)/fmb-check-path $(B)/libfmb.a $(B)/libfmb-client.a $(B)/libfmb-robot.a $(shared_libraries) $(demo_programs)
$(programs): linking = $(link_whole)
$(B)/fmbd: $(O)/service/main.o $(product) $(B)/libfmb.a
$(B)/fmb: $(O)/clients/fmb.o $(B)/libfmb-client.a $(product) $(B)/libfmb.a
$(demo_programs): $(B)/%: $(O)/clients/demo/%.o

$(programs) $(demo_programs):
	$(link)

$(B)/fmb-check-path: clients/robot/fmb-check-path
	@mkdir -p $(@D)
	$(call say,COPY,$@) $(INSTALL) $< $@

# ---- The page of --html: text, style and scripts in one file, compiled in ----

# Its policy lets nothing run but what has the hash of all between the tags, line ends included.
template := clients/page/template/
three := /usr/share/javascript/three/
page_scripts := $(template)data.js $(template)licence.js $(three)three.min.js \
	$(addprefix $(three)examples/js/,controls/OrbitControls.js math/ConvexHull.js) \
	$(addprefix $(template),solid.js scene.js lanes.js table.js player.js main.js)
page_hash = sha256-$$({ echo; cat $1; } | sha256sum | cut -c 1-64 | tr a-f A-F | \
	basenc --base16 -d | base64)
page := $(BUILD)/page/page.html
$(page): $(template)page.html $(template)page.css $(filter $(template)%,$(page_scripts)) Makefile
	@mkdir -p $(@D)
	@for file in $(page_scripts); do [ -f $$file ] || \
		{ echo "there is no $$file: make deps installs it" >&2; exit 1; }; done
	@! grep -n -e '</' -e '<!--' $(page_scripts) $(template)page.css
	@awk 1 $(page_scripts) > $(@D)/scripts
	$(call say,PAGE,$@) sed -e "s|@SCRIPT_HASH@|$(call page_hash,$(@D)/scripts)|" \
		-e "s|@STYLE_HASH@|$(call page_hash,$(template)page.css)|" \
		-e '/^@STYLE@$$/{r $(template)page.css' -e 'd;}' \
		-e '/^@SCRIPT@$$/{r $(@D)/scripts' -e 'd;}' $(template)page.html > $@
	@[ "$$(grep -c '@[A-Z_]*@' $@)" = 1 ] # @DATA@
$(O)/clients/page/page.o: $(page)
$(O)/clients/page/page.o: flags += -DPAGE_FILE='"$(page)"'

# The picture of README.md, drawn by chromium. Some characters of a path are escaped in an address.
url = $(subst ?,%3F,$(subst #,%23,$(subst $() ,%20,$(subst %,%25,$1))))
.PHONY: picture
picture: $(B)/fmb
	$(B)/fmb scene clients/demo/robot/robot.urdf --joints-csv clients/demo/robot/path.csv \
		--with clients/demo/robot/world.json --ignore base,table | $(B)/fmb query --local --html build/robot.html > build/robot.txt
	chromium --headless --no-sandbox --enable-unsafe-swiftshader --use-angle=swiftshader --hide-scrollbars \
		--window-size=1100,620 --virtual-time-budget=3000 --screenshot=clients/demo/robot.png \
		"file://$(call url,$(CURDIR))/build/robot.html#t=1.6"

# ---- The manual: what --help prints ----

HELP_FROM ?= $(B)
M := $(B)/man
.PHONY: manual
manual: $(M)/fmb.1
$(M)/fmb.1: clients/manual/pages.sh clients/manual/man.awk $(addprefix $(HELP_FROM)/,fmb fmbd fmb-check-path)
	$(call say,MAN,$(M)) $< $(HELP_FROM) $(M)

# ---- Settings: everything is built again when flags or lists of files change ----

settings := $(CC) $(flags) $(hardened) $(user_flags) $(needed) $(link_flags) $(link_whole) \
	$(engine_objects) $(product_objects) $(client_objects)
$(O)/settings: Makefile tests/tests.mk FORCE
	@mkdir -p $(@D)
	@echo '$(subst ','\'',$(settings))' | cmp -s - $@ && \
		[ $@ -nt Makefile ] && [ $@ -nt tests/tests.mk ] || \
		echo '$(subst ','\'',$(settings))' > $@
.PHONY: FORCE

# ---- An example: the message types in Java, and a client ----

lcm_jar := /usr/share/java/lcm.jar
.PHONY: examples
examples:
	@if command -v javac > /dev/null && [ -f $(lcm_jar) ]; then \
		$(MAKE) -s build/examples/java/PosedPair.class; \
	else echo 'make $@: there is no javac, or no $(lcm_jar)'; fi

# The folder is removed first, since the classes of removed types would stay.
build/examples/java/PosedPair.class: clients/examples/PosedPair.java tests/system/Largest.java $(message_files) Makefile
	@rm -rf build/examples/java
	@mkdir -p $(@D)
	$(call say,LCM,$(@D)) lcm-gen -j --jpath $(@D) $(message_files)
	$(call say,JAVAC,$@) javac -Xlint:all,-cast,-rawtypes -cp $(lcm_jar):$(@D) -d $(@D) $(filter %.java,$^)

# ---- Tests and measurements ----

include tests/tests.mk

# ---- Headers and format ----

sources := $(shell find service msgs clients tests -name '*.[ch]')
# Every header compiles alone: here, or in a file of its folder that begins with it.
.PHONY: headers format format-check
begun_with := $(shell awk '/^\#define/ { nextfile } /^\#include "/ { folder = FILENAME; sub("[^/]*$$", "", folder); \
	gsub("\"", "", $$2); print folder $$2; nextfile }' $(filter %.c,$(sources)))
headers: $(patsubst %,$(O)/%.ok,$(filter-out tests/unit/% tests/robot/% tests/checked/number/% $(begun_with), \
	$(filter %.h,$(sources))))
$(O)/%.h.ok: %.h $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(call say,CC,$<) $(CC) $(flags) $(user_flags) $(sees) -fsyntax-only -x c $<
	@touch $@
formatted := $(sources) $(shell find tests -name '*.cc' -o -name '*.hpp')
# Versions of clang-format format some lines differently.
formatter := 14
formats = clang-format --version | grep -q 'version $(formatter)\.'
format:
	@$(formats) || { echo "make $@: needs clang-format $(formatter)" >&2; exit 1; }
	@clang-format -i $(formatted)
format-check:
	@if $(formats); then clang-format --dry-run -Werror $(formatted); \
	else echo "make $@: nothing checked: needs clang-format $(formatter)"; fi

# ---- Demo, installation ----

.PHONY: demo
demo: # builds on all cores, also where packages are installed first
	+@$(MAKE) --no-print-directory $(if $(filter -j%,$(MAKEFLAGS)),,-j$$(nproc)) programs
	@clients/demo/run.sh $(B)

sed_text = $(subst |,\|,$(subst &,\&,$(subst \,\\,$1)))
fill_in = sed -e 's|@PREFIX@|$(call sed_text,$(PREFIX))|' -e 's|@LIBDIR@|$(call sed_text,$(LIBDIR))|' \
	-e 's|@VERSION@|$(VERSION)|' -e 's|@SOVERSION@|$(SOVERSION)|g' -e 's|@PREFIX_FROM_LIBDIR@|$(call sed_text,$(shell \
	realpath -m --relative-to="$(LIBDIR)" "$(PREFIX)"))|'
# Sets the mode before the text is written, whatever the umask.
filled = $(INSTALL) -m 644 /dev/null $1 && $2 > $1
root := $(DESTDIR)$(PREFIX)
# $(call needs,VARIABLE,FOLDER,FOLDERS): prints how to set VARIABLE, unless the searched FOLDERS contain FOLDER.
needs = case ":$3:" in *":$2:"*) ;; *) printf '  export %s="%s$${%s:+:$$%s}"\n' $1 "$2" $1 $1 ;; esac;
of_system := $(filter /usr/lib% /usr/local/lib%,$(LIBDIR))
.PHONY: install install-strip uninstall
install: all
	$(INSTALL) -d $(foreach d,bin include share/fmb/lcmtypes share/doc/fmb share/man/man1 share/man/man8 \
		share/bash-completion/completions lib/systemd/system,"$(root)/$d") \
		"$(DESTDIR)$(LIBDIR)/pkgconfig" "$(DESTDIR)$(LIBDIR)/cmake/fmb" "$(DESTDIR)$(PYTHONDIR)"
	$(INSTALL) $(strip_option) $(programs) "$(root)/bin"
	$(INSTALL) clients/robot/fmb-check-path "$(root)/bin"
	$(INSTALL) -m 644 $(B)/libfmb.a $(B)/libfmb-client.a $(B)/libfmb-robot.a "$(DESTDIR)$(LIBDIR)"
	$(INSTALL) $(strip_option) -m 644 $(shared_libraries) "$(DESTDIR)$(LIBDIR)"
	for name in fmb fmb-client fmb-robot; do \
		ln -sf lib$$name.$(so) "$(DESTDIR)$(LIBDIR)/lib$$name.so" || exit; done
	$(if $(DESTDIR),,$(if $(of_system),[ $$(id -u) != 0 ] || ldconfig))
	$(INSTALL) -m 644 service/fmb/fmb.h service/fmb/fmb_batch.h clients/lib/fmb_client.h \
		clients/robot/fmb_robot.h clients/python/fmb_flat.h "$(root)/include"
	$(call filled,"$(DESTDIR)$(PYTHONDIR)/fmb.py",sed '/SONAME = /s/\.so"/.$(so)"/' clients/python/fmb.py)
	$(INSTALL) -m 644 $(message_files) "$(root)/share/fmb/lcmtypes"
	$(INSTALL) -m 644 LICENSE "$(root)/share/doc/fmb"
	$(INSTALL) -m 644 $(M)/*.1 "$(root)/share/man/man1"
	$(INSTALL) -m 644 $(M)/*.8 "$(root)/share/man/man8"
	for name in fmb fmbd; do $(INSTALL) -m 644 clients/manual/fmb.bash \
		"$(root)/share/bash-completion/completions/$$name" || exit; done
	$(call filled,"$(DESTDIR)$(LIBDIR)/pkgconfig/fmb.pc",$(fill_in) service/fmb/fmb.pc.in)
	$(call filled,"$(DESTDIR)$(LIBDIR)/pkgconfig/fmb-client.pc",$(fill_in) clients/lib/fmb-client.pc.in)
	$(call filled,"$(DESTDIR)$(LIBDIR)/pkgconfig/fmb-robot.pc",$(fill_in) clients/robot/fmb-robot.pc.in)
	for name in fmb-config fmb-config-version; do \
		$(call filled,"$(DESTDIR)$(LIBDIR)/cmake/fmb/$$name.cmake",$(fill_in) clients/lib/$$name.cmake.in) || exit; done
	$(call filled,"$(root)/lib/systemd/system/fmbd.service",$(subst %,%%,$(fill_in)) service/fmbd.service.in)
	@$(if $(DESTDIR)$(silent),:,{ $(if $(of_system),[ $$(id -u) = 0 ] || echo '  sudo ldconfig';) \
		$(call needs,PATH,$(PREFIX)/bin,$$PATH) \
		$(call needs,LD_LIBRARY_PATH,$(LIBDIR),$$LD_LIBRARY_PATH:$$(PATH=$$PATH:/usr/sbin:/sbin ldconfig -vN 2> /dev/null | \
			sed -n 's|^\(/[^:]*\):.*|\1|p' | paste -sd:)) \
		$(call needs,PKG_CONFIG_PATH,$(LIBDIR)/pkgconfig,$$PKG_CONFIG_PATH:$$(pkg-config --variable pc_path pkg-config)) \
		$(call needs,CMAKE_PREFIX_PATH,$(PREFIX),/usr:/usr/local:$$CMAKE_PREFIX_PATH) \
		$(call needs,PYTHONPATH,$(PYTHONDIR),$$($(python) -c 'import sys; print(":".join(sys.path))' 2> /dev/null)) } | \
		sed '1i to find what is installed:')

install-strip: strip_option := -s
install-strip: install

uninstall:
	cd "$(root)" && rm -rf bin/fmbd bin/fmb bin/fmb-check-path include/fmb.h include/fmb_batch.h \
		include/fmb_client.h include/fmb_robot.h include/fmb_flat.h share/fmb share/doc/fmb lib/systemd/system/fmbd.service \
		share/man/man1/fmb.1 share/man/man1/fmb-*.1 share/man/man8/fmbd.8 \
		share/bash-completion/completions/fmb share/bash-completion/completions/fmbd
	cd "$(DESTDIR)$(LIBDIR)" && rm -rf libfmb.a libfmb-client.a libfmb-robot.a \
		libfmb.so libfmb-client.so libfmb-robot.so $(notdir $(shared_libraries)) \
		pkgconfig/fmb.pc pkgconfig/fmb-client.pc pkgconfig/fmb-robot.pc cmake/fmb
	rm -f "$(DESTDIR)$(PYTHONDIR)"/fmb.py "$(DESTDIR)$(PYTHONDIR)"/__pycache__/fmb.*.pyc

.PHONY: deb deb-test
deb:
	.debian/build.sh $(VERSION) $(SOVERSION)
deb-test: deb programs
	FMB_BUILD=$(B) bats --tap tests/deb/deb.bats

# Makes the files to publish from the last commit. The packages are built from the tarball.
.PHONY: release
released := fmb-$(VERSION)
release:
	@grep -q '^## $(VERSION) ([0-9-]*)$$' .github/CHANGELOG.md || { \
		echo 'make $@: .github/CHANGELOG.md has no section "## $(VERSION) (DATE)"' >&2; exit 1; }
	@git diff --quiet HEAD || { echo 'make $@: there are uncommitted changes' >&2; exit 1; }
	rm -rf build/release
	mkdir -p build/release
	git archive --prefix=$(released)/ -o build/release/$(released).tar.gz HEAD
	tar -xzf build/release/$(released).tar.gz -C build/release
	$(MAKE) -C build/release/$(released) deb
	cd build/release && mv $(released)/build/deb/*.deb . && rm -r $(released) && sha256sum *.tar.gz *.deb > SHA256SUMS

.PHONY: clean
clean:
	rm -rf build

# ---- Packages ----

packages_deps := gcc libc6-dev liblcm-dev liblcm-bin libcjson-dev libexpat1-dev libgmp-dev \
	libglib2.0-dev libseccomp-dev zlib1g-dev pkg-config uthash-dev libjs-three
packages_deps-test := $(packages_deps) libcmocka-dev bats jq clang clang-format lld libclang-rt-dev \
	liblcm-java default-jdk-headless chromium libxml2-utils g++ cmake man-db \
	gnuplot-nox python3 python3-numpy python3-pandas
packages_deps-bench := $(packages_deps) g++ jq libccd-dev libfcl-dev libbullet-dev \
	libcgal-dev libmpfr-dev
packages_deps-fuzz := $(packages_deps) clang libclang-rt-dev lld llvm afl++
packages_deps-deb := $(packages_deps) build-essential debhelper dh-python python3 lintian bats debootstrap faketime
packages_deps-aarch64 := $(packages_deps) gcc-aarch64-linux-gnu libc6-dev-arm64-cross qemu-user
deps := deps deps-test deps-bench deps-fuzz deps-deb deps-aarch64

as_root = $$([ $$(id -u) = 0 ] || echo sudo)
.PHONY: $(deps)
$(deps):
	@command -v apt-get > /dev/null || { \
		echo 'make $@: no apt-get here; install what these Debian packages hold:' >&2; \
		echo '  $(packages_$@)' >&2; exit 1; }
	@missing=$$(for package in $(packages_$@); do \
		dpkg-query -W -f '$${db:Status-Abbrev}' $$package 2> /dev/null | grep -q '^ii' \
			|| echo $$package; done); \
	[ "$$missing" ] || { echo 'make $@: all packages are installed already'; exit 0; }; \
	$(as_root) apt-get update -q && \
		$(as_root) env DEBIAN_FRONTEND=noninteractive \
			apt-get install -q -y --no-install-recommends $$missing && \
		echo "make $@: installed" $$missing
	$(unpack_$@)

# In 'make deps demo' the packages come first, and in 'make clean all' the cleaning, whatever
# -j says.
ifneq ($(filter $(deps) clean,$(MAKECMDGOALS)),)
.NOTPARALLEL:
endif

.DELETE_ON_ERROR:
.SECONDARY:
-include $(shell find $(O) -name '*.d' 2> /dev/null)
