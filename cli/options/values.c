/*
 * values.c: the values of options: each reader consumes a whole word and is false when it cannot.
 */
#include "cli/options/values.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/srgb.h"

bool read_whole(const char *word, uint64_t low, uint64_t high, uint64_t *value)
{
    char *end;
    if (!isdigit((unsigned char)word[0]))
        return false; /* strtoull would take blanks and signs */
    errno                     = 0;
    unsigned long long number = strtoull(word, &end, 10);
    *value                    = number;
    return errno == 0 && *end == '\0' && number >= low && number <= high;
}

/* Reads a number as a scene has it, so no "inf", "nan" or hexadecimal; *end is what stands behind
   the number. */
static bool read_number_prefix(const char *word, const char **end, double *value)
{
    size_t length = strspn(word, "+-0123456789.eE");
    char   copy[64], *stop;
    if (length == 0 || length >= sizeof copy)
        return false;
    memcpy(copy, word, length);
    copy[length] = '\0';
    *value       = strtod(copy, &stop);
    *end         = word + length;
    return *stop == '\0' && isfinite(*value);
}

bool read_number(const char *word, double low, double high, double *value)
{
    const char *end;
    return read_number_prefix(word, &end, value) && *end == '\0' && *value >= low && *value <= high;
}

bool read_count(const char *word, uint32_t low, uint32_t high, uint32_t *value)
{
    uint64_t whole = 0;
    bool     read  = read_whole(word, low, high, &whole);
    *value         = (uint32_t)whole;
    return read;
}

/* Reads whole numbers between separators: "640x480" with "x", "0,0,8,8" with ",". */
static bool read_wholes(const char *word, char separator, uint64_t low, uint64_t high,
                        uint32_t *values, size_t count)
{
    char piece[16];
    for (size_t i = 0; i < count; i++) {
        size_t   length = strcspn(word, (char[]){separator, '\0'});
        uint64_t value;
        if (length >= sizeof piece)
            return false;
        memcpy(piece, word, length);
        piece[length] = '\0';
        if (!read_whole(piece, low, high, &value))
            return false;
        values[i] = (uint32_t)value;
        word += length;
        if (i + 1 < count && *word++ != separator)
            return false;
    }
    return *word == '\0';
}

/* Computations are linear, as in the language. */
static bool read_color(const char *word, Setting *setting)
{
    if (strlen(word) != 7 || strspn(word + 1, "0123456789abcdefABCDEF") != 6)
        return false;
    unsigned long rgb = strtoul(word + 1, NULL, 16);
    for (int i = 0; i < 3; i++)
        setting->values[i] = linear_of_srgb((rgb >> (16 - 8 * i) & 255) / 255.0);
    setting->count = 3;
    return true;
}

/* Reads a number of a param: `deg` stands behind an angle in degrees, as in a scene. */
static bool read_parameter_number(const char *word, const char **end, double *value)
{
    if (!read_number_prefix(word, end, value))
        return false;
    if (strncmp(*end, "deg", 3) == 0) {
        *value *= M_PI / 180;
        *end += 3;
    }
    return true;
}

static bool read_vector(const char *word, Setting *setting)
{
    do {
        word += 1 + strspn(word + 1, " ");
        if (setting->count == 4 ||
            !read_parameter_number(word, &word, &setting->values[setting->count]))
            return false;
        setting->count++;
        word += strspn(word, " ");
    } while (*word == ',');
    return strcmp(word, "]") == 0 && setting->count >= 2;
}

bool read_setting(Options *options, const char *word)
{
    const char *equals  = strchr(word, '=');
    Setting     setting = {.count = 0};
    if (!equals || equals == word)
        return false;
    setting.name      = arena_copy_text(options->arena, word, (size_t)(equals - word));
    const char *value = equals + 1;
    bool        done  = false;
    if (*value == '#') {
        done = read_color(value, &setting);
    } else if (*value == '[') {
        done = read_vector(value, &setting);
    } else {
        const char *end = value;
        setting.count   = 1;
        done            = read_parameter_number(value, &end, &setting.values[0]) && *end == '\0';
    }
    done = done || read_expression(options->arena, value, &setting);
    if (done)
        array_push(options->arena, &options->settings, setting);
    return done;
}

