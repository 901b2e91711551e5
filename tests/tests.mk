# What tests and measures the product: included by the Makefile, which has the flags, the archives and
# the rules to compile and to link.

# ---- Which folder may include from which ----

# The oracle shares no code with the engine, but the pair of frames that both are given.
see_tests/oracle := service/fmb service/fmb/frame
see_tests/campaign := tests/oracle $(call fmb,number frame filter limbs gap support turn decide)
see_tests/checked := tests/campaign $(see_tests/campaign)
see_tests/bench := tests/campaign tests/oracle $(call fmb,number frame filter article tree limbs gap support turn decide) \
	clients/common
see_tests/bench/peers := tests/bench
see_tests/encode := msgs/codec service/fmb service/answer
see_tests/bus := tests/encode tests/bench $(see_tests/bench) service $(see_service)
see_tests/robot := tests/bench tests/oracle service/fmb clients/robot
see_tests/hostile := $(GEN)
see_tests/path := clients clients/robot $(see_clients/robot)
see_tests/system := tests/hostile $(GEN)
see_tests/mesh := clients/mesh clients/common service/fmb
see_tests/logs := tests/encode tests/campaign tests/oracle service/answer $(wire) \
	$(call fmb,number frame filter) $(GEN)
see_tests/soak := tests/encode tests/hostile tests/campaign $(see_tests/campaign) clients/lib $(wire)
see_tests/replay := clients/replay $(see_clients/replay) tests/encode
see_tests/fuzz := tests/encode clients clients/common $(see_clients) tests/replay tests/hostile $(GEN)
see_tests/fuzz/planted := tests/fuzz $(see_tests/fuzz)
see_tests/unit/kernels := $(call fmb,number frame filter)
see_tests/unit := $(call fmb,number frame filter article tree limbs gap support turn certificate decide) service clients \
	$(see_clients) tests/encode tests/oracle tests/replay tests/campaign tests/checked tests/hostile tests/mesh \
	tests/path $(GEN)

# ---- Programs of tests and measurements: the name, and the main file in tests/ ----

test_programs := plain:system/plain busy:system/busy fake-peer:system/fake_peer events:system/events crash-liblcm:system/crash_liblcm \
	edit-log:replay/edit_log logs/generate:logs/generate logs/describe-log:logs/describe_log \
	mesh/make-mesh:mesh/make_mesh path-planted:path/planted $(foreach s,load memory rate blast fair relay families,soak-$s:soak/$s)
measures := accuracy:campaign/accuracy turning:campaign/turning checked:checked/checked \
	hull-poses:bench/hull_poses bench/bench:bench/bench bus/bench-bus:bus/bench_bus \
	bus/echo:bus/echo robot/robot:robot/robot
mains := $(foreach p,$(test_programs) $(measures),$(lastword $(subst :, ,$p)))
$(foreach p,$(test_programs) $(measures),$(eval \
	$(B)/$(firstword $(subst :, ,$p)): $(O)/tests/$(lastword $(subst :, ,$p)).o))
program_names = $(foreach p,$1,$(B)/$(firstword $(subst :, ,$p)))
test_programs := $(call program_names,$(test_programs))
measures := $(call program_names,$(measures)) $(B)/accuracy-planted

# What the programs of tests share, and what benchmarks and unit tests, which need cmocka, share besides.
# Programs that look into the engine link its objects, the others the library.
test_folders := $(addprefix tests/,encode oracle hostile campaign checked mesh path soak logs replay)
shared := $(O)/shared.a
$(shared): $(filter-out $(mains:%=$(O)/tests/%.o),$(call objects_in,$(test_folders)))
units := $(O)/units.a
$(units): $(filter-out %/leap_clock.o $(O)/tests/unit/test_%,$(call objects_in,tests/unit))
measuring := $(O)/measuring.a
$(measuring): $(filter-out $(mains:%=$(O)/tests/%.o) %/peers.o,$(call objects_in,$(addprefix tests/,bench bus robot)))
$(shared) $(units) $(measuring):
	@rm -f $@
	$(call say,AR,$@) $(AR) qcs $@ $^
looks_inside := accuracy turning checked bench/bench bus/bench-bus logs/generate soak-families
$(looks_inside:%=$(B)/%) $(B)/accuracy-planted: $(shared) $(client) $(product) $(engine)
$(filter-out $(looks_inside:%=$(B)/%),$(test_programs) $(measures)): \
	$(shared) $(client) $(product) $(B)/libfmb.a
$(measures): $(measuring)
$(test_programs) $(measures):
	$(link)

