/*
 * parse_options.c: from the words of the command line to Options.
 *
 * Written by hand rather than with getopt_long, which prints messages of its own, takes
 * abbreviations that later options would break, and cannot know which command takes what.
 */
#include "cli/parse_options.h"

#include <math.h>
#include <string.h>

#include "cli/shell/console.h"
#include "cli/mesh/files.h"
#include "cli/picture/picture.h"
#include "cli/options/values.h"
#include "compiler/base/text.h"

/* Adds a file that is written; `-` is standard output. */
static bool add_output(Options *options, const char *file)
{
    if (strcmp(file, "-") == 0)
        file = STANDARD_OUTPUT;
    array_push(options->arena, &options->outputs, file);
    return true;
}

/* Refuses numbers that the type of a row permits, but not its range. */
static KrsStatus check_number(const Options *options, OptionId id)
{
    if (id == OPTION_ZONE && options->zone_count == KRS_MAX_ZONES)
        return say_usage(options, "there are at most %d zones", KRS_MAX_ZONES);
    return KRS_OK;
}

/* Takes a value by the row's own means; `choice` is the number of the value among its choices. */
static bool take_value(Options *options, OptionId id, const char *value, int choice)
{
    bool taken = false;
    switch (id) {
#define FLAG(member)               options->member = true
#define SWITCH(member, choices)    (options->member = choice == 1, true)
#define CHOICE(member, choices)    (options->member = choice, true)
#define WORD(take, choices)        take
#define LIST(take, choices, wants) take
#define VALUE(take, wants)         take
#define OPTION(id, letter, name, argument, commands, group, member, value, help) \
    case OPTION_##id:                                                            \
        taken = (value);                                                         \
        break;
#include "cli/options/options.def"
    case OPTION_COUNT: break;
    }
    return taken;
}

bool option_is_given(const Options *options, OptionId id)
{
    for (size_t i = 0; i < options->given.count; i++)
        if (options->given.items[i].id == id)
            return true;
    return false;
}

/* Tells whether the command takes it for what it writes: `krs watch` has the options of `krs mesh` for meshes. */
static bool is_wanted(const Options *options, OptionId id)
{
    return (options->meshes && option_belongs(id, COMMAND_MESH)) ||
           (options->others && option_belongs(id, options->command));
}

/* Finds from this row on the one of the option that "name" or "name=value" begins with, or
   OPTION_COUNT.  Where one name has two meanings, that of meshes comes first. */
static OptionId option_find(const Options *options, OptionId id, const char *name, size_t length)
{
    while (id < OPTION_COUNT &&
           !(is_wanted(options, id) && strlen(option_info[id].name) == length &&
             strncmp(option_info[id].name, name, length) == 0))
        id++;
    return id;
}

/* Sets an option; false: the row does not take the value, and nothing is changed. */
static bool row_takes(Options *options, OptionId id, const char *value)
{
    const Options     before = *options;
    const OptionInfo *info   = &option_info[id];
    bool              chosen = value && info->choices && !info->wants;
    int               choice = chosen ? find_choice(value, info->choices) : 0;
    if (choice >= 0 && take_value(options, id, value, choice))
        return true;
    *options = before;
    return false;
}

/* Takes one option and its argument (NULL when it has none), by the first row that takes this value. */
static KrsStatus option_take(Options *options, OptionId id, const char *value)
{
    const OptionInfo *info = &option_info[id];
    char              wants[OPTION_TEXT];
    KrsStatus         status = check_number(options, id);
    if (status != KRS_OK)
        return status;
    while (id < OPTION_COUNT && !row_takes(options, id, value))
        id = option_find(options, id + 1, info->name, strlen(info->name));
    if (id < OPTION_COUNT) {
        array_push(options->arena, &options->given, ((GivenOption){id, value}));
        return KRS_OK;
    }
    return say_usage(options, "--%s wants %s, not `%s`", info->name, option_wants(info, wants),
                     value);
}

/* Refuses an option of the command about what it does not write. */
static KrsStatus refuse_unwanted(const Options *options, const char *name)
{
    const bool watches = options->command == COMMAND_WATCH;
    for (OptionId id = 0; watches && id < OPTION_COUNT; id++) {
        if (strcmp(option_info[id].name, name) != 0)
            continue;
        if (option_belongs(id, COMMAND_MESH))
            return say_usage(options, "--%s is of meshes, and none is written: -o FILE.stl", name);
        if (option_belongs(id, COMMAND_WATCH))
            return say_usage(options, "--%s is of pictures, and none is written: -o FILE.png",
                             name);
    }
    return KRS_OK;
}

static KrsStatus unknown_option(const Options *options, const char *name, size_t length)
{
    const char *candidates[OPTION_COUNT];
    size_t      count = 0;
    for (OptionId id = 0; id < OPTION_COUNT; id++)
        if (is_wanted(options, id))
            candidates[count++] = option_info[id].name;
    const char *word = arena_copy_text(options->arena, name, length);
    if (refuse_unwanted(options, word) != KRS_OK)
        return KRS_BAD_ARGUMENT;
    const char *nearest = nearest_name(word, candidates, count);
    const char *command = command_table[options->command].name;
    if (nearest)
        return say_usage(options, "%s has no option --%s; did you mean --%s?", command, word,
                         nearest);
    return say_usage(options, "%s has no option --%s", command, word);
}

static OptionId option_find_letter(const Options *options, char letter)
{
    for (OptionId id = 0; id < OPTION_COUNT; id++)
        if (is_wanted(options, id) && option_info[id].letter == letter)
            return id;
    return OPTION_COUNT;
}

