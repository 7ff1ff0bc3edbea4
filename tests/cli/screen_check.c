/*
 * screen_check.c: whether the top left corner of a screen shows a picture: SCREEN is the frame buffer
 * that Xvfb keeps in a file (-fbdir), in the format of xwd.  Says how many pixels differ; the status
 * is 0 if none does.  With four arguments it holds two screens against each other, from one column up
 * to another.
 */
#include <png.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Numbers of the header, which are big-endian. */
enum { HEADER_SIZE = 0, WIDTH = 4, HEIGHT = 5, BYTES_PER_LINE = 12, COLORS = 19 };

static unsigned char *read_file(const char *path, size_t *length)
{
    FILE          *file  = fopen(path, "rb");
    const size_t   most  = (size_t)64 << 20;
    unsigned char *bytes = malloc(most);
    if (!file || !bytes)
        exit(2);
    *length = fread(bytes, 1, most, file);
    fclose(file);
    return bytes;
}

static uint32_t number(const unsigned char *bytes, int index)
{
    const unsigned char *at = bytes + 4 * (size_t)index;
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

static const unsigned char *pixels_of(const unsigned char *screen)
{
    return screen + number(screen, HEADER_SIZE) + 12 * (size_t)number(screen, COLORS);
}

static size_t compare_screens(const char *a, const char *b, uint32_t first, uint32_t end)
{
    size_t               length, wrong = 0;
    const unsigned char *one = read_file(a, &length), *two = read_file(b, &length);
    const unsigned char *left = pixels_of(one), *right = pixels_of(two);
    for (uint32_t y = 0; y < number(one, HEIGHT); y++)
        for (uint32_t x = first; x < end && x < number(one, WIDTH); x++) {
            const size_t at = (size_t)y * number(one, BYTES_PER_LINE) + 4 * (size_t)x;
            wrong += memcmp(left + at, right + at, 3) != 0;
        }
    return wrong;
}

int main(int argc, char **argv)
{
    if (argc == 5) {
        const size_t other = compare_screens(argv[1], argv[2], (uint32_t)atoi(argv[3]),
                                             (uint32_t)atoi(argv[4]));
        printf("%zu pixels differ\n", other);
        return other > 0 ? 1 : 0;
    }
    png_image            picture = {.version = PNG_IMAGE_VERSION};
    size_t               length, wrong = 0;
    const unsigned char *screen = argc == 3 ? read_file(argv[1], &length) : NULL;
    if (!screen || !png_image_begin_read_from_file(&picture, argv[2]))
        return 2;
    picture.format      = PNG_FORMAT_RGB;
    unsigned char *rows = malloc(PNG_IMAGE_SIZE(picture));
    if (!rows || !png_image_finish_read(&picture, NULL, rows, 0, NULL))
        return 2;
    const size_t         line   = number(screen, BYTES_PER_LINE);
    const unsigned char *pixels = pixels_of(screen);
    for (uint32_t y = 0; y < picture.height; y++)
        for (uint32_t x = 0; x < picture.width; x++) {
            const unsigned char *shown = pixels + y * line + 4 * (size_t)x; /* B G R */
            const unsigned char *meant = rows + 3 * ((size_t)y * picture.width + x);
            wrong += shown[0] != meant[2] || shown[1] != meant[1] || shown[2] != meant[0];
        }
    printf("%zu pixels differ\n", wrong);
    return wrong > 0 ? 1 : 0;
}