# The engine, compiled as C++ with numbers that carry bounds on their errors. It copies numbers that it does not
# use and has not set: they are 0 here, without a derivation.
checked_kernels := $(patsubst %.cc,$(O)/%.o,$(wildcard tests/checked/*.cc))
$(checked_kernels): $(O)/%.o: %.cc $(O)/settings
	@mkdir -p $(@D)
	$(call say,CXX,$<) $(CXX) -std=c++20 -fpermissive -fno-exceptions -O2 -ffp-contract=off -fPIC \
		-Wall -Wextra -Wno-missing-field-initializers \
		-ftrivial-auto-var-init=zero -MMD -MP -Itests/checked/number $(sees) -c $< -o $@
# Pointers of no type are converted in C only.
$(O)/tests/checked/checked_hulls.o: CXX += -w
$(B)/checked $(B)/tests/test_checked: $(checked_kernels)

# ---- Unit tests ----

# Only the release build has these: the code that they test is compiled without sanitizers in all modes, or they count
# work, simulate clients or test the oracle, and other tests execute the same code of the product.
release_tests := test_checked test_kernels test_engine_work test_hull_work test_fairness test_client_pace test_oracle \
	test_oracle_rounded
unit_names := $(filter-out $(if $(filter asan,$(MODE)),$(release_tests)), \
	$(patsubst tests/unit/%.c,%,$(wildcard tests/unit/test_*.c)))
unit_tests := $(unit_names:%=$(B)/tests/%)
internal_tests := $(addprefix $(B)/tests/,test_engine_batch \
	test_engine_tree test_limbs test_outward test_kernels \
	test_placing test_engine_work test_hull_frame test_hull_verdict \
	test_hull_gap test_hull_work test_hull_certificate test_checked)
comma := ,
wraps = $(addprefix -Wl$(comma)--wrap=,$1)
wraps_of_work := $(call wraps,$(addprefix __gmp,z_mul z_mul_si z_mul_2exp z_addmul z_submul \
	z_add z_sub z_fdiv_q z_tdiv_q z_tdiv_qr q_mul q_div q_add q_sub q_canonicalize) \
	integer_ratio_round)
wraps_test_engine_work := $(wraps_of_work) $(call wraps,limbs_span_of)
wraps_test_hull_work := $(wraps_of_work) $(call wraps,support_max support_list support_integers_place \
	support_integers_vertex certificate_write_number)
wraps_test_log_read := $(call wraps,pread64)
wraps_test_log_write := $(call wraps,fsync)
wraps_test_log_cut := $(call wraps,page_take pread64)
wraps_test_answer_scene := $(call wraps,malloc calloc realloc aligned_alloc)
wraps_test_bus := $(call wraps,bus_socket_drops sched_yield)
wraps_test_path := $(call wraps,path_bounds_of)
wraps_path-planted := $(wraps_test_path)

# Kernels are optimised in all modes.
compile_bare = $(subst $(mode_flags_$(MODE)),$(mode_flags_release),$(compile)) $(sees)

# Kernels of eight lanes in vectors that every machine has; and with bounds that are wrong.
tested_kernels := $(patsubst %.c,$(O)/%.o,$(wildcard tests/unit/kernels/*.c))
$(tested_kernels): flags += -O1
$(tested_kernels): $(O)/%.o: %.c $(O)/settings
	@mkdir -p $(@D)
	$(compile_bare) -ffp-contract=fast
$(B)/tests/test_kernels: $(tested_kernels)

# cmocka hands each test a state, which few read.
$(O)/tests/unit/%.o: flags += -Wno-unused-parameter
# Compiled fast: what they call takes the time, and sanitizers look for undefined behaviour there.
fast_asan := -O0 -fno-sanitize=undefined -fno-sanitize=fuzzer-no-link
fast_release := -O1
$(unit_names:%=$(O)/tests/unit/%.o): flags += $(fast_$(MODE))
$(internal_tests): $(units) $(shared) $(client) $(product) $(engine)
$(filter-out $(internal_tests),$(unit_tests)): $(units) $(shared) $(client) $(product) $(B)/libfmb.a
$(addprefix $(B)/tests/,test_bus test_client_bad test_client_raw test_server): $(O)/tests/unit/leap_clock.o
$(unit_tests): libraries += -lcmocka
$(unit_tests): $(B)/tests/%: $(O)/tests/unit/%.o | $(B)/netns
	$(link)

# ---- Fuzz targets: each a program that replays its corpus and, with MODE=asan, a fuzzer ----

fuzz_targets := robot_files pair_query pair_result scene_query scene_result definition_query definition status \
	answer scene_json event_log replay_log mesh
replayers := $(if $(filter asan,$(MODE)),,$(fuzz_targets:%=$(B)/tests/test_fuzz_%))
fuzzers := $(fuzz_targets:%=$(B)/fuzz_%)
# Each file of planted/ is a copy of one file with one fault, and has the name of the target that
# must find it, followed by a dash and a word where a target has several.
planted_fuzzers := $(patsubst tests/fuzz/planted/%.c,$(B)/planted/%,$(wildcard tests/fuzz/planted/*.c))
# Some targets replace an object of the product.
fuzz_pieces_scene_json := $(O)/tests/fuzz/exact_text.o
fuzz_pieces_event_log := $(O)/tests/fuzz/log_pieces.o
fuzz_target = $(firstword $(subst -, ,$1))
fuzz_archives := $(O)/fuzz.a $(shared) $(client) $(product) $(engine)
$(O)/fuzz.a: $(addprefix $(O)/tests/fuzz/,fuzz.o layout.o model.o same.o same_scene.o \
	results_pair.o results_scene.o)
	@rm -f $@
	$(call say,AR,$@) $(AR) rcs $@ $^
# Comparisons of numbers deep in the engine are not what inputs should be made for.
ifeq ($(MODE),asan)
$(engine_objects): flags += -O2 -fno-sanitize-coverage=trace-cmp
# Sanitizers look for faults of the product.
$(O)/tests/oracle/%.o $(O)/tests/campaign/%.o $(O)/tests/checked/%.o: flags += -fno-sanitize=all -fno-sanitize=fuzzer-no-link
endif
# The parts of a fuzz target are named in its rule by the stem.
.SECONDEXPANSION:
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

.PHONY: fuzzers fuzz fuzz-afl fuzz-merge
fuzzers: $(fuzzers) $(planted_fuzzers)
fuzz fuzz-afl fuzz-merge:
	tests/fuzz/fuzz.sh $@

# ---- Programs that take no more of the machine than their name says ----

capped_sets := plain $(if $(x86),two $(if $(INSTRUCTIONS),,avx2))
capped_most_plain := 1
capped_most_two := 2
capped_most_avx2 := 3
capped_programs := $(foreach p,fmbd fmb generate,$(capped_sets:%=$(B)/capped/$p-%))
$(capped_sets:%=$(O)/capped/%.o): $(O)/capped/%.o: service/fmb/filter/instructions.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) $(sees) -DINSTRUCTIONS_MOST=$(capped_most_$*)
$(capped_sets:%=$(B)/capped/fmbd-%): $(O)/service/main.o
$(capped_sets:%=$(B)/capped/fmb-%): $(O)/clients/fmb.o $(B)/libfmb-client.a
$(capped_sets:%=$(B)/capped/generate-%): $(O)/tests/logs/generate.o $(shared)
$(capped_programs): $(O)/capped/$$(lastword $$(subst -, ,$$@)).o $(product) $(engine)
	$(link)

# ---- AArch64: compiled here, and emulated ----

# Its libraries are unpacked into a folder of the build: installed, some would replace this machine's.
arm := aarch64-linux-gnu
arm_root := build/aarch64
arm_libraries := $(arm_root)/usr/lib/$(arm)
arm_includes := $(addprefix $(arm_root)/usr/include/,. $(arm))
arm_build := build/release-$(arm)-gcc
arm_programs := $(arm_build)/fmb $(arm_build)/logs/generate
unpack_deps-aarch64 := tests/unpack_aarch64.sh
.PHONY: aarch64
aarch64:
	@command -v $(arm)-gcc qemu-aarch64 > /dev/null && [ -d $(arm_libraries) ] || { \
		echo "make $@: 'make deps-aarch64' first" >&2; exit 1; }
	+$(MAKE) CC=$(arm)-gcc AR=$(arm)-ar OBJCOPY=$(arm)-objcopy \
		CPPFLAGS='$(arm_includes:%=-isystem %)' \
		LDFLAGS='-L$(arm_libraries) -Wl,-rpath-link,$(arm_libraries)' $(arm_programs)

# ---- Running the tests ----

.PHONY: tests fast-tests tested-programs unit-tests replay-set test test-fast check
tests: fast-tests examples $(measures)
fast-tests: tested-programs unit-tests $(capped_programs)
tested-programs: programs $(if $(filter asan,$(MODE)),,manual) $(test_programs)
unit-tests: $(unit_tests) $(replayers) $(B)/netns
replay-set: $(B)/fmb $(filter $(B)/capped/fmb-%,$(capped_programs))

# The script builds what it tests, in the modes that it says.
ifneq ($(filter test check test-fast,$(MAKECMDGOALS)),)
ifneq ($(variant),release)
$(error 'make test' chooses modes and compilers itself: leave out MODE and CC)
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

# CGAL changes the rounding mode (-frounding-math), and is told to use GMP and MPFR.
$(O)/tests/campaign/depth.o: tests/campaign/depth.cc $(O)/settings
	@mkdir -p $(@D)
	$(call say,CXX,$<) $(CXX) $(CPPFLAGS) -std=c++17 -O2 -DNDEBUG -frounding-math -DCGAL_USE_GMP -DCGAL_USE_MPFR -MMD -MP \
		$(sees) -c $< -o $@
$(B)/depth: $(O)/tests/campaign/depth.o $(shared) $(client) $(product) $(engine)
	$(link)
$(B)/depth: libraries += -lmpfr -lstdc++

# On two cores: accuracy takes hours, depth minutes, the others less than a minute.
.PHONY: accuracy depth checked hull-poses soak
depth: $(B)/depth
	$<
checked: $(B)/checked
	$<
hull-poses: $(B)/hull-poses
	$< 10000000
accuracy: $(B)/accuracy
	$< --json $<.json
# Some ten minutes, a minute for each trial or SECONDS=.
soak: programs $(filter $(B)/soak-% %/fake-peer %/crash-liblcm,$(test_programs))
	tests/soak/soak.sh $(B) $(SECONDS)

# Regenerates the hard logs of the regression set, and the results with which all logs are compared.
# tests/cli/logs.bats checks that this changes nothing.
.PHONY: logs goldens
logs: $(B)/logs/generate
	for kind in $$($< --list | cut -d ' ' -f 1); do $< $$kind tests/logs/$$kind.log || exit; done
goldens: $(B)/fmb
	for log in tests/logs/*.log; do \
		$< replay --force --write-golden $${log%.log}.golden $$log > /dev/null || \
			[ $$log = tests/logs/foreign.log ] || exit; done

# What the libraries promise to programs linked with them, written down anew; see the CHANGELOG.
.PHONY: abi
abi: $(shared_libraries)
	CC=$(CC) tests/system/abi.sh $(B) > tests/system/abi.txt

# ---- Benchmarks ----

# Other libraries are measured too where they are installed, unless PEERS=none.
installed = $(if $(PEERS),,$(shell for p in $1; do pkg-config --exists $$p && echo $$p; done 2> /dev/null))
bullet := $(firstword $(call installed,bullet-float64 bullet))
peer_packages := $(strip $(call installed,ccd fcl) $(bullet))
peer_libraries := $(peer_packages:%-float64=%)
peers := $(O)/peers/$(or $(subst $() ,_,$(strip $(peer_libraries))),none).o
$(peers): tests/bench/peers.c $(O)/settings
	@mkdir -p $(@D)
	$(compile) $(sees) -DPEER_LIBRARIES='$(patsubst %,X(%),$(peer_libraries))'
peer_flags_bullet = $$(pkg-config --cflags $(bullet))
$(O)/tests/bench/peers/%.o: tests/bench/peers/%.cc $(O)/settings
	@mkdir -p $(@D)
	$(call say,CXX,$<) $(CXX) $(or $(peer_flags_$*),$$(pkg-config --cflags $*)) -std=c++17 -O2 -DNDEBUG -MMD -MP \
		$(sees) -c $< -o $@
$(B)/bench/bench: $(peers) $(peer_libraries:%=$(O)/tests/bench/peers/%.o)
$(B)/bench/bench: libraries += $(if $(peer_packages),$$(pkg-config --libs $(peer_packages)) -lstdc++)

fcl := $(call installed,fcl)
$(B)/robot/robot: $(if $(fcl),$(O)/tests/robot/fcl.o)
$(B)/robot/robot: libraries += $(if $(fcl),$$(pkg-config --libs fcl) -lstdc++)
$(O)/tests/robot/fcl.o: tests/robot/fcl.cc $(O)/settings
	@mkdir -p $(@D)
	$(call say,CXX,$<) $(CXX) $$(pkg-config --cflags fcl) -std=c++17 -O2 -MMD -MP $(sees) -c $< -o $@
$(B)/bus/bench-bus: | $(B)/bus/echo $(B)/fmbd

# Minutes each. bench and bench-bus write what they measured to bench/report.json and bus/report.json.
.PHONY: bench bench-bus bench-commands speed-error
bench: $(B)/bench/bench $(B)/robot/robot
	$< --json $(B)/bench/report.json
	$(B)/robot/robot
bench-bus: $(B)/bus/bench-bus $(B)/netns
	$(B)/netns $< --json $(B)/bus/report.json

# Commands, on logs and meshes of some hundred megabytes in build/commands/.
bench-commands: programs $(B)/logs/generate $(B)/mesh/make-mesh
	tests/bench/commands.sh $(B) $(MESH)

# Draws the picture of tests/bench/README.md from what accuracy measured; runs no campaign.
speed-error:
	@[ -f $(B)/accuracy.json ] || { echo "make $@: there is no $(B)/accuracy.json: 'make accuracy' makes it" >&2; exit 1; }
	jq -r --rawfile css tests/report/picture.css -f tests/report/speed_error.jq $(B)/accuracy.json > tests/report/speed-error.svg
