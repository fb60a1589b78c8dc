# make test    what must hold after each change, on whatever Vulkan device is here (a software driver is installed
#              by apt where there is none): a line for each group of tests, what was skipped, and how many passed
# make test-more   what takes longer: the whole conformance baseline, also as on a device of Vulkan's least limits and on
#              SwiftShader (fetched by apt; skipped by name where that cannot be); the suite judged by injected faults and by
#              the CPU reference; what draws once more under the least limits; each barrier of the
#              examples taken away; many devices one after the other; other operating systems
# make sweep   all of what `make test` tries a share of: each filter, axis and random picture of the tests that draw many, and each
#              cut of a file
# make fresh   README's two commands, make test and make demo in a new clone without anything built or downloaded
# make plain   what draws once more, without validation
# make least   the same under the least limits that Vulkan allows
# make viewer  the tests of examples/viewer, in a window of a display without a screen (Xvfb is installed by apt where it is
#              missing)
# make demo    the built-in head with each technique, and with DATA=path a file of yours, into target/demo
# make pictures README's pictures
# make first-pictures   the volumes of make sheet and the phantoms, drawn without a flag and measured, into docs/first-pictures.md
# make gallery six real volumes by the classic techniques, into docs/gallery
# make conformance   whether the drivers here conform, SwiftShader beside them, into target/conformance
# make capi    the libraries for C, into target/release; make install PREFIX=/usr/local puts them, the header and a
#              file for pkg-config there; make header writes include/stratavox.h anew
# make api     compares what the library shows of itself with docs/public-api.txt
# make bench   frame times of each technique, mode and projection on this device
# make pairs   which pairs of features of the command line are drawn, and why not, into docs/pairs.md
# make gpu-cost   registers, spills, waves and estimated cycles of pipelines on three generations of AMD's chips, by the compiler of
#              RADV without a graphics card, into docs/gpu-cost.md

SHELL := /bin/bash
.DEFAULT_GOAL := test
.PHONY: test test-more sweep fresh lint build drawn-exact drawn-embedded command-line command-line-drawn without-device longer viewer-barriers \
    second conformance-default conformance-least conformance-swiftshader plain least least-shared conformance swiftshader swiftshader-unpacked demo pictures sheet first-pictures gallery capi install header api bench gpu-cost driver layers display

CARGO ?= cargo
ROOT := $(if $(filter 0,$(shell id -u)),,sudo )
APT := $(ROOT)env DEBIAN_FRONTEND=noninteractive apt-get
# Mesa compiles shaders on the CPU and keeps the result, and we keep pipelines: here, so that nothing is left
# behind elsewhere.
export MESA_SHADER_CACHE_DIR ?= $(CURDIR)/target/mesa-shader-cache
export XDG_CACHE_HOME ?= $(CURDIR)/target/cache
export DATA
# Packages of `stratavox conformance` say what the program was built from. Cargo links the program anew where it changes.
export STRATAVOX_COMMIT ?= $(shell git describe --always --dirty --exclude='*' --abbrev=40 2>/dev/null)

# A Vulkan driver is a manifest in one of the loader's folders; the loader is libvulkan.so.1.
ICD_FOLDERS := /usr/share/vulkan/icd.d /etc/vulkan/icd.d /usr/local/share/vulkan/icd.d $(HOME)/.local/share/vulkan/icd.d
LAYER_FOLDERS := /usr/share/vulkan/explicit_layer.d /etc/vulkan/explicit_layer.d /usr/local/share/vulkan/explicit_layer.d $(VK_LAYER_PATH)

driver:
	@mkdir -p "$$MESA_SHADER_CACHE_DIR"
	@if [ -n "$$VK_ICD_FILENAMES$$VK_DRIVER_FILES" ] || find $(ICD_FOLDERS) -name '*.json' 2>/dev/null | grep -q .; then \
	    wanted=""; else wanted="mesa-vulkan-drivers"; fi; \
	ldconfig -p 2>/dev/null | grep -q libvulkan.so.1 || wanted="$$wanted libvulkan1"; \
	$(call install,Vulkan driver)

