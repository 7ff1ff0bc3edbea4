/* picture.c: sections as pictures, row by row. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/slice/slicing.h"
#include "runtime/writer/png.h"

/* A piece of a contour in pixels, y downwards, from its upper end to its lower one. */
typedef struct PixelEdge {
    double top[2], bottom[2], side; /* 1: the solid is to its right */
} PixelEdge;

static int compare_edges(const void *a, const void *b)
{
    const PixelEdge *x = a, *y = b;
    return (x->top[1] > y->top[1]) - (x->top[1] < y->top[1]);
}

static void to_pixels(const SliceSheet *sheet, const double at[2], double pixels[2])
{
    double middle[2] = {0.5 * (sheet->low[0] + sheet->high[0]),
                        0.5 * (sheet->low[1] + sheet->high[1])};
    pixels[0]        = 0.5 * sheet->width + sheet->per_unit * (at[0] - middle[0]);
    pixels[1]        = 0.5 * sheet->height - sheet->per_unit * (at[1] - middle[1]);
}

static size_t find_edges(const SliceSheet *sheet, const KrsSection *section, PixelEdge *edges)
{
    size_t count = 0;
    for (size_t c = 0; c < section->contour_count; c++) {
        const KrsContour *contour = &section->contours[c];
        for (size_t i = 0; i < contour->count; i++) {
            PixelEdge edge = {.side = 1};
            to_pixels(sheet, section->points[contour->first + i], edge.top);
            to_pixels(sheet, section->points[contour->first + (i + 1) % contour->count],
                      edge.bottom);
            if (edge.top[1] > edge.bottom[1]) {
                PixelEdge other = edge;
                memcpy(edge.top, other.bottom, sizeof edge.top);
                memcpy(edge.bottom, other.top, sizeof edge.bottom);
                edge.side = -1;
            }
            if (edge.top[1] < edge.bottom[1] && edge.bottom[1] > 0 && edge.top[1] < sheet->height)
                edges[count++] = edge;
        }
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    return count;
}

static double edge_x(const PixelEdge *edge, double y)
{
    double part = (y - edge->top[1]) / (edge->bottom[1] - edge->top[1]);
    return edge->top[0] + fmax(0, fmin(1, part)) * (edge->bottom[0] - edge->top[0]);
}

/* Adds to each pixel of a row how its solid part differs from that of the pixel before, for a line from x = a to
   x = b, within the row, that is so tall. */
static void add_line(float *row, double a, double b, double tall)
{
    double least = fmin(a, b), most = fmax(a, b), before = 0;
    size_t first = (size_t)least, last = most > least ? (size_t)ceil(most) : first + 1;
    last = last > first ? last : first + 1;
    for (size_t x = first; x < last;
         x++) { /* what is to the right of the line, in pixels up to x */
        double end = fmin((double)x + 1, most), begin = fmax((double)x, least);
        double slope = most > least ? 1 / (most - least) : 0;
        /* The part of the line up to the end of this pixel, and its mean distance from that end. */
        double done  = most > least ? (end - least) * slope : 1;
        double here  = most > least ? (end - begin) * slope : 1;
        double cover = (done - here) + here * ((double)x + 1 - 0.5 * (begin + end));
        row[x] += (float)(tall * (cover - before));
        before = cover;
    }
    row[last] += (float)(tall * (1 - before));
}

/* Does the same for a line that may leave the picture. */
static void add_clipped(float *row, double a, double b, double tall, double width)
{
    double sides[2] = {0, width};
    for (int i = 0; i < 2; i++)
        if ((a < sides[i]) != (b < sides[i]) && a != sides[i] && b != sides[i]) {
            double part = (sides[i] - a) / (b - a);
            add_clipped(row, a, sides[i], part * tall, width);
            add_clipped(row, sides[i], b, (1 - part) * tall, width);
            return;
        }
    add_line(row, fmax(0, fmin(width, a)), fmax(0, fmin(width, b)), tall);
}

static void add_edge(const SliceSheet *sheet, const PixelEdge *edge, uint32_t y, float *row)
{
    double middle = y + 0.5, top = fmax(y, edge->top[1]), bottom = fmin(y + 1.0, edge->bottom[1]);
    if (sheet->gray)
        add_clipped(row, edge_x(edge, top), edge_x(edge, bottom), edge->side * (bottom - top),
                    sheet->width);
    else if (edge->top[1] <= middle && edge->bottom[1] > middle) {
        double x = ceil(edge_x(edge, middle) - 0.5);
        row[(size_t)fmax(0, fmin(sheet->width, x))] += (float)edge->side;
    }
}

static void fill_row(const SliceSheet *sheet, const float *row, uint8_t *pixels)
{
    double solid = 0;
    for (uint32_t x = 0; x < sheet->width; x++) {
        solid += row[x];
        pixels[x] = (uint8_t)lrint(255 * fmax(0, fmin(1, fabs(solid))));
    }
}

/* Edges that have begun and not ended are the first `open` of the list. */
static void fill_rows(const SliceSheet *sheet, PixelEdge *edges, size_t count, uint8_t *pixels,
                      float *row)
{
    size_t begun = 0, open = 0;
    for (uint32_t y = 0; y < sheet->height; y++) {
        size_t left = 0;
        memset(row, 0, (sheet->width + 2) * sizeof *row);
        for (; begun < count && edges[begun].top[1] < y + 1.0; begun++)
            edges[open++] = edges[begun];
        for (size_t i = 0; i < open; i++)
            if (edges[i].bottom[1] > y) {
                add_edge(sheet, &edges[i], y, row);
                edges[left++] = edges[i];
            }
        open = left;
        fill_row(sheet, row, pixels + (size_t)y * sheet->width);
    }
}

bool slice_add_picture(SliceFile *file, const Layer *layer)
{
    const SliceSheet *sheet   = file->sheet;
    PixelEdge        *edges   = malloc((layer->section->point_count + 1) * sizeof *edges);
    uint8_t          *pixels  = malloc((size_t)sheet->width * sheet->height);
    float            *row     = malloc((sheet->width + 2) * sizeof *row);
    bool              done    = edges && pixels && row;
    Picture           picture = {.width       = sheet->width,
                                 .height      = sheet->height,
                                 .crop_width  = sheet->width,
                                 .crop_height = sheet->height};
    if (done) {
        fill_rows(sheet, edges, find_edges(sheet, layer->section, edges), pixels, row);
        done = png_write_mask(&picture, pixels, sheet->per_unit / sheet->metres, file->file,
                              file->error);
    } else {
        file->error->status = KRS_OUT_OF_MEMORY;
        snprintf(file->error->message, sizeof file->error->message,
                 "not enough memory for this picture");
    }
    free(edges);
    free(pixels);
    free(row);
    return done;
}
