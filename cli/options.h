/*
 * options.h: the command line, understood.
 */
#ifndef KRS_OPTIONS_H
#define KRS_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "compiler/base/arena.h"
#include "compiler/krs.h"
#include "runtime/film/film.h"

enum {
    MANY_FILES      = -1,    /* a command that takes one or more files */
    SIDE_LIMIT      = 16384, /* pixels along a side of a picture in this version */
    SAMPLES_LIMIT   = 65536,
    DEVICE_PATIENCE = 5 /* deadlines that one step of a device may take */
};

typedef enum CommandId {
#define COMMAND(id, name, arguments, files, summary, examples) COMMAND_##id,
#include "cli/commands.def"
#undef COMMAND
    COMMAND_COUNT
} CommandId;

typedef struct CommandInfo {
    const char *name, *arguments;
    int         files; /* how many scenes, or MANY_FILES */
    const char *summary, *examples;
} CommandInfo;

extern const CommandInfo command_table[COMMAND_COUNT];

typedef enum OptionId {
#define OPTION(id, letter, name, argument, commands, take, wants, help) OPTION_##id,
#include "cli/options.def"
#undef OPTION
    OPTION_COUNT
} OptionId;

typedef struct OptionInfo {
    char        letter;          /* 0: none */
    const char *name, *argument; /* `argument` NULL: it takes none */
    unsigned    commands;
    const char *wants, *help;
} OptionInfo;

extern const OptionInfo option_info[OPTION_COUNT];

bool option_belongs(OptionId id, CommandId command);

/* What `--aov` chooses; colour and alpha are always there. */
typedef enum Aov {
    AOV_Z      = 1,
    AOV_P      = 2,
    AOV_N      = 4,
    AOV_ALBEDO = 8,
    AOV_ID     = 16,
    AOV_STEPS  = 32,
    AOV_ALL    = 63
} Aov;

typedef enum When { WHEN_AUTO, WHEN_ALWAYS, WHEN_NEVER } When;
typedef enum StatsForm { STATS_NONE, STATS_TEXT, STATS_JSON } StatsForm;

/* --set */
typedef struct Setting {
    const char *name;
    double      values[4];
    size_t      count;
} Setting;

typedef struct ExitPair {
    int from, to;
} ExitPair;

/* --limit; 0: none */
typedef struct Limits {
    double   time;   /* seconds, of the whole command */
    uint64_t memory; /* bytes */
    uint64_t pixels, samples;
} Limits;

typedef struct Options {
    CommandId command;
    bool      help;
    int       argc; /* the whole command line, for a report of a crash */
    char    **argv;

    struct {
        const char **items;
        size_t       count, capacity;
    } files, outputs;
    struct {
        Setting *items;
        size_t   count, capacity;
    } settings;
    struct {
        ExitPair *items;
        size_t    count, capacity;
    } exit_map;
    double zones[KRS_MOST_ZONES][4];
    size_t zone_count;

    uint32_t      width, height, samples;          /* 0: not given */
    const char   *camera, *device, *cache, *after; /* NULL: not given */
    bool          cropped;
    uint32_t      crop[4]; /* x, y, width, height */
    bool          animated;
    uint32_t      first_frame, last_frame;
    double        fps, time;
    unsigned      aovs;
    bool          exposed, tone_mapped; /* --exposure, --tone-map were given */
    double        exposure;
    ToneMap       tone_map;
    bool          no_beams, no_upsampling, no_occlusion, no_filter, area_shadows;
    KrsEarlyOuts  early_outs;
    bool          frame_values;
    KrsComponents components;
    KrsNormals    normals;
    double        error; /* 0: not given */
    KrsTrace      trace;
    KrsSchedule   schedule;
    uint64_t      seed, points;
    double        seconds;  /* of the search of `krs validate` */
    double        deadline; /* seconds */
    Limits        limits;
    const char   *root; /* NULL: not given */
    bool          untrusted;
    double        tolerance, farthest; /* of rays that are asked about; tolerance 0: not given */
    bool          on_device;
    StatsForm     stats;
    bool          stamp, binary, json, no_device, json_diagnostics, quiet;
    When          color;

    Arena *arena; /* for whatever a command needs until the process ends */
} Options;

/* Understands the words behind `krs`.  KRS_OK, or KRS_BAD_ARGUMENT after one line on standard
   error that says what is wrong.  `options->arena` must be set. */
KrsStatus options_parse(Options *options, int argc, char **argv);

/* What each exit status means, in a sentence of several lines. */
extern const char exit_statuses[];

/* `krs --help`, `krs COMMAND --help`. */
void help_print(FILE *out);
void help_print_command(CommandId command, FILE *out);

/* manual.c: the same as a page for man, of a command or, with COMMAND_COUNT, of `krs` itself. */
void manual_print(CommandId command, FILE *out);
/* completion.c: what a shell (bash, zsh or fish; else false) completes command lines by. */
bool completion_print(const char *shell, FILE *out);

#endif
