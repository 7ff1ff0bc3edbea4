/*
 * scene.c: from the path of a scene and the options to a compiled scene and a frame of it.
 */
#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/shell/input.h"
#include "cli/shell/supervise.h"
#include "runtime/writer/atomic.h"

/* Prints "error[E0203]: message" of the first line in color; the rest is drawn in ASCII and stays
   plain. */
static void print_colored(const KrsDiagnostic *diagnostic)
{
    size_t head = strcspn(diagnostic->text, ":\n"), line = strcspn(diagnostic->text, "\n");
    int    color = diagnostic->error ? 31 : diagnostic->note ? 36 : 33;
    fprintf(stderr, "\033[1;%dm%.*s\033[0;1m%.*s\033[0m%s", color, (int)head, diagnostic->text,
            (int)(line - head), diagnostic->text + head, diagnostic->text + line);
}

static void print_diagnostic(void *user, const KrsDiagnostic *diagnostic)
{
    DiagnosticSink *sink = user;
    if (sink->options->quiet && !diagnostic->error)
        return;
    console_clear();
    sink->errors += diagnostic->error;
    sink->warnings += !diagnostic->error && !diagnostic->note;
    if (sink->options->json_diagnostics)
        fprintf(stderr, "%s\n", diagnostic->json);
    else if (console_color(sink->options))
        print_colored(diagnostic);
    else
        fputs(diagnostic->text, stderr);
    if (!sink->options->json_diagnostics)
        fputc('\n', stderr);
}

const char *scene_root(const Options *options, const char *path)
{
    const char *slash = strrchr(path, '/');
    if (options->root || !options->untrusted)
        return options->root;
    return slash ? arena_copy_text(options->arena, path, (size_t)(slash - path) + 1) : ".";
}

/* Returns how numbers of the scene are compiled: whoever watches a scene is about to edit it. */
static KrsSpecialize find_specialize(const Options *options)
{
    if (options->specialize >= 0)
        return (KrsSpecialize)options->specialize;
    return options->command == COMMAND_WATCH || options->command == COMMAND_VIEW
               ? KRS_SPECIALIZE_AUTO
               : KRS_SPECIALIZE_NUMBERS;
}

static bool shows_pictures(const Options *options)
{
    return options->command == COMMAND_RENDER || options->command == COMMAND_WATCH ||
           options->command == COMMAND_VIEW || options->command == COMMAND_EXPORT ||
           (options->command == COMMAND_INFO && options->cost);
}

/* Tells whether the command says something of a figure, or writes it. */
static bool takes_figures(const Options *options)
{
    return options->command == COMMAND_SLICE || options->command == COMMAND_CHECK ||
           (options->command == COMMAND_INFO && !options->print && !options->cost);
}

KrsOptions scene_options(DiagnosticSink *sink, const char *path)
{
    const Options *options = sink->options;
    Pack          *pack    = pack_of(options, path);
    return (KrsOptions){.diagnostic   = print_diagnostic,
                        .user         = sink,
                        .specialize   = find_specialize(options),
                        .gradients    = options->how.methods.normals == KRS_NORMALS_ANALYTIC,
                        .research     = options->how.methods.trace >= KRS_TRACE_TAYLOR,
                        .memory_limit = options->limits.memory,
                        .studio       = shows_pictures(options) && !options->no_studio,
                        .pictures     = shows_pictures(options),
                        .assembly     = options->command == COMMAND_MESH,
                        .motion       = options->command == COMMAND_MESH && options->animated,
                        .beams        = options->command == COMMAND_MESH && options->mesh_beams,
                        .figures      = takes_figures(options),
                        .outlines     = options->command == COMMAND_MESH,
                        .root         = scene_root(options, path),
                        .load         = pack ? pack_load : NULL,
                        .load_user    = pack,
                        .font         = pack ? pack_font : NULL,
                        .font_user    = pack};
}

void scene_print_counts(const DiagnosticSink *sink)
{
    size_t errors = sink->errors, warnings = sink->warnings;
    if (sink->options->json_diagnostics || errors + warnings == 0)
        return;
    if (errors > 0)
        fprintf(stderr, "%zu error%s%s", errors, errors == 1 ? "" : "s", warnings ? ", " : "");
    if (warnings > 0)
        fprintf(stderr, "%zu warning%s", warnings, warnings == 1 ? "" : "s");
    fputc('\n', stderr);
}

