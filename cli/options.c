/*
 * options.c: from words to Options, and the pages of --help.
 *
 * Written by hand rather than with getopt_long, which prints messages of its own, takes
 * abbreviations that later options would break, and cannot know which command takes what.
 */
#include "cli/options.h"

#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/console.h"
#include "compiler/base/text.h"

#define ON(command)  (1u << COMMAND_##command)
#define ON_ALL       ((1u << COMMAND_COUNT) - 1)
#define ON_SCENE     (ON(RENDER) | ON(VALIDATE) | ON(QUERY))
#define ON_COMPILING (ON_ALL & ~(ON(DEVICES) | ON(EXPLAIN) | ON(IMPORT)))

const CommandInfo command_table[COMMAND_COUNT] = {
#define COMMAND(id, name, arguments, files, summary, examples)                                  \
    [COMMAND_##id] = {name, arguments, files, summary, examples},
#include "cli/commands.def"
#undef COMMAND
};

typedef enum OptionId {
#define OPTION(id, letter, name, argument, commands, help) OPTION_##id,
#include "cli/options.def"
#undef OPTION
    OPTION_COUNT
} OptionId;

typedef struct OptionInfo {
    char        letter;
    const char *name, *argument;
    unsigned    commands;
    const char *help;
} OptionInfo;

static const OptionInfo option_info[OPTION_COUNT] = {
#define OPTION(id, letter, name, argument, commands, help)                                      \
    [OPTION_##id] = {letter, name, argument, commands, help},
#include "cli/options.def"
#undef OPTION
};

static bool option_belongs(OptionId id, CommandId command)
{
    return command < COMMAND_COUNT && (option_info[id].commands & (1u << command)) != 0;
}

/* The values of options: each reader consumes a whole word and is false when it cannot. */

static bool read_whole(const char *word, uint64_t low, uint64_t high, uint64_t *value)
{
    char *end;
    if (!isdigit((unsigned char)word[0]))
        return false; /* strtoull would take blanks and signs */
    errno = 0;
    unsigned long long number = strtoull(word, &end, 10);
    *value = number;
    return errno == 0 && *end == '\0' && number >= low && number <= high;
}

/* As in a scene, so no "inf", "nan" or hexadecimal; *end is what stands behind the number. */
static bool read_number_prefix(const char *word, const char **end, double *value)
{
    size_t length = strspn(word, "+-0123456789.eE");
    char copy[64], *stop;
    if (length == 0 || length >= sizeof copy)
        return false;
    memcpy(copy, word, length);
    copy[length] = '\0';
    *value = strtod(copy, &stop);
    *end = word + length;
    return *stop == '\0' && isfinite(*value);
}

static bool read_number(const char *word, double low, double high, double *value)
{
    const char *end;
    return read_number_prefix(word, &end, value) && *end == '\0' && *value >= low &&
           *value <= high;
}

/* Whole numbers between separators: "640x480" with "x", "0,0,8,8" with ",". */
static bool read_wholes(const char *word, char separator, uint64_t low, uint64_t high,
                        uint32_t *values, size_t count)
{
    char part[16];
    for (size_t i = 0; i < count; i++) {
        size_t length = strcspn(word, (char[]){separator, '\0'});
        uint64_t value;
        if (length >= sizeof part)
            return false;
        memcpy(part, word, length);
        part[length] = '\0';
        if (!read_whole(part, low, high, &value))
            return false;
        values[i] = (uint32_t)value;
        word += length;
        if (i + 1 < count && *word++ != separator)
            return false;
    }
    return *word == '\0';
}

static const char *read_choice(const char *word, const char *const *choices)
{
    for (; *choices; choices++)
        if (strcmp(word, *choices) == 0)
            return *choices;
    return NULL;
}

/* The number of a word among the names of an enum, whose first is the default and cannot be
   asked for; 0 when it is not there. */
static int find_choice(const char *word, const char *const *names, int count)
{
    for (int i = 1; i < count; i++)
        if (strcmp(word, names[i]) == 0)
            return i;
    return 0;
}

/* Colours are linear in all computations, as in the language. */
static double linear_from_srgb(unsigned byte)
{
    double encoded = byte / 255.0;
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

static bool read_color(const char *word, Setting *setting)
{
    if (strlen(word) != 7 || strspn(word + 1, "0123456789abcdefABCDEF") != 6)
        return false;
    unsigned long rgb = strtoul(word + 1, NULL, 16);
    for (int i = 0; i < 3; i++)
        setting->values[i] = linear_from_srgb(rgb >> (16 - 8 * i) & 255);
    setting->count = 3;
    return true;
}

/* A number of a param: `deg` stands behind an angle in degrees, as in a scene. */
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

static bool read_setting(Options *options, const char *word)
{
    const char *equals = strchr(word, '=');
    Setting setting = {.count = 0};
    if (!equals || equals == word)
        return false;
    setting.name = arena_copy_text(options->arena, word, (size_t)(equals - word));
    const char *value = equals + 1;
    bool done;
    if (*value == '#') {
        done = read_color(value, &setting);
    } else if (*value == '[') {
        done = read_vector(value, &setting);
    } else {
        setting.count = 1;
        done = read_parameter_number(value, &value, &setting.values[0]) && *value == '\0';
    }
    if (done)
        array_push(options->arena, &options->settings, setting);
    return done;
}

/* "X,Y,Z,R"; what the library would refuse is refused here. */
static bool read_zone(Options *options, const char *word)
{
    const double most = 1e18;
    double      *zone = options->zones[options->zone_count];
    for (int i = 0; i < 4; i++) {
        if (!read_number_prefix(word, &word, &zone[i]) || fabs(zone[i]) > most ||
            *word != (i < 3 ? ',' : '\0'))
            return false;
        word += i < 3;
    }
    options->zone_count++;
    return zone[3] >= 0;
}

static bool read_aovs(const char *word, unsigned *aovs)
{
    static const char *const names[] = {"Z", "P", "N", "albedo", "id", "steps"};
    *aovs = 0;
    if (strcmp(word, "all") == 0)
        *aovs = AOV_ALL;
    if (strcmp(word, "all") == 0 || strcmp(word, "none") == 0)
        return true;
    for (;; word++) {
        size_t length = strcspn(word, ","), i = 0;
        while (i < 6 && (strlen(names[i]) != length || strncmp(names[i], word, length) != 0))
            i++;
        if (i == 6)
            return false;
        *aovs |= 1u << i;
        word += length;
        if (*word == '\0')
            return true;
    }
}

static bool read_exit_map(Options *options, const char *word)
{
    for (;; word++) {
        char pair[16], *equals;
        uint64_t from, to;
        size_t length = strcspn(word, ",");
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

static bool read_frames(Options *options, const char *word)
{
    enum { FRAMES_LIMIT = 1000000 };
    const char *dots = strstr(word, "..");
    uint64_t first, last;
    if (!dots || !read_whole(dots + 2, 0, FRAMES_LIMIT, &last) ||
        !read_whole(arena_copy_text(options->arena, word, (size_t)(dots - word)), 0, last, &first))
        return false;
    options->animated = true;
    options->first_frame = (uint32_t)first;
    options->last_frame = (uint32_t)last;
    return true;
}

static bool read_size(Options *options, const char *word)
{
    uint32_t size[2];
    if (!read_wholes(word, 'x', 1, SIDE_LIMIT, size, 2))
        return false;
    options->width = size[0];
    options->height = size[1];
    return true;
}

static bool read_crop(Options *options, const char *word)
{
    options->cropped = true;
    return read_wholes(word, ',', 0, SIDE_LIMIT, options->crop, 4) && options->crop[2] > 0 &&
           options->crop[3] > 0;
}

static KrsStatus refuse(const Options *options, OptionId id, const char *wants, const char *value)
{
    return say_usage(options, "--%s wants %s, not `%s`", option_info[id].name, wants, value);
}

/* `on` is the default of every switch, so `off` is what is noted. */
static KrsStatus read_switch(const Options *options, OptionId id, const char *value, bool *off)
{
    *off = strcmp(value, "off") == 0;
    return *off || strcmp(value, "on") == 0 ? KRS_OK : refuse(options, id, "on or off", value);
}

static const char *const stages[] = {"tokens", "syntax", "scene", "graph", "simplify", "glsl",
                                     "spirv", NULL};
static const char *const whens[] = {"auto", "always", "never", NULL};
static const char *const forms[] = {"text", "json", NULL};

/* Takes one option and its argument (NULL when it has none). */
static KrsStatus option_take(Options *options, OptionId id, const char *value)
{
    uint64_t whole = 0;
    const char *choice;
    switch (id) {
    case OPTION_OUTPUT:
        array_push(options->arena, &options->outputs, value);
        return KRS_OK;
    case OPTION_SIZE:
        return read_size(options, value)
                   ? KRS_OK
                   : refuse(options, id, "WIDTHxHEIGHT, each from 1 to 16384 in this version",
                            value);
    case OPTION_SAMPLES:
        if (!read_whole(value, 1, SAMPLES_LIMIT, &whole))
            return refuse(options, id, "a whole number from 1 to 65536", value);
        options->samples = (uint32_t)whole;
        return KRS_OK;
    case OPTION_INTEGRATOR:
        if (strcmp(value, "direct") == 0 || strcmp(value, "path") == 0)
            return say_usage(options, "--integrator %s is not in this version; there is preview",
                             value);
        return strcmp(value, "preview") == 0 ? KRS_OK : refuse(options, id, "preview", value);
    case OPTION_CAMERA:
        options->camera = value;
        return KRS_OK;
    case OPTION_CROP:
        return read_crop(options, value)
                   ? KRS_OK
                   : refuse(options, id, "X,Y,WIDTH,HEIGHT in pixels, at least one wide and high",
                            value);
    case OPTION_FRAMES:
        return read_frames(options, value)
                   ? KRS_OK
                   : refuse(options, id, "FIRST..LAST, whole numbers up to 1000000", value);
    case OPTION_FPS:
        return read_number(value, 1e-6, 1e6, &options->fps)
                   ? KRS_OK
                   : refuse(options, id, "a number above 0", value);
    case OPTION_TIME:
        return read_number(value, -1e9, 1e9, &options->time)
                   ? KRS_OK
                   : refuse(options, id, "a number of seconds from -1e9 to 1e9", value);
    case OPTION_SET:
        return read_setting(options, value)
                   ? KRS_OK
                   : refuse(options, id, "NAME=VALUE, the value a number, [1,2,3] or #rrggbb",
                            value);
    case OPTION_ZONE:
        if (options->zone_count == KRS_MOST_ZONES)
            return say_usage(options, "there are at most %d zones", KRS_MOST_ZONES);
        return read_zone(options, value)
                   ? KRS_OK
                   : refuse(options, id, "X,Y,Z,RADIUS, the radius not negative", value);
    case OPTION_AOV:
        return read_aovs(value, &options->aovs)
                   ? KRS_OK
                   : refuse(options, id, "all, none, or of Z,P,N,albedo,id,steps", value);
    case OPTION_TONE_MAP:
        options->tone_mapped = tone_map_find(value, &options->tone_map);
        return options->tone_mapped ? KRS_OK : refuse(options, id, "neutral, aces or none", value);
    case OPTION_EXPOSURE:
        options->exposed = true;
        return read_number(value, -64, 64, &options->exposure)
                   ? KRS_OK
                   : refuse(options, id, "a number of stops from -64 to 64", value);
    case OPTION_SEED:
        return read_whole(value, 0, UINT32_MAX, &options->seed)
                   ? KRS_OK
                   : refuse(options, id, "a whole number below 4294967296", value);
    case OPTION_POINTS:
        return read_whole(value, 1, 1000000000, &options->points)
                   ? KRS_OK
                   : refuse(options, id, "a whole number from 1 to 1000000000", value);
    case OPTION_DEVICE:
        options->device = value;
        return KRS_OK;
    case OPTION_ON:
        options->on_device = strcmp(value, "device") == 0;
        return options->on_device || strcmp(value, "host") == 0
                   ? KRS_OK
                   : refuse(options, id, "host or device", value);
    case OPTION_TOLERANCE:
        return read_number(value, 1e-300, 1e18, &options->tolerance)
                   ? KRS_OK
                   : refuse(options, id, "a length above 0", value);
    case OPTION_FARTHEST:
        return read_number(value, 0, 1e18, &options->farthest)
                   ? KRS_OK
                   : refuse(options, id, "a length from 0 to 1e18", value);
    case OPTION_CACHE:
        options->cache = value;
        return *value ? KRS_OK : refuse(options, id, "a folder, or off", value);
    case OPTION_STATS:
        if (value && strcmp(value, "json") != 0)
            return refuse(options, id, "json or nothing", value);
        options->stats = value ? STATS_JSON : STATS_TEXT;
        return KRS_OK;
    case OPTION_BEAMS: return read_switch(options, id, value, &options->no_beams);
    case OPTION_COMPONENTS:
        options->components =
            (KrsComponents)find_choice(value, krs_components_names, KRS_COMPONENTS_COUNT);
        return options->components ? KRS_OK : refuse(options, id, "together, apart or packed",
                                                       value);
    case OPTION_NORMALS:
        options->normals = (KrsNormals)find_choice(value, krs_normals_names, KRS_NORMALS_COUNT);
        return options->normals ? KRS_OK
                                : refuse(options, id, "forward, tetrahedron, octahedron, cube, "
                                                      "icosahedron, dodecahedron or analytic",
                                         value);
    case OPTION_EARLY_OUTS: {
        bool      off;
        KrsStatus status    = read_switch(options, id, value, &off);
        options->early_outs = off ? KRS_EARLY_OUTS_OFF : KRS_EARLY_OUTS_ON;
        return status;
    }
    case OPTION_UPSAMPLING: return read_switch(options, id, value, &options->no_upsampling);
    case OPTION_OCCLUSION:  return read_switch(options, id, value, &options->no_occlusion);
    case OPTION_FILTER:     return read_switch(options, id, value, &options->no_filter);
    case OPTION_SHADOWS:
        options->area_shadows = strcmp(value, krs_shadows_names[KRS_SHADOWS_AREA]) == 0;
        return options->area_shadows || strcmp(value, krs_shadows_names[KRS_SHADOWS_SOFT]) == 0
                   ? KRS_OK
                   : refuse(options, id, "soft or area", value);
    case OPTION_ERROR:
        return read_number(value, 1e-6, 1000, &options->error)
                   ? KRS_OK
                   : refuse(options, id, "a number of pixels above 0", value);
    case OPTION_TRACE:
        options->trace = (KrsTrace)find_choice(value, krs_trace_names, KRS_TRACE_COUNT);
        return options->trace ? KRS_OK : refuse(options, id, "plain, relaxed, auto, exact, taylor, "
                                                    "root-free, directional, binary or predicted",
                                       value);
    case OPTION_SCHEDULE:
        options->schedule =
            (KrsSchedule)find_choice(value, krs_schedule_names, KRS_SCHEDULE_COUNT);
        return options->schedule ? KRS_OK : refuse(options, id, "pixel, refill or queue", value);
    case OPTION_RESUME:
        return say_usage(options, "--resume is not in this version; there are no checkpoints");
    case OPTION_AFTER:
        options->after = read_choice(value, stages);
        return options->after ? KRS_OK
                              : refuse(options, id, "tokens, syntax, scene, graph, simplify, glsl "
                                                    "or spirv", value);
    case OPTION_SECONDS:
        return read_number(value, 0, 1e6, &options->seconds)
                   ? KRS_OK
                   : refuse(options, id, "a number of seconds", value);
    case OPTION_DEADLINE:
        return read_number(value, 0.001, 1e6, &options->deadline)
                   ? KRS_OK
                   : refuse(options, id, "a number of seconds above 0", value);
    case OPTION_DIAGNOSTICS:
        if (!(choice = read_choice(value, forms)))
            return refuse(options, id, "text or json", value);
        options->json_diagnostics = choice == forms[1];
        return KRS_OK;
    case OPTION_EXIT_MAP:
        return read_exit_map(options, value)
                   ? KRS_OK
                   : refuse(options, id, "pairs like 71=33,75=99 of statuses up to 255", value);
    case OPTION_COLOR:
        if (!(choice = read_choice(value, whens)))
            return refuse(options, id, "auto, always or never", value);
        options->color = choice == whens[0]   ? WHEN_AUTO
                         : choice == whens[1] ? WHEN_ALWAYS
                                              : WHEN_NEVER;
        return KRS_OK;
    case OPTION_NO_DEVICE: options->no_device = true; return KRS_OK;
    case OPTION_STAMP: options->stamp = true; return KRS_OK;
    case OPTION_BINARY: options->binary = true; return KRS_OK;
    case OPTION_JSON: options->json = true; return KRS_OK;
    case OPTION_QUIET: options->quiet = true; return KRS_OK;
    case OPTION_HELP: options->help = true; return KRS_OK;
    case OPTION_COUNT: break;
    }
    return KRS_INTERNAL;
}

static KrsStatus unknown_option(const Options *options, const char *name, size_t length)
{
    const char *candidates[OPTION_COUNT];
    size_t count = 0;
    for (OptionId id = 0; id < OPTION_COUNT; id++)
        if (option_belongs(id, options->command))
            candidates[count++] = option_info[id].name;
    const char *word = arena_copy_text(options->arena, name, length);
    const char *nearest = nearest_name(word, candidates, count);
    const char *command = command_table[options->command].name;
    if (nearest)
        return say_usage(options, "%s has no option --%s; did you mean --%s?", command, word,
                         nearest);
    return say_usage(options, "%s has no option --%s", command, word);
}

/* The option that "--name" or "--name=value" begins with, or OPTION_COUNT. */
static OptionId option_find(const Options *options, const char *name, size_t length)
{
    for (OptionId id = 0; id < OPTION_COUNT; id++)
        if (option_belongs(id, options->command) && strlen(option_info[id].name) == length &&
            strncmp(option_info[id].name, name, length) == 0)
            return id;
    return OPTION_COUNT;
}

static OptionId option_find_letter(const Options *options, char letter)
{
    for (OptionId id = 0; id < OPTION_COUNT; id++)
        if (option_belongs(id, options->command) && option_info[id].letter == letter)
            return id;
    return OPTION_COUNT;
}

/* The argument of an option: what is glued to it, or the next word. */
static KrsStatus take_with_argument(Options *options, OptionId id, const char *glued, int *next)
{
    const OptionInfo *info = &option_info[id];
    if (!info->argument) {
        if (glued)
            return say_usage(options, "--%s takes no argument", info->name);
        return option_take(options, id, NULL);
    }
    if (glued)
        return option_take(options, id, glued);
    const char *word = *next < options->argc ? options->argv[*next] : NULL;
    if (info->argument[0] == '[' && !(word && strcmp(word, "json") == 0))
        return option_take(options, id, NULL);
    if (!word)
        return say_usage(options, "--%s needs an argument: %s", info->name, info->argument);
    ++*next;
    return option_take(options, id, word);
}

/* Takes the word at *next, which begins with a dash, and its argument. */
static KrsStatus take_option(Options *options, int *next)
{
    const char *word = options->argv[(*next)++];
    if (word[1] == '-') {
        size_t length = strcspn(word + 2, "=");
        OptionId id = option_find(options, word + 2, length);
        if (id == OPTION_COUNT)
            return unknown_option(options, word + 2, length);
        const char *equals = word + 2 + length;
        return take_with_argument(options, id, *equals ? equals + 1 : NULL, next);
    }
    OptionId id = option_find_letter(options, word[1]);
    if (id == OPTION_COUNT)
        return say_usage(options, "%s has no option -%c", command_table[options->command].name,
                         word[1]);
    return take_with_argument(options, id, word[2] ? word + 2 : NULL, next);
}

static KrsStatus find_command(Options *options, const char *word)
{
    const char *names[COMMAND_COUNT];
    for (CommandId command = 0; command < COMMAND_COUNT; command++) {
        names[command] = command_table[command].name;
        if (strcmp(word, names[command]) == 0) {
            options->command = command;
            return KRS_OK;
        }
    }
    if (strcmp(word, "format") == 0)
        return say_usage(options, "`format` is not in this version");
    const char *nearest = nearest_name(word, names, COMMAND_COUNT);
    if (nearest)
        return say_usage(options, "there is no command `%s`; did you mean `%s`?", word, nearest);
    return say_usage(options, "there is no command `%s`", word);
}

/* What no single option can see. */
static KrsStatus check_together(Options *options)
{
    const CommandInfo *info = &command_table[options->command];
    size_t files = options->files.count;
    if (options->command == COMMAND_EXPLAIN) {
        if (files > 1)
            return say_usage(options, "explain takes one code, not %zu", files);
    } else if (info->files == MANY_FILES ? files == 0 : files != (size_t)info->files) {
        if (files == 0)
            return say_usage(options, "%s needs a %s: krs %s %s", info->name,
                             options->command == COMMAND_IMPORT ? "file" : "scene", info->name,
                             info->arguments);
        const char *wanted = options->command == COMMAND_IMPORT ? "one file"
                             : info->files                      ? "one scene"
                                                                : "no file";
        return say_usage(options, "%s takes %s, not `%s`", info->name, wanted,
                         options->files.items[info->files]);
    }
    if (options->command == COMMAND_COMPILE && options->outputs.count != 1)
        return say_usage(options, "compile needs one folder to write to: -o DIR");
    if (options->command == COMMAND_DUMP && !options->after)
        return say_usage(options, "dump needs --after=STAGE");
    if (options->command == COMMAND_QUERY && options->device && !options->on_device)
        return say_usage(options, "--device is for questions that are answered with --on device");
    return KRS_OK;
}

KrsStatus options_parse(Options *options, int argc, char **argv)
{
    options->argc = argc;
    options->argv = argv;
    options->command = COMMAND_COUNT;
    options->aovs = AOV_ALL;
    options->fps = 24;
    options->points = 20000;
    options->seconds = 2;
    options->farthest = 1e9; /* far beyond any scene, and finite */
    options->deadline = 60;
    if (argc < 2)
        return say_usage(options, "no command is given");
    KrsStatus status = find_command(options, argv[1]);
    bool words_only = false; /* after "--" */
    for (int next = 2; next < argc && status == KRS_OK;) {
        const char *word = argv[next];
        if (!words_only && strcmp(word, "--") == 0) {
            words_only = true;
            next++;
        } else if (!words_only && word[0] == '-' && word[1] != '\0') {
            status = take_option(options, &next);
        } else {
            array_push(options->arena, &options->files, word);
            next++;
        }
    }
    if (status == KRS_OK && !options->help)
        status = check_together(options);
    return status;
}

void help_print(FILE *out)
{
    fputs("krs renders scenes of implicit surfaces.\n\n"
          "    krs render ring.krs -o ring.png\n"
          "    krs check ring.krs\n\n"
          "usage: krs COMMAND [OPTION]... [FILE]...\n\n", out);
    for (CommandId command = 0; command < COMMAND_COUNT; command++)
        fprintf(out, "    %-10s %s\n", command_table[command].name, command_table[command].summary);
    fputs("\n`krs COMMAND --help` shows examples and options, `krs --version` the version.\n"
          "Exit status: 0 done; 1 the scene is wrong; 2 wrong usage; 69 no device; 70 a bug, or\n"
          "the driver's; 71 out of memory; 73 cannot create the output; 74 cannot read the scene\n"
          "or write the output; 130 interrupted.\n", out);
}

void help_print_command(CommandId command, FILE *out)
{
    const CommandInfo *info = &command_table[command];
    fprintf(out, "krs %s: %s\n\n%s\nusage: krs %s [OPTION]... %s\n\n", info->name, info->summary,
            info->examples, info->name, info->arguments);
    for (OptionId id = 0; id < OPTION_COUNT; id++) {
        if (!option_belongs(id, command))
            continue;
        const OptionInfo *option = &option_info[id];
        char form[64], letter[8] = "";
        if (option->letter)
            snprintf(letter, sizeof letter, "-%c, ", option->letter);
        snprintf(form, sizeof form, "%s--%s %s", letter, option->name,
                 option->argument ? option->argument : "");
        fprintf(out, "    %-28s %s\n", form, option->help);
    }
}
