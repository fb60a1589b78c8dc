/* What the parts of levels.c share. */
#ifndef LEVELS_H
#define LEVELS_H

#include "../../examples/embed_host.h"
#include "stratavox.h"
#include <math.h>

enum { WIDTH = 64, HEIGHT = 48, VOXELS = 24, BYTES = WIDTH * HEIGHT * 4 };
#define FORMAT VK_FORMAT_R8G8B8A8_UNORM
static const float BEHIND[4] = {0.25f, 0.0f, 0.5f, 1.0f};

extern sv_diagnostic diagnostic;
extern host h;
extern sv_device device;
extern sv_volume volume;
extern unsigned failures;

/* Ends the program where the status is not SV_OK. */
void check(sv_status status, const char *what);
#define CHECK(call) check(call, #call)
/* Says it, and counts what is wrong. */
void expect(int is_right, const char *what);

/* The host's rendering to its image, and to a depth buffer that is cleared, where there is one. */
void begin_rendering(VkCommandBuffer cmd, VkImageView depth, float depth_value);
/* Ends and runs the command buffer: what was drawn. */
void fetch(VkCommandBuffer cmd, uint8_t *texels);
sv_transfer_function make_function(void);
sv_renderer make_renderer(const sv_settings *settings, sv_transfer_function function);
/* By level A. */
void draw_a(sv_renderer renderer, const sv_camera *camera, uint8_t *texels);
/* Pixels that are not of the host's colour alone. */
unsigned drawn_pixels(const uint8_t *texels);

sv_target whole_target(void);
/* By level B, and what lies there then. */
void draw_b(sv_renderer renderer, uint8_t *texels);

/* What is asked before there is a device, and a volume; a budget; a device that the host loses. */
void test_asked(const sv_host_device *ours);
/* New voxels of a box, frames in parts. */
void test_life(void);
/* A render pass of the host's, several samples, a queue family that is named. */
void test_passes(void);

/* What the host has drawn hides the volume, depth is written, picks come back. */
void test_depth(int is_reversed);

#endif
