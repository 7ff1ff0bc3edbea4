/*
 * device.c: one section of what one wants to know of a Vulkan device first.
 */
#include "bench/device/device.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/sheet.h"
#include "compiler/target/spirv.h"

static const char usage[] =
    "usage: device name|limits|accuracy\n"
    "       device example WxH SCENE\n"
    "       device methods WxH SCENE on|off    early outs\n"
    "       device kernels SCENE\n"
    "The device is the one that KRS_DEVICE names, in the words of krs --device.\n";

static Size read_size(const char *text)
{
    Size size = {0};
    if (sscanf(text, "%ux%u", &size.width, &size.height) != 2)
        give_up(text, "a size is WIDTHxHEIGHT");
    return size;
}

static bool run(KrsRenderer *renderer, int count, char **words)
{
    const char *section = words[1];
    char        slug[64];
    if (count == 2 && strcmp(section, "name") == 0) {
        device_slug(krs_renderer_device(renderer).name, slug, sizeof slug);
        printf("%s\n%s\n", slug, krs_renderer_device(renderer).name);
    } else if (count == 2 && strcmp(section, "limits") == 0) {
        print_device_limits(renderer);
    } else if (count == 2 && strcmp(section, "accuracy") == 0) {
        print_accuracy(renderer);
    } else if (count == 4 && strcmp(section, "example") == 0) {
        print_example(renderer, words[3], read_size(words[2]));
    } else if (count == 5 && strcmp(section, "methods") == 0) {
        print_methods(renderer, words[3], read_size(words[2]), strcmp(words[4], "on") == 0);
    } else if (count == 3 && strcmp(section, "kernels") == 0) {
        print_shaders(renderer, words[2]);
    } else {
        return false;
    }
    return true;
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        fputs(usage, stderr);
        return 2;
    }
    spirv_start();
    KrsRenderer *renderer = device_open();
    bool         known    = run(renderer, argc, argv);
    krs_renderer_free(renderer);
    spirv_stop();
    if (!known)
        fputs(usage, stderr);
    return known ? 0 : 2;
}
