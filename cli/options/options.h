/*
 * options.h: commands and options: their tables, and what a command line asks for.
 */
#ifndef KRS_OPTIONS_H
#define KRS_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cli/options/choices.h"
#include "compiler/base/arena.h"
#include "krs/krs.h"
#include "runtime/display/display.h"
#include "runtime/writer/atomic.h"

enum {
    MANY_FILES     = -1, /* a command that takes one or more files */
    MAYBE_A_WORD   = -2, /* one that takes a word, which is no file, or nothing */
    MAX_LODS       = 8,  /* of --lods */
    FEWEST_BAKED   = 8,  /* of --bake of an export */
    MOST_BAKED     = 256,
    MIN_BAKED      = 16, /* pixels of --bake */
    MAX_BAKED      = 4096,
    OPTION_TEXT    = 256, /* bytes of what is said about an option, at most */
    DEVICE_TIMEOUT = 5    /* deadlines that one step of a device may take */
};

typedef enum CommandId {
#define COMMAND(id, name, function, arguments, files, summary, examples) COMMAND_##id,
#include "cli/options/commands.def"
#undef COMMAND
    COMMAND_COUNT
} CommandId;

typedef struct CommandInfo {
    const char *name, *arguments;
    int         files; /* how many scenes, MANY_FILES or MAYBE_A_WORD */
    const char *summary, *examples;
} CommandInfo;

extern const CommandInfo command_table[COMMAND_COUNT];

/* Returns the command of this name, or COMMAND_COUNT. */
CommandId find_command(const char *name);
/* Tells whether the files of a command are scenes. */
bool takes_scenes(CommandId command);
/* Returns the one whose name is most like this, or NULL. */
const char *nearest_command(const char *name);

typedef enum OptionId {
#define OPTION(id, letter, name, argument, commands, group, member, value, help) OPTION_##id,
#include "cli/options/options.def"
    OPTION_COUNT
} OptionId;

/* A heading of a page: the options that are about one matter. */
typedef enum OptionGroup {
#define GROUP(id, heading) GROUP_##id,
#include "cli/options/option_groups.def"
#undef GROUP
    GROUP_COUNT
} OptionGroup;

extern const char *const group_headings[GROUP_COUNT];

/* A row of options.def; {} in a text stands for the choices. */
typedef struct OptionInfo {
    char          letter;          /* 0: none */
    const char   *name, *argument; /* `argument` NULL: it takes none; "": the choices */
    unsigned      commands;
    OptionGroup   group;
    const char   *help, *wants;
    const Choice *choices; /* NULL: other values; with `wants` these are for lists of them */
} OptionInfo;

extern const OptionInfo option_info[OPTION_COUNT];

/* Returns the argument of a row, with its choices in place. */
const char *option_argument(const OptionInfo *option, char text[OPTION_TEXT]);
const char *option_wants(const OptionInfo *option, char text[OPTION_TEXT]);
const char *option_help(const OptionInfo *option, char text[OPTION_TEXT]);
/* Returns the choices of a row with blanks between; NULL: other values are possible. */
const char *option_words(const OptionInfo *option, char text[OPTION_TEXT]);

bool option_belongs(OptionId id, CommandId command);
/* Tells whether the command has options of this group. */
bool group_belongs(OptionGroup group, CommandId command);
/* Tells whether the value of an option changes the samples of pictures. */
bool option_changes_pictures(OptionId id);

typedef enum When { WHEN_AUTO, WHEN_ALWAYS, WHEN_NEVER } When;
typedef enum Trust { TRUSTED, UNTRUSTED, UNTRUSTED_LIMITS } Trust;
typedef enum StatsForm { STATS_NONE, STATS_TEXT, STATS_JSON } StatsForm;

/* --set */
typedef struct Setting {
    const char *name;
    double      values[4];
    size_t      count;
} Setting;

/* An option of the command line. */
typedef struct GivenOption {
    OptionId    id;
    const char *value; /* NULL: none */
} GivenOption;

typedef struct ExitPair {
    int from, to;
} ExitPair;

/* --limit; 0: none */
typedef struct Limits {
    double   time;   /* seconds, of the whole command */
    uint64_t memory; /* bytes */
    uint64_t pixels, samples;
    uint64_t file; /* bytes of one that is written */
} Limits;

/* --within */
typedef struct WithinBox {
    bool   given;
    double low[3], high[3];
} WithinBox;

/* --plane */
typedef struct SectionPlane {
    bool            given;
    KrsSectionPlane at;
} SectionPlane;

/* The path of standard output, which `-o -` is. */
#define STANDARD_OUTPUT OUTPUT_STANDARD

typedef struct Options {
    CommandId command;
    int       argc; /* the whole command line, for a report of a crash */
    char    **argv;
    bool      meshes,
        others; /* whether a command that writes both writes meshes, and what else it does */

    struct {
        const char **items;
        size_t       count, capacity;
    } files, outputs;
    struct {
        GivenOption *items;
        size_t       count, capacity;
    } given;
    struct {
        Setting *items;
        size_t   count, capacity;
    } settings;
    struct {
        ExitPair *items;
        size_t    count, capacity;
    } exit_map;
    double zones[KRS_MAX_ZONES][4];
    size_t zone_count;

    uint32_t farm_tiles[2]; /* --tiles; 0: one */

    bool     samples_divided; /* --samples A..B/N */
    uint32_t first_sample, last_sample;

    bool     animated; /* --frames */
    uint32_t first_frame, last_frame;

    KrsRenderOptions how; /* what the rows put there; all else is 0 */
#define NO_MEMBER
#define MEMBER(type, name, value)                                                type name;
#define DEFAULT(type, name, value)                                               type name;
#define OPTION(id, letter, name, argument, commands, group, member, value, help) member
#include "cli/options/options.def"

    const char  *input; /* the scene that standard input has, or NULL */
    size_t       input_length;
    struct Pack *packs; /* that are open */

    struct SandboxNeeds *needs; /* what the child may do; NULL: whatever the user may */

    Arena *arena; /* for whatever a command needs until the process ends */
} Options;

/* Tells whether the command line has an option. */
bool option_is_given(const Options *options, OptionId id);

#endif