KrsStatus scene_readable(const Options *options, const char *path)
{
    if (is_input(options, path))
        return KRS_OK;
    struct stat info;
    int         file     = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    bool        readable = file >= 0 && fstat(file, &info) == 0;
    if (readable && S_ISDIR(info.st_mode)) {
        errno    = EISDIR;
        readable = false;
    }
    if (!readable && errno == EACCES && options->needs)
        return KRS_OK; /* a link may lead out of the sandbox: who reads the scene says so */
    if (!readable)
        say("cannot read `%s`: %s", path, strerror(errno));
    if (file >= 0)
        close(file);
    return readable ? KRS_OK : KRS_IO_ERROR;
}

KrsStatus check_scene_not_overwritten(const Options *options, const char *output)
{
    struct stat from, to;
    const char *path = options->files.items[0];
    if (stat(path, &from) != 0 || stat(output, &to) != 0 || !S_ISREG(to.st_mode) ||
        from.st_dev != to.st_dev || from.st_ino != to.st_ino)
        return KRS_OK;
    return say_usage(options, "the output `%s` would take the place of `%s`", output, path);
}

KrsStatus check_output(const Options *options, const char *output)
{
    OutputError error;
    KrsStatus   status = check_scene_not_overwritten(options, output);
    if (status != KRS_OK || output_check(output, &error) == KRS_OK)
        return status;
    say("%s", error.message);
    return error.status;
}

KrsStatus say_status(KrsStatus status, const char *path)
{
    if (status == KRS_OUT_OF_MEMORY)
        say("out of memory with `%s`", path);
    else if (status == KRS_INTERNAL)
        say("`%s` brought out a bug of krs", path);
    return status; /* diagnostics have told of a wrong scene, or one that cannot be read */
}

/* Reports that a scene needs more than compiling may use, of which the system may permit less than
   the options. */
static KrsStatus say_too_large(const Options *options, const char *path)
{
    const uint64_t limit = options->limits.memory ? options->limits.memory : KRS_USUAL_MEMORY;
    struct rlimit  of_system;
    if (getrlimit(RLIMIT_AS, &of_system) == 0 && of_system.rlim_cur < limit)
        return say_status(KRS_OUT_OF_MEMORY, path);
    say("out of memory with `%s`: compiling it takes more than %llu MiB; --limit memory=%lluM "
        "allows more",
        path, (unsigned long long)(limit >> 20), (unsigned long long)(limit >> 18));
    return KRS_OUT_OF_MEMORY;
}

static long long file_size(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 ? (long long)info.st_size : 0;
}

void scene_enter_compile(const char *path)
{
    struct stat about;
    if (stat(path, &about) == 0 && S_ISFIFO(about.st_mode))
        stage_size("`%s` is a pipe, and who writes to it has not ended", path);
    else
        stage_size("`%s` has %lld bytes, and may use more", path, file_size(path));
    stage_enter(STAGE_COMPILE);
}

const char *scene_input(const Options *options, const char *path)
{
    return is_input(options, path) ? options->input : NULL;
}

KrsStatus scene_compile(const Options *options, const char *path, const KrsOptions *with,
                        KrsScene **scene)
{
    const char *input = scene_input(options, path);
    Pack       *pack  = pack_of(options, path);
    if (pack) {
        const PackEntry *text = pack_find(&pack->files, pack->scene);
        return krs_compile_text(text->bytes, text->length, pack->scene, with, scene);
    }
    return input ? krs_compile_text(input, options->input_length, path, with, scene)
                 : krs_compile_file(path, with, scene);
}

KrsStatus scene_open(const Options *options, const char *path, KrsScene **scene)
{
    *scene           = NULL;
    KrsStatus status = scene_readable(options, path);
    if (status != KRS_OK)
        return status;
    scene_enter_compile(path);
    DiagnosticSink sink = {.options = options};
    KrsOptions     with = scene_options(&sink, path);
    console_doing(options, "compiling the scene");
    status = scene_compile(options, path, &with, scene);
    console_doing(options, NULL);
    scene_print_counts(&sink);
    if (status == KRS_OK)
        stage_size("`%s` makes %zu bytes of distance code in %zu components", path,
                   krs_scene_program(*scene)->glsl_length, krs_component_count(*scene));
    stage_enter(STAGE_START);
    return status == KRS_OUT_OF_MEMORY ? say_too_large(options, path) : say_status(status, path);
}

