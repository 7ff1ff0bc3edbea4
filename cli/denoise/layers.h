/*
 * layers.h: which channels of a file are colours, and what else is known of its pixels.
 */
#ifndef KRS_CLI_LAYERS_H
#define KRS_CLI_LAYERS_H

#include "cli/denoise/any_exr.h"

typedef enum LayerKind {
    LAYER_COLOR,
    LAYER_NORMAL,
    LAYER_ALBEDO,
    LAYER_POSITION,
    LAYER_DEPTH,
    LAYER_NOISE,
    LAYER_VARIANCE,
    LAYER_KINDS
} LayerKind;

typedef struct Layers {
    const char *prefix;                   /* that they share: "", "ViewLayer." */
    int         channels[LAYER_KINDS][3]; /* numbers of channels; -1: there is none */
} Layers;

/* Finds them; KRS_IO_ERROR and words: there are no colours. */
KrsStatus layers_find(const Options *options, const AnyExr *exr, Layers *layers);
bool      layers_have(const Layers *layers, LayerKind kind);

#endif