layers:
	@find $(LAYER_FOLDERS) -name '*khronos_validation*.json' 2>/dev/null | grep -q . \
	    && wanted="" || wanted="vulkan-validationlayers"; \
	command -v spirv-val >/dev/null || wanted="$$wanted spirv-tools"; \
	echo '#include <vulkan/vulkan.h>' | cc -E - >/dev/null 2>&1 || ! command -v apt-get >/dev/null \
	    || wanted="$$wanted libvulkan-dev"; \
	$(call install,Vulkan validation layers)

# What a window needs that winit opens when it runs, by library and Debian's package.
WINDOW := libX11-xcb.so.1:libx11-xcb1 libXcursor.so.1:libxcursor1 libXi.so.6:libxi6 libxkbcommon-x11.so.0:libxkbcommon-x11-0

display:
	@wanted=""; command -v Xvfb >/dev/null || wanted="$$wanted xvfb"; \
	command -v xdotool >/dev/null || wanted="$$wanted xdotool"; \
	for pair in $(WINDOW); do \
	    ldconfig -p 2>/dev/null | grep -q "$${pair%%:*}" || wanted="$$wanted $${pair#*:}"; done; \
	$(call install,display without a screen)

# $(call install,what): installs the Debian packages in $$wanted, or says what to install by hand.
define install
if [ -n "$$wanted" ]; then \
    if ! command -v apt-get >/dev/null; then \
        echo "no $(1) found, and no apt-get to install it: please install what Debian calls$$wanted" >&2; exit 1; fi; \
    echo "installing the $(1):$$wanted"; \
    { $(APT) install -y --no-install-recommends $$wanted >/dev/null 2>&1 \
        || { $(APT) update -qq && $(APT) install -y --no-install-recommends $$wanted >/dev/null; }; } \
        || { echo "could not install the $(1): please run: $(APT) install $$wanted" >&2; exit 1; }; \
fi
endef

# The interface for C is off in what people install, who do not need it; its tests run like all others.
# The viewer is built with the library's features of all tests, and beside a test of the library that no device is for: else the
# library would be built once more, which takes minutes.
WITH_LIBRARY := --test bombs
# Most pipelines draw a small picture once: Mesa's compiler for the processor takes longer to optimize them than they run. What
# it makes of them by all of its passes is judged by the baseline of conformance.
TEST := GALLIVM_PERF=nopt $(CARGO) test --locked --workspace --features stratavox/capi

# What draws. `host` makes no device: its tests run side by side, and the validation layer has nothing to hear there.
WITH_DEVICE := exact relations matrix embed embed_allocations gpu faults capi examples
# What takes long is in the second tier: the suite judged by injected faults and by references, memory over many devices, each
# barrier of the examples taken away.
BARRIERS := example_barriers::
ON_DEVICE := RUST_TEST_THREADS=1 $(TEST)
# Of tests that pass too: some say what they have skipped.
SHOWN := -- --show-output
# One device at a time in a process; two processes, since small pictures keep one core busy, that of the driver's compiler.
# What draws runs under the validation layer with synchronization in; `make test-more` runs the same without that. A group
# that fails keeps no other from running; each ends with its counts, and the last lines say what was skipped (`.ci/group`).
test: driver layers display
	$(call in-groups,lint build,command-line drawn-embedded drawn-exact viewer without-device command-line-drawn)

# What takes longer.
test-more: driver layers display
	$(call in-groups,build,least-shared longer conformance-default conformance-swiftshader conformance-least portable \
	    soak-short second viewer-barriers)

# $(call in-groups,one after the other,two at a time)
in-groups = @rm -rf target/groups; for group in $(1); do \
	    .ci/group $$group $(MAKE) --no-print-directory $$group || true; done; \
	$(MAKE) --no-print-directory --jobs=2 --keep-going $(addprefix group-,$(2)); \
	.ci/group --summary $(1) $(2)

group-%:
	@.ci/group $* $(MAKE) --no-print-directory $*

