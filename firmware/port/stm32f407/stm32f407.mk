# The images for the STM32F407: one for each board, and those that run in QEMU.
#
#   $(BUILD)/disc1.elf, .bin        STM32F407G-DISC1
#   $(BUILD)/f407vet6.elf, .bin     black F407VET6
#   $(BUILD)/emulator.elf           QEMU, 40 kHz ticks
#   $(BUILD)/emulator-200khz.elf    QEMU, the ticks of silicon: ten times slower than time

PORT := port/stm32f407
ARM := arm-none-eabi-

ARM_CFLAGS := -mthumb -mcpu=cortex-m4 -mfpu=fpv4-sp-d16 -mfloat-abi=hard -O2 -g \
    -ffreestanding -fno-math-errno -ffunction-sections -fdata-sections
ARM_LDFLAGS := -nostartfiles -specs=nano.specs -T $(PORT)/stm32f407.ld \
    -Wl,--gc-sections -Wl,--fatal-warnings -Wl,--build-id=none

# The same bytes wherever it is built.
MAPPED := '-ffile-prefix-map=$(BUILD)=build' '-ffile-prefix-map=$(CURDIR)=.'

PORT_C := $(wildcard $(PORT)/*.c)

# A number that an unchanged source gives on every machine.
ALL_SOURCES := $(sort Makefile $(wildcard core/* hal/* $(PORT)/*.* $(PORT)/*/*.*))
BUILD_NAME := $(shell cat $(ALL_SOURCES) | sha256sum | cut -c 1-12)
BUILD_NAME_LINE := \#define BUILD_NAME "$(BUILD_NAME)"

$(BUILD)/build_name.h: FORCE
	@mkdir -p $(@D)
	@echo '$(BUILD_NAME_LINE)' | cmp -s - $@ || echo '$(BUILD_NAME_LINE)' > $@

# $(call image,NAME,BOARD HEADER,FOLDER OF WHAT DIFFERS,MORE FLAGS)
define image
$(1)_OBJECTS := $$(patsubst %.c,$$(BUILD)/$(1)/%.o,$$(CORE) $$(PORT_C) $$(wildcard $$(PORT)/$(3)/*.c))

$$(BUILD)/$(1)/%.o: %.c Makefile $$(PORT)/stm32f407.mk | $$(BUILD)/build_name.h
	@mkdir -p $$(@D)
	$$(ARM)gcc -std=c11 $$(WARNINGS) $$(ARM_CFLAGS) $$(MAPPED) -MMD -MP -Icore -Ihal \
	    -I$$(PORT) -I$$(PORT)/$(3) -I$$(BUILD) -DBOARD_HEADER='"boards/$(2).h"' $(4) \
	    -c $$< -o $$@

$$(BUILD)/$(1).elf: $$($(1)_OBJECTS) $$(PORT)/stm32f407.ld
	$$(ARM)gcc $$(ARM_CFLAGS) $$(ARM_LDFLAGS) $$($(1)_OBJECTS) -lm -o $$@.new
	@if $$(ARM)nm $$@.new | grep -E ' __aeabi_([fd]|c[fd]|u?[il]2[fd])' >&2; then \
	    echo '$(1): error: soft floats' >&2; exit 1; fi
	@mv $$@.new $$@
	@$$(ARM)size $$@

-include $$($(1)_OBJECTS:.o=.d)
endef

$(eval $(call image,disc1,disc1,silicon))
$(eval $(call image,f407vet6,f407vet6,silicon))
$(eval $(call image,emulator,emulator,emulator))
$(eval $(call image,emulator-200khz,emulator,emulator,-DTICK_HZ=200000u))

$(BUILD)/%.bin: $(BUILD)/%.elf
	$(ARM)objcopy -O binary $< $@

.PHONY: disc1 f407vet6 emulator FORCE
disc1: $(BUILD)/disc1.elf $(BUILD)/disc1.bin
f407vet6: $(BUILD)/f407vet6.elf $(BUILD)/f407vet6.bin
emulator: $(BUILD)/emulator.elf