/* Takes the argument of an option: what is glued to it, or the next word. */
static KrsStatus take_with_argument(Options *options, OptionId id, const char *glued, int *next)
{
    const OptionInfo *info = &option_info[id];
    char              argument[OPTION_TEXT];
    if (!info->argument) {
        if (glued)
            return say_usage(options, "--%s takes no argument", info->name);
        return option_take(options, id, NULL);
    }
    if (glued)
        return option_take(options, id, glued);
    const char *word = *next < options->argc ? options->argv[*next] : NULL;
    if (info->argument[0] == '[' && !(word && find_choice(word, info->choices) >= 0))
        return option_take(options, id, NULL);
    if (!word)
        return say_usage(options, "--%s needs an argument: %s", info->name,
                         option_argument(info, argument));
    ++*next;
    return option_take(options, id, word);
}

/* Takes the word at *next, which begins with a dash, and its argument. */
static KrsStatus take_option(Options *options, int *next)
{
    const char *word = options->argv[(*next)++];
    if (word[1] == '-') {
        size_t   length = strcspn(word + 2, "=");
        OptionId id     = option_find(options, 0, word + 2, length);
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

/* Takes the word of a command; `krs --help` is `krs help`, as programs of either habit have it. */
static KrsStatus take_command(Options *options, const char *word)
{
    bool asks        = strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0;
    options->command = asks ? COMMAND_HELP : find_command(word);
    return options->command < COMMAND_COUNT ? KRS_OK : say_no_command(word);
}

/* Sets the limits of an untrusted scene, unless options do. */
static void limit_untrusted(Limits *limits)
{
    static const Limits most = {60, (uint64_t)2 << 30, (uint64_t)1 << 26, 4096, (uint64_t)4 << 30};
    limits->time             = limits->time > 0 ? limits->time : most.time;
    limits->memory           = limits->memory ? limits->memory : most.memory;
    limits->pixels           = limits->pixels ? limits->pixels : most.pixels;
    limits->samples          = limits->samples ? limits->samples : most.samples;
    limits->file             = limits->file ? limits->file : most.file;
}

/* Refuses options that exclude each other. */
static KrsStatus check_combinations(Options *options)
{
    const CommandInfo *info  = &command_table[options->command];
    size_t             files = options->files.count;
    if (info->files == MAYBE_A_WORD) {
        if (files > 1)
            return say_usage(options, "%s takes one word, not %zu: krs %s %s", info->name, files,
                             info->name, info->arguments);
    } else if (options->command == COMMAND_FARM && files < 2) {
        return say_usage(options, "farm needs to know what to do, and with what: krs farm %s",
                         info->arguments);
    } else if (info->files == MANY_FILES ? files == 0 : files != (size_t)info->files) {
        if (files == 0)
            return say_usage(options, "%s needs a %s: krs %s %s", info->name,
                             takes_scenes(options->command) ? "scene" : "file", info->name,
                             info->arguments);
        const char *wanted = options->command == COMMAND_IMPORT ? "one file"
                             : info->files                      ? "one scene"
                                                                : "no file";
        return say_usage(options, "%s takes %s, not `%s`", info->name, wanted,
                         options->files.items[info->files]);
    }
    if (options->command == COMMAND_COMPILE && options->outputs.count != 1)
        return say_usage(options, "compile needs one folder to write to: -o DIR");
    if (options->stereo >= 0 && options->light_groups)
        return say_usage(options, "--light-groups are of one picture; --stereo has two");
    if (options->light_groups && options->how.max_radiance > 0)
        return say_usage(options,
                         "--light-groups add up to the picture; with --clamp-radiance they "
                         "do not");
    if (options->stereo >= 0 && (options->depth_in || options->plate))
        return say_usage(options, "--depth-in and --plate are of one picture; --stereo has two");
    if (options->stereo >= 0 && options->how.crop.width > 0)
        return say_usage(options, "--crop is of one picture; --stereo has two");
    if (options->command == COMMAND_IMPORT && options->outputs.count > 1)
        return say_usage(options, "import writes one scene, not %zu", options->outputs.count);
    if (options->command == COMMAND_DUMP && !options->after)
        return say_usage(options, "dump needs --after=PASS");
    if (options->command == COMMAND_QUERY && options->device && !options->on_device)
        return say_usage(options, "--device is for questions that are answered with --on device");
    return KRS_OK;
}

/* Finds what is written by the endings of all words: outputs may stand behind the options for
   them. */
static void find_written(Options *options)
{
    bool pictures   = false;
    options->meshes = false;
    for (int i = 2; i < options->argc && options->command == COMMAND_WATCH; i++) {
        options->meshes = options->meshes || mesh_format(options->argv[i]);
        pictures        = pictures || file_form(options->argv[i]) != FORM_UNKNOWN;
    }
    options->others = pictures || !options->meshes;
}

KrsStatus options_parse(Options *options, int argc, char **argv)
{
    options->argc    = argc;
    options->argv    = argv;
    options->command = COMMAND_COUNT;
#define NO_MEMBER
#define MEMBER(type, name, value)                                                options->name = value;
#define DEFAULT(type, name, value)                                               options->name = value;
#define OPTION(id, letter, name, argument, commands, group, member, value, help) member
#include "cli/options/options.def"
    if (argc < 2)
        return say_usage(options, "no command is given");
    KrsStatus status     = take_command(options, argv[1]);
    bool      words_only = false; /* after "--" */
    find_written(options);
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
    if (options->untrusted)
        limit_untrusted(&options->limits);
    if (status == KRS_OK && !options->help)
        status = check_combinations(options);
    return status;
}