# README's first commands as on a new machine: no packages of Rust's in a cache, nothing built. To be run whenever
# dependencies or the commands of the tests change.
fresh:
	@folder=$$(mktemp -d) && trap 'rm -rf "$$folder"' EXIT && git clone --quiet . "$$folder/stratavox" \
	    && cd "$$folder/stratavox" && export CARGO_HOME="$$folder/cargo" STRATAVOX_DATA="$(VOLUMES)" \
	    && unset CARGO_TARGET_DIR MESA_SHADER_CACHE_DIR XDG_CACHE_HOME \
	    && $(MAKE) driver && $(CARGO) install --locked --path . --root "$$folder/installed" \
	    && "$$folder/installed/bin/stratavox" render phantom:head -o "$$folder/head.png" \
	    && $(MAKE) test && $(MAKE) demo

lint:
	$(CARGO) fmt --all --check
	$(CARGO) clippy --locked --workspace --all-targets --features stratavox/capi -- -D warnings
	$(CARGO) clippy --locked --all-targets --no-default-features -- -D warnings
	RUSTDOCFLAGS="-D warnings" $(CARGO) doc --locked --no-deps --features capi

build:
	$(TEST) --no-run

drawn-exact:
	STRATAVOX_VALIDATION=sync $(ON_DEVICE) --no-fail-fast --lib --examples --test exact $(SHOWN)

drawn-embedded:
	STRATAVOX_VALIDATION=sync $(ON_DEVICE) --no-fail-fast $(addprefix --test ,$(filter-out exact,$(WITH_DEVICE))) $(SHOWN) \
	    --skip $(BARRIERS)

longer:
	STRATAVOX_SWEEP=long $(TEST) --test host $(SHOWN) format_cuts::
	STRATAVOX_VALIDATION=sync $(ON_DEVICE) --no-fail-fast --test conformance --test leaks $(SHOWN)
	STRATAVOX_VALIDATION=sync $(ON_DEVICE) --test examples $(SHOWN) $(BARRIERS)

sweep: driver layers
	STRATAVOX_SWEEP=long STRATAVOX_VALIDATION=sync $(ON_DEVICE) --no-fail-fast --test exact --test matrix --test relations $(SHOWN)
	STRATAVOX_SWEEP=long $(TEST) --test host $(SHOWN) format_cuts:: mutations

command-line:
	$(ON_DEVICE) --test cli $(SHOWN)

command-line-drawn:
	STRATAVOX_VALIDATION=sync $(ON_DEVICE) --test cli $(SHOWN) bench:: conformance::a_run conformance_runs::under_stress \
	    device:: mixed:: pictures::

without-device:
	$(TEST) --doc
	$(TEST) --no-fail-fast --test host $(SHOWN)

# A package of its own, with a window and a panel that nothing else needs.
viewer: driver layers display
	STRATAVOX_VALIDATION=sync $(ON_DEVICE) --no-fail-fast --bin stratavox-viewer --test lost --test window $(WITH_LIBRARY) $(SHOWN)

# Each of its barriers taken away.
viewer-barriers: driver layers display
	STRATAVOX_VALIDATION=sync $(ON_DEVICE) --test barriers $(WITH_LIBRARY) $(SHOWN)

plain: driver layers
	$(ON_DEVICE) --no-fail-fast --lib --examples $(addprefix --test ,$(WITH_DEVICE)) $(SHOWN) --skip $(BARRIERS)

# Limits clamped to Vulkan's least: the same pictures (`tests/shared/limits.rs`). Tests whose subject is limits of their own
# run without that.
NOT_LEAST := gpu matrix capi examples faults embed_allocations
# Images larger than the least device allows; a volume longer than its 256 texels, which is to lie in one texture.
WITH_MORE := codes:: fetches_are_those_of_the_reference_in_every_technique words_folded_over_many_rows_have_the_values_of_the_reference \
    distance_maps_hold_distances_to_the_nearest_cell_with_matter
