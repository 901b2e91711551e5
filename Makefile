# The FMB query service. Two commands for a bare Debian machine:
#
#   make deps demo          installs what building needs, then lets the service answer a scene
#   make deps-test test     installs what the tests need, then runs them
#
# Others: all, tests (builds them), test-fast, validate, accuracy, bench, headers, format,
# format-check, install, clean.
# MODE=release|debug|asan.
# CC, CPPFLAGS, CFLAGS, LDFLAGS, PREFIX and DESTDIR are the user's.

VERSION := 0.1.0
MODE ?= release
ifeq ($(origin CC),default)
CC := gcc
endif
CFLAGS ?=
CPPFLAGS ?=
LDFLAGS ?=
PREFIX ?= /usr/local
DESTDIR ?=
INSTALL ?= install
OBJCOPY ?= objcopy

# What the default mode builds lies in build/, what another mode or compiler does beside it.
compiler := $(notdir $(firstword $(CC)))
variant := $(MODE)$(if $(filter-out gcc cc,$(compiler)),-$(compiler))
B := $(if $(filter release,$(variant)),build,build/$(variant))
O := build/obj/$(variant)
GEN := build/msgs

mode_flags_release := -O2 -g1 -DNDEBUG
mode_flags_debug := -O0 -g3
mode_flags_asan := -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all \
	-fno-omit-frame-pointer
ifeq ($(mode_flags_$(MODE)),)
$(error MODE is release, debug or asan)
endif
mode_link_asan := -fsanitize=address,undefined

# -ffp-contract=off: the same bits on every machine.
flags := -std=c17 -D_POSIX_C_SOURCE=200809L -DFMB_VERSION='"$(VERSION)"' -ffp-contract=off -g \
	-Wall -Wextra -Wshadow -Wvla -Wstrict-prototypes -Wmissing-prototypes -Wwrite-strings \
	$(if $(WERROR),-Werror) $(mode_flags_$(MODE)) $(CPPFLAGS) $(CFLAGS)
link_flags := $(mode_link_$(MODE)) $(CFLAGS) $(LDFLAGS)
compile = $(CC) $(flags) -MMD -MP -c $< -o $@

# ---- The parts, and who may see whom: an arrow in the wrong direction fails to build ----

