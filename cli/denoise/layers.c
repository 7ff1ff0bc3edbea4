/*
 * layers.c: finds the channels of a picture by the names of layers.def.
 */
#include "cli/denoise/layers.h"

#include <string.h>
#include <strings.h>

#include "cli/shell/console.h"

typedef struct LayerName {
    LayerKind   kind;
    const char *name, *letters;
} LayerName;

static const LayerName names[] = {
#define LAYER(kind, name, letters) {LAYER_##kind, name, letters},
#include "cli/denoise/layers.def"
#undef LAYER
};
enum { NAMES = sizeof names / sizeof *names };

bool layers_have(const Layers *layers, LayerKind kind) { return layers->channels[kind][0] >= 0; }

static int find_channel(const Options *options, const AnyExr *exr, const char *prefix,
                        const LayerName *layer, char letter)
{
    Text name = {.arena = options->arena};
    text_format(&name, "%s%s%s%c", prefix, layer->name, layer->name[0] ? "." : "", letter);
    for (size_t i = 0; i < exr->count; i++)
        if (strcasecmp(exr->channels[i].name, name.bytes) == 0 &&
            exr->channels[i].type != SAMPLE_UINT)
            return (int)i;
    return -1;
}

/* Takes the channels of a layer, if the file has them all. */
static void take_layer(const Options *options, const AnyExr *exr, const LayerName *layer,
                       Layers *layers)
{
    int found[3] = {-1, -1, -1};
    for (size_t k = 0; layer->letters[k]; k++) {
        found[k] = find_channel(options, exr, layers->prefix, layer, layer->letters[k]);
        if (found[k] < 0)
            return;
    }
    memcpy(layers->channels[layer->kind], found, sizeof found);
}

static void take_layers(const Options *options, const AnyExr *exr, Layers *layers)
{
    memset(layers->channels, -1, sizeof layers->channels);
    for (size_t i = 0; i < NAMES; i++)
        if (!layers_have(layers, names[i].kind))
            take_layer(options, exr, &names[i], layers);
}

/* Returns what stands before the first part of a channel's name that is followed by that of a layer with colours; NULL:
   the channel is none of these. */
static const char *prefix_of(const Options *options, const char *channel)
{
    const size_t length = strlen(channel);
    for (size_t i = 0; i < NAMES; i++) {
        const size_t of_layer = strlen(names[i].name) + 2; /* with ".R" */
        if (names[i].kind == LAYER_COLOR && names[i].name[0] && length > of_layer &&
            channel[length - of_layer - 1] == '.' &&
            strncasecmp(channel + length - of_layer, names[i].name, of_layer - 2) == 0)
            return arena_copy_text(options->arena, channel, length - of_layer);
    }
    return NULL;
}

KrsStatus layers_find(const Options *options, const AnyExr *exr, Layers *layers)
{
    Text prefix = {.arena = options->arena};
    text_format(&prefix, "%s%s", options->denoised_layer ? options->denoised_layer : "",
                options->denoised_layer ? "." : "");
    layers->prefix = prefix.bytes;
    take_layers(options, exr, layers);
    for (size_t i = 0;
         i < exr->count && !options->denoised_layer && !layers_have(layers, LAYER_COLOR); i++) {
        const char *found = prefix_of(options, exr->channels[i].name);
        layers->prefix    = found ? found : "";
        if (found)
            take_layers(options, exr, layers);
    }
    if (layers_have(layers, LAYER_COLOR))
        return KRS_OK;
    say("cannot denoise `%s`: it has no colours %s%s: neither R, G, B nor a layer Combined",
        exr->path, options->denoised_layer ? "of the layer " : "without a layer",
        options->denoised_layer ? options->denoised_layer : "");
    return KRS_IO_ERROR;
}