# How good pictures are is no matter of limits; nor is what leaves bits as they are, but for bricks.
MEASURED := quality:: main_axis::seam:: pathtrace::noise:: denoise:: skipping:: skipping_beside:: skipping_slices:: skipping_voxels:: \
    what_rays_through_a_base_plane_leave_out_and_bricks_change_no_bit mixtures::hindered::references::
UNDER_LEAST := STRATAVOX_LIMITS=least RUST_TEST_THREADS=1 $(TEST)

least: least-shared
	$(UNDER_LEAST) --no-fail-fast --test exact $(SHOWN) $(addprefix --skip ,$(WITH_MORE) $(MEASURED))

# Of it what the baseline under the least limits has not: relations, hosts, and what reads limits itself.
least-shared: driver layers
	$(UNDER_LEAST) --no-fail-fast $(addprefix --test ,$(filter-out exact $(NOT_LEAST),$(WITH_DEVICE))) $(SHOWN) \
	    $(addprefix --skip ,$(WITH_MORE) $(MEASURED))
	$(ON_DEVICE) --no-fail-fast --test gpu --test capi $(SHOWN)
	$(ON_DEVICE) --test exact $(SHOWN) codes::

# A second driver, from Debian's chromium: unpacked, and not installed.
SWIFTSHADER := target/swiftshader/usr/lib/chromium/vk_swiftshader_icd.json

# The driver that Debian installs, and that one.
BOTH := $(firstword $(foreach folder,$(ICD_FOLDERS),$(wildcard $(folder)/lvp_icd*.json))):$(CURDIR)/$(SWIFTSHADER)

ON_SWIFTSHADER := VK_DRIVER_FILES=$(CURDIR)/$(SWIFTSHADER) VK_ICD_FILENAMES=$(CURDIR)/$(SWIFTSHADER)

# Two groups of tests may want it at once, and half a package is none: it is unpacked beside its place.
swiftshader:
	@mkdir -p target && exec flock target/swiftshader.lock $(MAKE) --no-print-directory swiftshader-unpacked

swiftshader-unpacked:
	@[ -f $(SWIFTSHADER) ] || { rm -rf target/swiftshader target/swiftshader.part && mkdir target/swiftshader.part \
	    && cd target/swiftshader.part \
	    && { apt-get download -qq chromium-common || { $(APT) update -qq && apt-get download -qq chromium-common; }; } \
	    && dpkg -x chromium-common_*.deb . && rm -f chromium-common_*.deb && cd $(CURDIR) \
	    && mv target/swiftshader.part target/swiftshader && [ -f $(SWIFTSHADER) ]; }

# Whether the second driver is there, or a line that says why what is asked of it is skipped.
with-second = if ! why=$$($(MAKE) --no-print-directory swiftshader 2>&1); then \
	    echo "skipped: SwiftShader could not be fetched: $$why"; exit 0; fi

# The library's own tests on it: those of the device layer, and those of hosts, which compare each level with the offscreen
# picture.
second:
	@$(with-second); export $(ON_SWIFTSHADER); \
	RUST_TEST_THREADS=1 $(TEST) --no-fail-fast --test gpu --test embed $(SHOWN) \
	    run:: limits:: flight:: formats:: geometry:: levels:: pictures:: stale:: targets:: \
	    && VK_DRIVER_FILES=$(BOTH) VK_ICD_FILENAMES=$(BOTH) $(TEST) --test cli $(SHOWN) two_drivers

# $(call judged,name,arguments): the whole baseline by the program of the tests.
judged = mkdir -p target/conformance && target/debug/stratavox conformance --force --jobs 1 --timeout 600 \
	    --waivers docs/conformance-waivers.json --json target/conformance/$(1).json $(2)
verified = target/debug/stratavox conformance verify target/conformance/$(1).json

conformance-default:
	$(call judged,default)
	$(call verified,default)

# No more than Vulkan demands of every device: what cannot be drawn then is refused by name. A package of lowered limits says
# nothing of the device, and is not verified.
conformance-least:
	$(call judged,least,--limits vulkan-minimum)