KrsStatus scene_check_shaders(const Options *options, const KrsScene *scene)
{
    DiagnosticSink       sink = {.options = options};
    const KrsDiagnostic *why  = krs_scene_too_large(scene);
    if (!why)
        return KRS_OK;
    print_diagnostic(&sink, why);
    scene_print_counts(&sink);
    return KRS_BAD_SCENE;
}

void say_renderer(const Options *options, const KrsScene *scene, const KrsRenderer *renderer,
                  KrsStatus status)
{
    if (status == KRS_BAD_SCENE)
        scene_check_shaders(options, scene);
    say("%s", krs_renderer_message(renderer));
}

const char *denoised_name(const Options *options)
{
    Text        name   = {.arena = options->arena};
    const char *slash  = strrchr(options->files.items[0], '/');
    const char *file   = slash ? slash + 1 : options->files.items[0];
    const char *dot    = strrchr(file, '.');
    const int   length = (int)(dot && dot > file ? (size_t)(dot - file) : strlen(file));
    text_format(&name, "%.*s-denoised.exr", length, file);
    return name.bytes;
}

const char *scene_name(Arena *arena, const char *path)
{
    const char *slash  = strrchr(path, '/');
    const char *name   = slash ? slash + 1 : path;
    size_t      length = strlen(name);
    if (strcmp(path, "<stdin>") == 0)
        return "stdin";
    if (pack_is_named(name))
        length -= strlen(PACK_ENDING);
    else if (length > 4 && strcmp(name + length - 4, ".krs") == 0)
        length -= 4;
    return arena_copy_text(arena, name, length);
}

static KrsStatus say_unknown_parameter(const Options *options, const KrsScene *scene,
                                       const char *name)
{
    size_t       count = krs_parameter_count(scene);
    const char **names = arena_new_array(options->arena, const char *, count + 1);
    for (size_t i = 0; i < count; i++) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        names[i] = parameter.name;
    }
    const char *nearest = nearest_name(name, names, count);
    if (nearest)
        return say_usage(options, "the scene has no param `%s`; did you mean `%s`?", name, nearest);
    return say_usage(options, "the scene has no param `%s`; `krs info` lists what it has", name);
}

/* Adds "1.5", or "90deg" if the scene says so. */
static void add_value(Text *text, double value, bool degrees)
{
    text_format(text, degrees ? "%.6gdeg" : "%.6g", degrees ? value * 180 / M_PI : value);
}

static KrsStatus say_outside(const Options *options, const KrsParameter *parameter, size_t index,
                             double value)
{
    Text range = {.arena = options->arena}, found = {.arena = options->arena};
    add_value(&range, parameter->low[index], parameter->degrees);
    text_add(&range, " to ");
    add_value(&range, parameter->high[index], parameter->degrees);
    add_value(&found, value, parameter->degrees);
    return say_usage(options, "param `%s` goes from %s; %s is outside", parameter->name,
                     range.bytes, found.bytes);
}

/* Reports why krs_state_set refused a setting. */
static KrsStatus say_refused_setting(const Options *options, const KrsScene *scene,
                                     const KrsState *state, const Setting *setting)
{
    KrsParameter parameter;
    size_t       index = 0;
    while (krs_parameter(scene, index, &parameter) == KRS_OK &&
           strcmp(parameter.name, setting->name) != 0)
        index++;
    if (index == krs_parameter_count(scene))
        return say_unknown_parameter(options, scene, setting->name);
    if (setting->count != parameter.components)
        return say_usage(options, "param `%s` takes %u number%s, not %zu", setting->name,
                         parameter.components, parameter.components == 1 ? "" : "s",
                         setting->count);
    for (size_t i = 0; i < setting->count; i++)
        if (!(setting->values[i] >= parameter.low[i] && setting->values[i] <= parameter.high[i]))
            return say_outside(options, &parameter, i, setting->values[i]);
    const char *place = krs_state_unbounded(state);
    if (place)
        return say_usage(options,
                         "with this value of param `%s` the slope of the expression at %s "
                         "has no bound",
                         setting->name, place);
    return say_usage(options, "with this value of param `%s` something in the scene is not finite",
                     setting->name);
}

