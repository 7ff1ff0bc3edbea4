/*
 * frame_paths.c: file names of frames.
 */
#include "cli/picture/frame_paths.h"

#include <stdlib.h>
#include <string.h>

#include "runtime/writer/atomic.h"

/* Finds where the frame's number goes in the name of an output: "%d", "%04d".  NULL without one. */
static const char *find_pattern(const char *path, int *width, size_t *length)
{
    for (const char *percent = path; (percent = strchr(percent, '%')); percent++) {
        size_t digits = strspn(percent + 1, "0123456789");
        if (digits <= 2 && percent[1 + digits] == 'd') {
            *width  = atoi(percent + 1);
            *length = digits + 2;
            return percent;
        }
    }
    return NULL;
}

int frame_places(const char *path)
{
    int    width, places = 0;
    size_t length;
    for (; (path = find_pattern(path, &width, &length)); path += length)
        places++;
    return places;
}

const char *numbered_path(const Options *options, const char *path, uint32_t number)
{
    int         width   = 0;
    size_t      length  = 0;
    const char *pattern = find_pattern(path, &width, &length);
    if (!pattern)
        return path;
    Text text = {.arena = options->arena};
    text_add_bytes(&text, path, (size_t)(pattern - path));
    text_format(&text, "%0*u", width, number);
    text_add(&text, pattern + length);
    return text.bytes;
}

const char *frame_path(const Options *options, const char *path, uint32_t frame)
{
    return options->animated ? numbered_path(options, path, frame) : path;
}

bool are_one_file(const Options *options, const char *a, const char *b)
{
    uint32_t first = options->first_frame, last = options->last_frame;
    if (output_is_same(frame_path(options, a, first), frame_path(options, b, first)) ||
        output_is_same(frame_path(options, a, last), frame_path(options, b, last)))
        return true;
    for (uint32_t frame = 10; frame < last; frame *= 10)
        if (frame > first &&
            output_is_same(frame_path(options, a, frame), frame_path(options, b, frame)))
            return true;
    return false;
}
