/*
 * render_outputs.c: the files that `krs render` writes, looked at before the work begins.
 */
#include <string.h>
#include <unistd.h>

#include "cli/shell/console.h"
#include "cli/picture/frame_paths.h"
#include "cli/picture/picture.h"
#include "cli/picture/render.h"

static void choose_outputs(Render *render)
{
    const Options *options = render->options;
    render->outputs        = options->outputs.items;
    render->output_count   = options->outputs.count;
    if (render->output_count > 0 || options->raw)
        return;
    static const char *const endings[] = {".exr", ".png"};
    enum { DEFAULT_OUTPUTS = 2 };
    render->outputs = arena_new_array(options->arena, const char *, DEFAULT_OUTPUTS);
    for (; render->output_count < DEFAULT_OUTPUTS; render->output_count++) {
        Text text = {.arena = options->arena};
        text_format(&text, "%s%s%s", scene_name(options->arena, options->files.items[0]),
                    options->animated ? "-%04d" : "", endings[render->output_count]);
        render->outputs[render->output_count] = text.bytes;
    }
}

const char *output_names(Arena *arena, const char *const *outputs, size_t count)
{
    Text names = {.arena = arena};
    for (size_t i = 0; i < count; i++)
        text_format(&names, "%s`%s`", i == 0 ? "" : i + 1 < count ? ", " : " and ", outputs[i]);
    return names.bytes;
}

void render_say_written(const Render *render, double seconds)
{
    const Options *options = render->options;
    Text           names   = {.arena = options->arena};
    if (options->quiet || render->output_count == 0)
        return;
    text_add(&names, output_names(options->arena, render->outputs, render->output_count));
    if (strcmp(render->outputs[0], STANDARD_OUTPUT) == 0)
        return; /* who reads it knows */
    if (seconds > 0)
        text_format(&names, " in %.2f s", seconds);
    if (options->animated)
        say("wrote frames %u to %u to %s", options->first_frame, options->last_frame, names.bytes);
    else
        say("wrote %s", names.bytes);
}

static KrsStatus check_name(const Render *render, size_t index)
{
    const Options *options = render->options;
    const char    *path    = render->outputs[index];
    if (file_form(path) == FORM_UNKNOWN)
        return say_usage(options, "the output `%s` ends in neither .exr nor .png", path);
    if (strcmp(path, STANDARD_OUTPUT) == 0 && (options->stats != STATS_NONE || isatty(1)))
        return say_usage(options, "the picture would go to %s; write it to a file",
                         isatty(1) ? "the terminal" : "where --stats goes");
    if (options->animated && frame_places(path) == 0)
        return say_usage(options, "with --frames, `%s` needs a place for the number: %%04d", path);
    if (options->animated && frame_places(path) > 1)
        return say_usage(options, "`%s` has more than one place for the number of the frame", path);
    for (size_t other = 0; other < index; other++)
        if (are_one_file(options, render->outputs[other], path))
            return say_usage(options, "the output `%s` is asked for twice", path);
    return KRS_OK;
}

/* Refuses raw pixels where they cannot go to standard output alone. */
static KrsStatus check_raw(const Options *options)
{
    if (!options->raw)
        return KRS_OK;
    if (options->stats != STATS_NONE || isatty(1))
        return say_usage(options, "--raw would go to %s; pipe it to an encoder",
                         isatty(1) ? "the terminal" : "where --stats goes");
    if (options->skip_existing)
        return say_usage(options, "--raw has all frames, so there is nothing to skip");
    for (size_t i = 0; i < options->outputs.count; i++)
        if (strcmp(options->outputs.items[i], STANDARD_OUTPUT) == 0)
            return say_usage(options, "--raw and `-o -` both go to standard output");
    return KRS_OK;
}

static KrsStatus check_outputs(const Render *render)
{
    const Options *options = render->options;
    KrsStatus      raw     = check_raw(options);
    if (raw != KRS_OK)
        return raw;
    for (size_t i = 0; i < render->output_count; i++) {
        const char *path   = frame_path(options, render->outputs[i], options->first_frame);
        KrsStatus   status = check_name(render, i);
        if (status == KRS_OK)
            status = check_output(options, path);
        if (status != KRS_OK)
            return status;
    }
    return KRS_OK;
}

KrsStatus render_begin(Render *render, const Options *options)
{
    render->options = options;
    choose_outputs(render);
    KrsStatus status = checkpoint_begin(&render->checkpoint, options,
                                        render->output_count > 0 ? render->outputs[0] : NULL);
    return status == KRS_OK ? check_outputs(render) : status;
}