/* Reads two points, or a point and a direction. */
static bool read_six(const char *word, double first[3], double second[3])
{
    for (int i = 0; i < 6; i++) {
        double *number = i < 3 ? &first[i] : &second[i - 3];
        if (!read_number_prefix(word, &word, number) || fabs(*number) > KRS_MAX_COORDINATE ||
            *word != (i < 5 ? ',' : '\0'))
            return false;
        word += i < 5;
    }
    return true;
}

bool read_plane(const char *word, SectionPlane *plane)
{
    const double *normal = plane->at.normal;
    plane->given         = true;
    return read_six(word, plane->at.point, plane->at.normal) &&
           hypot(hypot(normal[0], normal[1]), normal[2]) > 1e-100;
}

bool read_within(const char *word, WithinBox *box)
{
    box->given = true;
    if (!read_six(word, box->low, box->high))
        return false;
    return box->low[0] < box->high[0] && box->low[1] < box->high[1] && box->low[2] < box->high[2];
}

/* Reads a zone, and refuses what the library would refuse. */
bool read_zone(Options *options, const char *word)
{
    double *zone = options->zones[options->zone_count];
    for (int i = 0; i < 4; i++) {
        if (!read_number_prefix(word, &word, &zone[i]) || fabs(zone[i]) > KRS_MAX_COORDINATE ||
            *word != (i < 3 ? ',' : '\0'))
            return false;
        word += i < 3;
    }
    options->zone_count++;
    return zone[3] >= 0;
}

bool read_white_balance(const char *word, WhiteBalance *balance)
{
    balance->tint = 0;
    return read_number_prefix(word, &word, &balance->kelvins) && balance->kelvins >= 1500 &&
           balance->kelvins <= 15000 &&
           (*word == '\0' || (*word == ',' && read_number(word + 1, -150, 150, &balance->tint)));
}

/* Returns the AOV of which a part of a list is the name; 0: none is. */
static uint32_t find_aov(const char *word, size_t length)
{
    static const struct {
        const char *name;
        KrsAov      aov;
    } aovs[] = {
#define KRS_AOV(id, bit, aov, about, arrays) {aov, KRS_AOV_##id},
#include "krs/aovs.def"
#undef KRS_AOV
    };
    for (size_t i = 0; length > 0 && i < sizeof aovs / sizeof *aovs; i++)
        if (strlen(aovs[i].name) == length && strncmp(aovs[i].name, word, length) == 0)
            return aovs[i].aov;
    return 0;
}

bool read_aovs(const char *word, uint32_t *aovs)
{
    *aovs = strcmp(word, "all") == 0 ? KRS_AOV_ALL : 0;
    if (*aovs || strcmp(word, "none") == 0)
        return true;
    for (;; word++) {
        size_t   length = strcspn(word, ",");
        uint32_t aov    = find_aov(word, length);
        if (aov == 0)
            return false;
        *aovs |= aov;
        word += length;
        if (*word == '\0')
            return true;
    }
}

bool read_exit_map(Options *options, const char *word)
{
    for (;; word++) {
        char     pair[16], *equals;
        uint64_t from, to;
        size_t   length = strcspn(word, ",");
        if (length >= sizeof pair)
            return false;
        memcpy(pair, word, length);
        pair[length] = '\0';
        if (!(equals = strchr(pair, '=')))
            return false;
        *equals = '\0';
        if (!read_whole(pair, 0, 255, &from) || !read_whole(equals + 1, 0, 255, &to))
            return false;
        ExitPair entry = {(int)from, (int)to};
        array_push(options->arena, &options->exit_map, entry);
        word += length;
        if (*word == '\0')
            return true;
    }
}