KrsStatus scene_set_time(const Options *options, KrsState *state, double time)
{
    if (krs_state_set_time(state, time) == KRS_OK)
        return KRS_OK;
    const char *place = krs_state_unbounded(state);
    if (place)
        return say_usage(options, "at time %g the slope of the expression at %s has no bound", time,
                         place);
    return say_usage(options, "at time %g something in the scene is not finite", time);
}

KrsStatus scene_state(const Options *options, const KrsScene *scene, KrsState **state)
{
    KrsStatus status = krs_state_new(scene, state);
    if (status != KRS_OK)
        return say_status(status, options->files.items[0]);
    for (size_t i = 0; i < options->settings.count && status == KRS_OK; i++) {
        const Setting *setting = &options->settings.items[i];
        status = krs_state_set(*state, setting->name, setting->values, setting->count);
        if (status == KRS_BAD_ARGUMENT)
            say_refused_setting(options, scene, *state, setting);
    }
    if (status == KRS_OK)
        status = krs_state_set_zones(*state, (const double(*)[4])options->zones,
                                     options->zone_count);
    if (status == KRS_OK)
        status = scene_set_time(options, *state, options->time);
    if (status == KRS_OK && shows_pictures(options) &&
        (options->settings.count > 0 || options->time != 0))
        status = krs_state_fit_camera(*state);
    if (status != KRS_OK) {
        krs_state_free(*state);
        *state = NULL;
    }
    return status;
}

static KrsStatus say_unknown_camera(const Options *options, const char *const *names, size_t count)
{
    const char *nearest = nearest_name(options->camera, names, count);
    Text        known   = {.arena = options->arena};
    for (size_t i = 0; i < count; i++)
        text_format(&known, "%s`%s`", i ? ", " : "", names[i]);
    if (nearest)
        return say_usage(options, "the scene has no camera `%s`; did you mean `%s`?%s%s",
                         options->camera, nearest, count > 1 ? " It has " : "",
                         count > 1 ? known.bytes : "");
    return say_usage(options, "the scene has no camera `%s`; it has %s", options->camera,
                     count ? known.bytes : "none with a name; give it one: `camera side { ... }`");
}

KrsStatus scene_camera(const Options *options, const KrsScene *scene, size_t *camera)
{
    size_t       count = krs_camera_count(scene), named = 0;
    const char **names = arena_new_array(options->arena, const char *, count + 1);
    *camera            = 0;
    for (size_t i = 0; options->camera && i < count; i++) {
        const char *name = krs_camera_name(scene, i);
        if (name && strcmp(name, options->camera) == 0) {
            *camera = i;
            return KRS_OK;
        }
        if (name)
            names[named++] = name;
    }
    if (!options->camera)
        return KRS_OK;
    return say_unknown_camera(options, names, named);
}

bool scene_is_first_of_name(const KrsScene *scene, size_t index)
{
    KrsComponent component, other;
    krs_component(scene, index, &component);
    for (size_t i = 0; i < index; i++) {
        krs_component(scene, i, &other);
        if (strcmp(other.name, component.name) == 0)
            return false;
    }
    return true;
}

/* Reads a number of `krs info`, with which no name begins. */
static bool is_number_of_component(const char *text, size_t count, size_t *number)
{
    char               *end;
    const unsigned long value = strtoul(text, &end, 10);
    if (!isdigit((unsigned char)text[0]) || *end != '\0' || value < 1 || value > count)
        return false;
    *number = value;
    return true;
}

KrsStatus scene_component(const Options *options, const KrsScene *scene, size_t *number)
{
    const char *wanted = options->component;
    size_t      count  = krs_component_count(scene);
    Text        known  = {.arena = options->arena};
    for (size_t i = 0; wanted && i < count; i++) {
        KrsComponent component;
        krs_component(scene, i, &component);
        if (strcmp(component.name, wanted) == 0) {
            *number = i + 1;
            return KRS_OK;
        }
        if (scene_is_first_of_name(scene, i))
            text_format(&known, "%s`%s`", i ? ", " : "", component.name);
    }
    if (!wanted || is_number_of_component(wanted, count, number))
        return KRS_OK;
    return say_usage(options, "the scene has no component `%s`; it has %s", wanted,
                     count ? known.bytes : "none");
}
