/*
 * slicing.h: one run of `krs slice`: slice.c makes the sections, files.c and picture.c write them.
 */
#ifndef KRS_SLICING_H
#define KRS_SLICING_H

#include "cli/shell/commands.h"
#include "cli/shell/supervise.h"

/* --exposure, in the order of exposure_choices. */
enum { EXPOSURE_BINARY, EXPOSURE_GRAY };

/* A section, and where it is: from `low` to `high` along the axis, with its plane between. */
typedef struct Layer {
    const KrsSection *section;
    uint32_t          number; /* from 1 */
    double            low, at, high;
} Layer;

/* The properties that files have in common; lengths are those of the scene. */
typedef struct SliceSheet {
    double      low[2], high[2];    /* around all sections, in their plane */
    double      bottom, top, layer; /* along the axis */
    uint32_t    layer_count;
    bool        stacked;  /* layers, not one section */
    int         digits;   /* behind the point of numbers */
    const char *unit;     /* "mm" */
    double      metres;   /* of a length of 1 */
    double      per_unit; /* pixels */
    uint32_t    width, height;
    bool        gray;
} SliceSheet;

/* A file that is written, of one layer or of all. */
typedef struct SliceFile {
    const SliceSheet *sheet;
    OutputFile       *file;
    OutputError      *error;
    char              buffer[1 << 16];
    size_t            length;
} SliceFile;

typedef struct SliceFormat {
    const char *ending;
    bool        has_layers; /* one file can have all */
    bool        has_arcs;
    bool (*begin)(SliceFile *file);
    bool (*add)(SliceFile *file, const Layer *layer);
    bool (*end)(SliceFile *file);
} SliceFormat;

/* files.c: the format by the ending of a path, or that of standard output; NULL: there is none. */
const SliceFormat *slice_format(const char *path);
#define SLICE_ENDINGS ".svg, .dxf, .cli or .png"
/* Writes all that was added to the file. */
bool slice_file_flush(SliceFile *file);

/* picture.c: a picture of a layer. */
bool slice_add_picture(SliceFile *file, const Layer *layer);

#endif