conformance-swiftshader:
	@$(with-second); export $(ON_SWIFTSHADER); $(call judged,swiftshader) && $(call verified,swiftshader)

# Each run must be well, and each package whole; how they differ is told.
conformance: driver swiftshader
	$(CARGO) build --locked --release
	@mkdir -p target/conformance
	set -e; judge() { \
	    target/release/stratavox conformance --force --waivers docs/conformance-waivers.json \
	        --json target/conformance/$$1.json --junit target/conformance/$$1.xml --html target/conformance/$$1; \
	    target/release/stratavox conformance verify target/conformance/$$1.json; }; \
	judge default; \
	export $(ON_SWIFTSHADER); judge swiftshader
	target/release/stratavox conformance diff target/conformance/default.json target/conformance/swiftshader.json || true

demo: driver
	$(CARGO) build --locked --release
	@mkdir -p target/demo; set -e; \
	draw() { target/release/stratavox render --force --progress none "$$@"; }; \
	for input in phantom:head "$$DATA"; do \
	    [ -n "$$input" ] || continue; \
	    name=$$(basename "$${input#*:}"); name=target/demo/$${name%%.*}; \
	    for technique in raycast slices-3d slices-2d; do \
	        draw "$$input" --technique $$technique -o $$name-$$technique.png; \
	    done; \
	    draw "$$input" --mode mip -o $$name-mip.png; \
	done; \
	echo "the pictures:"; ls -1 $(CURDIR)/target/demo/*.png

# README's pictures, by the commands below them.
pictures: driver
	$(CARGO) build --locked --release
	cd docs && ../target/release/stratavox render phantom:head --size 480x360 --force -o head.png
	cd docs && ../target/release/stratavox render phantom:head --mode mip --size 480x360 --force -o head-mip.png

# The real volumes that the tests read, each drawn without a flag, into docs/sheet.png.
VOLUMES ?= $(or $(STRATAVOX_DATA),$(abspath ../shared/data))
SHEET ?= ct-cranium/cranium.nrrd ct-cranium/cranium-label.nrrd ct-headsq/quarter.nhdr vti-headsq/headsq.vti \
    vti-headsq/headsq-inline.vti ct-walnut/walnut.mhd ct-torso/torso-2x.mha ct-teapot/teapot.nrrd \
    dicom-ct-head dicom-ct-torso dicom-pet \
    mri-ch2/ch2.nii.gz mri-ch2/aal.nii.gz mri-mni152/mni152-t1.nii.gz mri-avg152-be/avg152T1_RL_nifti.nii.gz \
    mri-flair-oblique/FLAIR.nrrd fmri-4d/example4d.nii.gz asl-4d/mpld_asl.nii.gz mri-small/HeadMRVolume.mhd \
    mri-brainsmall/brainsmall.nhdr label-frog/frogtissue.mhd nucleon/nucleon.nrrd flow-aneurysm/sense_10.h5,variable=volume_0 flow-aneurysm/sense_10.h5,variable=volume_1 \
    tiff-nuclei/img3d.tif tiff-nuclei/mask3d.tif tiff-beads/Bead_Image1_crop.tif seismic-f3/f3.nrrd \
    met-wrf/wrf_ci.nc,variable=T met-wrf/wrf_ci.nc,variable=QVAPOR met-wrf/wrf_ci.nc,variable=W \
    met-wrf/wrf_ci.nc,variable=QCLOUD met-ifs-ml/forecast_ml.nc,variable=t met-ifs-ml/forecast_ml.nc,variable=q met-era5-zarr/era5-members.zarr,variable=t[number=0]

sheet: driver
	@[ -d "$(VOLUMES)" ] || { echo "VOLUMES=folder names the volumes" >&2; exit 1; }
	$(CARGO) build --locked --release
	cd "$(VOLUMES)" && $(CURDIR)/target/release/stratavox sheet --force --columns 6 -o $(CURDIR)/docs/sheet.png $(SHEET)

# What people see first, measured.
PHANTOMS := $(addprefix phantom:,sphere gauss marschner-lobb head fog shells storm cells)
first-pictures: driver
	@[ -d "$(VOLUMES)" ] || { echo "VOLUMES=folder names the volumes" >&2; exit 1; }
	$(CARGO) build --locked --release --bins --example first_pictures
	target/release/examples/first_pictures target/release/stratavox docs/first-pictures.md $$(git rev-parse --short HEAD) \
	    $(addprefix $(VOLUMES)/,$(SHEET)) $(PHANTOMS)

gallery: driver
	@[ -d "$(VOLUMES)" ] || { echo "VOLUMES=folder names the volumes" >&2; exit 1; }
	$(CARGO) build --locked --release
	docs/gallery/draw.sh target/release/stratavox "$(VOLUMES)"

# The libraries for C are made when they are asked for: their types stand here, and not in Cargo.toml, where they would
# be linked in each build.
PREFIX ?= /usr/local
LIBDIR ?= $(PREFIX)/lib
VERSION := $(shell sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)

# Programs look for the name that the library says of itself; it changes where the interface does.
SONAME := libstratavox.so.1

capi:
	$(CARGO) rustc --locked --release --lib --no-default-features --features capi --crate-type cdylib,staticlib -- \
	    -C link-arg=-Wl,-soname,$(SONAME)

install: capi
	install -d $(DESTDIR)$(PREFIX)/include $(DESTDIR)$(LIBDIR)/pkgconfig
	install -m 644 include/stratavox.h $(DESTDIR)$(PREFIX)/include
	install -m 755 target/release/libstratavox.so $(DESTDIR)$(LIBDIR)/libstratavox.so.$(VERSION)
	ln -sf libstratavox.so.$(VERSION) $(DESTDIR)$(LIBDIR)/$(SONAME)
	ln -sf $(SONAME) $(DESTDIR)$(LIBDIR)/libstratavox.so
	install -m 644 target/release/libstratavox.a $(DESTDIR)$(LIBDIR)
	sed -e 's|@PREFIX@|$(PREFIX)|' -e 's|@LIBDIR@|$(LIBDIR)|' -e 's|@VERSION@|$(VERSION)|' include/stratavox.pc.in \
	    > $(DESTDIR)$(LIBDIR)/pkgconfig/stratavox.pc

header:
	cbindgen --quiet --config include/cbindgen.toml --output include/stratavox.h .

api:
	$(CARGO) test --locked --no-default-features --test host -- --ignored public_api::

pairs: driver
	$(ON_DEVICE) --test cli -- --ignored pairs::write_the_page

bench: driver
	$(CARGO) build --locked --release
	target/release/stratavox bench

# Without the program's features the library is built soonest.
gpu-cost: driver layers
	$(CARGO) run --locked --no-default-features --example gpu_cost -- docs/gpu-cost.md

# make soak      devices and renderers made, drawn with and destroyed LOOPS times: memory of ours, of the process, open files
# make portable  what the compiler says of Windows, macOS and Android; a target that rustup cannot install is skipped by name
.PHONY: soak soak-short portable pairs
LOOPS ?= 10000

soak: driver
	STRATAVOX_LOOPS=$(LOOPS) $(ON_DEVICE) --test leaks -- --nocapture take_no_more_memory

soak-short:
	@$(MAKE) --no-print-directory soak LOOPS=200

# No cross compiler for C is wanted: of what is checked nothing is C. Telephones have the library, and no command line.
TARGETS ?= x86_64-pc-windows-gnu aarch64-apple-darwin aarch64-linux-android

portable:
	@set -e; for target in $(TARGETS); do \
	    if ! why=$$(rustup target add $$target 2>&1); then \
	        echo "skipped: $$target, for which rustup installs no library: $$(tail -1 <<< "$$why")"; continue; fi; \
	    echo "portability, $$target"; \
	    case $$target in *-android) features=--no-default-features;; *) features="";; esac; \
	    RUSTFLAGS="-D warnings" $(CARGO) check --locked --package stratavox --quiet --target $$target $$features --features capi; \
	    done