/* Reads a size such as "512M". */
static bool read_bytes(char *word, uint64_t *bytes)
{
    static const char units[] = "KMG";
    size_t            length  = strlen(word);
    const char       *unit    = length > 1 ? strchr(units, word[length - 1]) : NULL;
    int               shift   = unit ? 10 * (int)(unit - units + 1) : 0;
    if (unit)
        word[length - 1] = '\0';
    if (!read_whole(word, 1, UINT64_MAX >> 30, bytes))
        return false;
    *bytes <<= shift;
    return true;
}

/* Reads a limit such as "memory=512M"; the word changes. */
static bool read_limit(char *word, Limits *limits)
{
    char *value = strchr(word, '=');
    if (!value)
        return false;
    *value++ = '\0';
    if (strcmp(word, "time") == 0)
        return read_number(value, 0.001, 1e9, &limits->time);
    if (strcmp(word, "memory") == 0)
        return read_bytes(value, &limits->memory);
    if (strcmp(word, "pixels") == 0)
        return read_whole(value, 1, UINT64_MAX, &limits->pixels);
    if (strcmp(word, "samples") == 0)
        return read_whole(value, 1, UINT64_MAX, &limits->samples);
    if (strcmp(word, "file") == 0)
        return read_bytes(value, &limits->file);
    return false;
}

bool read_limits(const char *word, Limits *limits)
{
    for (;; word++) {
        char   limit[64];
        size_t length = strcspn(word, ",");
        if (length >= sizeof limit)
            return false;
        memcpy(limit, word, length);
        limit[length] = '\0';
        if (!read_limit(limit, limits))
            return false;
        word += length;
        if (*word == '\0')
            return true;
    }
}

bool read_frames(Options *options, const char *word)
{
    enum { FRAMES_LIMIT = 1000000 };
    const char *dots = strstr(word, "..");
    uint64_t    first, last;
    if (!dots || !read_whole(dots + 2, 0, FRAMES_LIMIT, &last) ||
        !read_whole(arena_copy_text(options->arena, word, (size_t)(dots - word)), 0, last, &first))
        return false;
    options->animated    = true;
    options->first_frame = (uint32_t)first;
    options->last_frame  = (uint32_t)last;
    return true;
}

bool read_size(const char *word, KrsRenderOptions *how)
{
    uint32_t size[2];
    if (!read_wholes(word, 'x', 1, KRS_MAX_SIDE, size, 2))
        return false;
    how->width  = size[0];
    how->height = size[1];
    return true;
}

bool read_samples(Options *options, const char *word)
{
    const char *dots = strstr(word, ".."), *slash = strchr(word, '/');
    uint64_t    first, last;
    if (!dots)
        return read_count(word, 1, KRS_MAX_SAMPLES, &options->how.samples);
    if (options->command != COMMAND_RENDER || !slash || slash < dots ||
        !read_count(slash + 1, 1, KRS_MAX_SAMPLES, &options->how.samples) ||
        !read_whole(arena_copy_text(options->arena, dots + 2, (size_t)(slash - dots) - 2), 0,
                    options->how.samples - 1, &last) ||
        !read_whole(arena_copy_text(options->arena, word, (size_t)(dots - word)), 0, last, &first))
        return false;
    options->samples_divided = true;
    options->first_sample    = (uint32_t)first;
    options->last_sample     = (uint32_t)last;
    return true;
}

bool read_tiles(const char *word, uint32_t tiles[2])
{
    return read_wholes(word, 'x', 1, KRS_MAX_SIDE, tiles, 2);
}

bool read_crop(const char *word, KrsWindow *crop)
{
    uint32_t numbers[4];
    if (!read_wholes(word, ',', 0, KRS_MAX_SIDE, numbers, 4))
        return false;
    *crop = (KrsWindow){numbers[0], numbers[1], numbers[2], numbers[3]};
    return crop->width > 0 && crop->height > 0;
}