lib_objects := $(patsubst %.c,$(O)/%.o,$(wildcard service/fmb/*.c))
message_names := frame_t pair_query_t pair_result_t status_t
message_objects := $(message_names:%=$(O)/msgs/fmb_msgs_%.o)
message_headers := $(message_names:%=$(GEN)/fmb_msgs_%.h)
bus_objects := $(addprefix $(O)/service/,wire.o bus.o clock.o random_id.o signals.o)
server_objects := $(addprefix $(O)/service/,server.o answer.o cache.o senders.o histogram.o)
client_objects := $(patsubst %.c,$(O)/%.o,$(filter-out clients/fmb.c,$(wildcard clients/*.c)))

programs := $(B)/fmbd $(B)/fmb
demo_programs := $(B)/netns $(B)/arm
test_programs := $(B)/poke $(B)/validate $(B)/accuracy $(B)/accuracy-planted

.PHONY: all
all: $(programs) $(B)/libfmb.a $(demo_programs)

# One object that shows the names of fmb.h alone, so that no program's own names meet ours.
$(B)/libfmb.a: $(lib_objects)
	@mkdir -p $(@D)
	$(CC) -r -nostdlib -o $(O)/libfmb.o $^
	$(OBJCOPY) --wildcard --keep-global-symbol='fmb_*' $(O)/libfmb.o
	rm -f $@
	$(AR) rcs $@ $(O)/libfmb.o

$(B)/fmbd: $(O)/service/main.o $(server_objects) $(bus_objects) $(message_objects) $(B)/libfmb.a
	$(CC) $(link_flags) -o $@ $^ -llcm -lgmp -lm

$(B)/fmb: $(O)/clients/fmb.o $(client_objects) $(bus_objects) $(message_objects) $(B)/libfmb.a
	$(CC) $(link_flags) -o $@ $^ -lcjson -llcm -lgmp -lm

$(B)/arm: $(O)/clients/demo/arm.o
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -lm

$(B)/netns: $(O)/clients/demo/netns.o
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^

# The engine sees nothing but itself, GMP and libc.
$(O)/service/fmb/%.o: service/fmb/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile)

$(O)/service/%.o: service/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) -Iservice -I$(GEN)

$(O)/clients/%.o: clients/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -Iclients -Iservice -Iservice/fmb

$(O)/tests/system/%.o: tests/system/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -Itests/hostile

# lcm-gen's own code is not ours to warn about.
$(O)/msgs/%.o: $(GEN)/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) -w

$(foreach m,$(message_names),$(GEN)/fmb_msgs_$(m).c $(GEN)/fmb_msgs_$(m).h) &: \
		$(message_names:%=msgs/%.lcm)
	@mkdir -p $(GEN)
	lcm-gen -c --c-cpath $(GEN) --c-hpath $(GEN) $^

# Changes when the flags or the lists of files do, and then everything is built again.
settings := $(CC) $(flags) $(link_flags) $(lib_objects) $(client_objects)
$(O)/settings: Makefile FORCE
	@mkdir -p $(@D)
	@echo '$(subst ','\'',$(settings))' | cmp -s - $@ && [ $@ -nt Makefile ] || \
		echo '$(subst ','\'',$(settings))' > $@
.PHONY: FORCE

# ---- Tests ----------------------------------------------------------------------------------

unit_names := $(patsubst tests/unit/%.c,%,$(wildcard tests/unit/test_*.c))
unit_tests := $(unit_names:%=$(B)/tests/%)
hostile_objects := $(O)/tests/hostile/hostile.o
oracle_objects := $(patsubst %.c,$(O)/%.o,$(wildcard tests/oracle/*.c))
engine_tests := $(filter test_engine_% test_frame test_oracle test_integer,$(unit_names))
# Those that see inside of it.
internal_tests := test_bounds test_limbs test_outward

$(B)/poke: $(O)/tests/system/poke.o $(hostile_objects) $(message_objects)
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -llcm

# Tests of the engine link neither LCM nor the service.
$(engine_tests:%=$(B)/tests/%): $(B)/tests/%: $(O)/tests/unit/%.o $(oracle_objects) $(B)/libfmb.a
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -lcmocka -lgmp -lm

# slabs.c is there three times: as it is, with fused operations (which a compiler makes only where
# it optimises), with a bound that is wrong.
$(internal_tests:%=$(B)/tests/%): $(B)/tests/%: $(O)/tests/unit/%.o $(O)/tests/unit/slab_truth.o \
		$(O)/slabs/fused.o $(O)/slabs/planted.o $(oracle_objects) $(lib_objects)
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -lcmocka -lgmp -lm

slabs_names := slabs_prepare slabs_filter slabs_list slabs_refine slab_inequalities
slabs_fused := -ffp-contract=fast $(if $(filter x86_64%,$(shell $(CC) -dumpmachine)),-mfma)
slabs_planted := -DSLABS_ROUNDING=0x1p-54
$(O)/slabs/fused.o $(O)/slabs/planted.o: $(O)/slabs/%.o: service/fmb/slabs.c $(O)/settings
	@mkdir -p $(@D)
	$(subst $(mode_flags_$(MODE)),$(mode_flags_release),$(compile)) -DINLINED_NOT $(slabs_$*) \
		$(foreach f,$(slabs_names),-D$f=$*_$f)

$(filter-out $(patsubst %,$(B)/tests/%,$(engine_tests) $(internal_tests)),$(unit_tests)): \
		$(B)/tests/%: $(O)/tests/unit/%.o $(hostile_objects) $(server_objects) \
		$(client_objects) $(bus_objects) $(message_objects) $(B)/libfmb.a
	@mkdir -p $(@D)
	$(CC) $(link_flags) -o $@ $^ -lcmocka -lcjson -llcm -lgmp -lm

$(O)/tests/oracle/%.o: tests/oracle/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -Iservice/fmb -Itests/oracle

$(O)/tests/hostile/%.o: tests/hostile/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) -I$(GEN)

$(O)/tests/unit/%.o: tests/unit/%.c $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(compile) -Iservice/fmb $(if $(filter $*,$(engine_tests) $(internal_tests) slab_truth),\
		-Itests/oracle,-Iservice -Iclients -Itests/hostile -I$(GEN))

.PHONY: tests test test-fast check
tests: all $(test_programs) $(unit_tests)

# The script builds what it tests: release, and asan with gcc and with clang.
ifneq ($(filter test check test-fast,$(MAKECMDGOALS)),)
ifneq ($(variant),release)
$(error 'make test' chooses modes and compilers itself: leave out MODE and CC)
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

# With a bound on rounding that is wrong, which the campaign must find.
$(B)/accuracy-planted: $(O)/tests/campaign/accuracy.o $(campaign_objects) \
		$(lib_objects:%/slabs.o=$(O)/planted/slabs.o)
	@mkdir -p $(@D)
	$(CC) $(link_flags) -pthread -o $@ $^ -lgmp -lm

# Sanitizers would take long for what another object of theirs has seen.
$(O)/planted/slabs.o: service/fmb/slabs.c $(O)/settings
	@mkdir -p $(@D)
	$(subst $(mode_flags_$(MODE)),$(mode_flags_release),$(compile)) -DINLINED_NOT \
		-DSLABS_ROUNDING=0x1p-70

$(O)/tests/campaign/%.o: tests/campaign/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -pthread -Iservice/fmb -Itests/oracle

# validate: minutes; accuracy: most of an hour, on two cores.
.PHONY: validate accuracy
validate: $(B)/validate
	$<

accuracy: $(B)/accuracy
	$< --json $<.json

# ---- Benchmark -------------------------------------------------------------------------------

bench_objects := $(patsubst %.c,$(O)/%.o,$(wildcard tests/bench/*.c))

$(B)/bench: $(bench_objects) $(campaign_objects) $(lib_objects)
	@mkdir -p $(@D)
	$(CC) $(link_flags) -pthread -o $@ $^ -lgmp -lm

$(O)/tests/bench/%.o: tests/bench/%.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) -Iservice/fmb -Itests/oracle -Itests/campaign

.PHONY: bench
bench: $(B)/bench
	$<

# ---- Headers, format -------------------------------------------------------------------------

# Every header compiles alone.
sources := $(shell find service clients tests -name '*.[ch]')
headers := $(wildcard service/fmb/*.h service/*.h clients/*.h tests/oracle/*.h tests/hostile/*.h \
	tests/campaign/*.h tests/bench/*.h)
.PHONY: headers
headers: $(headers:%=$(O)/%.ok)
$(O)/%.h.ok: %.h $(O)/settings | $(message_headers)
	@mkdir -p $(@D)
	$(CC) $(flags) $(if $(filter tests/campaign/% tests/bench/%,$<),-Itests/oracle -Itests/campaign) \
		-Iservice -Iservice/fmb -Iclients -I$(GEN) -fsyntax-only -x c $<
	@touch $@

.PHONY: format format-check
format:
	@clang-format -i $(sources)
format-check:
	@clang-format --dry-run -Werror $(sources)

# ---- Demo, installation ------------------------------------------------------------------

.PHONY: demo
demo: all
	clients/demo/run.sh $(B)

.PHONY: install
install: all
	$(INSTALL) -d "$(DESTDIR)$(PREFIX)/bin" "$(DESTDIR)$(PREFIX)/lib/pkgconfig" \
		"$(DESTDIR)$(PREFIX)/include" "$(DESTDIR)$(PREFIX)/share/fmb/lcmtypes"
	$(INSTALL) $(programs) "$(DESTDIR)$(PREFIX)/bin"
	$(INSTALL) -m 644 $(B)/libfmb.a "$(DESTDIR)$(PREFIX)/lib"
	$(INSTALL) -m 644 service/fmb/fmb.h "$(DESTDIR)$(PREFIX)/include"
	$(INSTALL) -m 644 $(message_names:%=msgs/%.lcm) "$(DESTDIR)$(PREFIX)/share/fmb/lcmtypes"
	sed -e 's|@PREFIX@|$(PREFIX)|' -e 's|@VERSION@|$(VERSION)|' service/fmb/fmb.pc.in \
		> "$(DESTDIR)$(PREFIX)/lib/pkgconfig/fmb.pc"

.PHONY: clean
clean:
	rm -rf build

# ---- Packages ----------------------------------------------------------------------------

build_packages := gcc libc6-dev liblcm-dev liblcm-bin libcjson-dev libgmp-dev
test_packages := $(build_packages) libcmocka-dev bats jq clang clang-format libclang-rt-14-dev pkg-config

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
ifneq ($(filter deps deps-test clean,$(MAKECMDGOALS)),)
.NOTPARALLEL:
endif

.DELETE_ON_ERROR:
.SECONDARY:
.DEFAULT_GOAL := all

-include $(shell find build/obj/$(variant) -name '*.d' 2> /dev/null)
