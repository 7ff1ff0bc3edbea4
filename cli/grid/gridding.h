/*
 * gridding.h: one run of `krs grid`: grid.c makes the samples, files.c and cells.c write them, and vdb.c
 * lets OpenVDB do so.
 */
#ifndef KRS_GRIDDING_H
#define KRS_GRIDDING_H

#include "cli/shell/commands.h"
#include "cli/shell/supervise.h"

/* The properties that files have in common. */
typedef struct GridSheet {
    KrsGridShape shape;
    bool         fog, color, material, half; /* half: numbers but those of materials have 16 bits */
    double       metres;                     /* a length of 1, in files that say it */
    size_t       near;                       /* bricks that sparse files have */
} GridSheet;

/* A file that is written. */
typedef struct GridFile {
    const GridSheet *sheet;
    OutputFile      *file;
    OutputError     *error;
    Arena           *arena;
    void            *own; /* of the format */
} GridFile;

typedef struct GridFormat {
    const char *ending;
    bool        sparse;       /* it has bricks that are near, and a band */
    bool        has_material; /* numbers of materials */
    bool        has_half;     /* numbers of 16 bits */
    double      max_side;     /* samples along an axis */
    double      min_cell;     /* a length */
    bool (*begin)(GridFile *file);
    bool (*add)(GridFile *file, const KrsGridBrick *brick);
    bool (*end)(GridFile *file);
} GridFormat;

/* files.c: the format by the ending of a path, or that of standard output; NULL: there is none. */
const GridFormat *grid_format(const char *path);
/* Tells whether OpenVDB writes what has this path. */
bool grid_is_vdb(const char *path);
#define GRID_ENDINGS ".vdb, .npy, .nii, .ktx2, .vti or .vtu"
/* These return a number in 16 bits as IEEE 754 has it, rounded towards 0, but what is below 0 stays
   so; and what these bits are. */
uint16_t half_bits(float number);
float    half_value(float number);
/* Returns "distance" or "density". */
const char *grid_name(const GridSheet *sheet);
/* Returns the bytes of a sample in files that are made in memory. */
size_t grid_sample_bytes(const GridSheet *sheet);

/* cells.c: VTK's cells, as XML. */
bool grid_begin_vtu(GridFile *file);
bool grid_add_vtu(GridFile *file, const KrsGridBrick *brick);
bool grid_end_vtu(GridFile *file);

/* vdb.c */
bool grid_begin_vdb(GridFile *file);
bool grid_add_vdb(GridFile *file, const KrsGridBrick *brick);
bool grid_end_vdb(GridFile *file);
/* Tells whether OpenVDB is there; else it is said of what `path` names. */
KrsStatus grid_check_vdb(const char *path);

#endif
