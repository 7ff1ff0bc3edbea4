/* files.c: SVG, DXF and the Common Layer Interface; PNG by picture.c. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "cli/slice/slicing.h"

/* ---- bytes ---- */

bool slice_file_flush(SliceFile *file)
{
    bool written = output_append(file->file, file->buffer, file->length);
    file->length = 0;
    return written;
}

__attribute__((format(printf, 2, 3))) static bool add(SliceFile *file, const char *format, ...)
{
    enum { LONGEST = 512 };
    va_list arguments;
    if (sizeof file->buffer - file->length < LONGEST && !slice_file_flush(file))
        return false;
    va_start(arguments, format);
    file->length += (size_t)vsnprintf(file->buffer + file->length, LONGEST, format, arguments);
    va_end(arguments);
    return true;
}

/* Adds a number without an exponent, which some readers do not know, and without -0. */
static bool add_number(SliceFile *file, const char *before, double number)
{
    double least = 0.5 * pow(10, -file->sheet->digits);
    return add(file, "%s%.*f", before, file->sheet->digits, fabs(number) < least ? 0 : number);
}

static bool nothing(SliceFile *file)
{
    (void)file;
    return true;
}

/* ---- SVG ---- */

/* Adds a point of SVG, in which y goes downwards. */
static bool add_svg_point(SliceFile *file, const char *before, const double at[2])
{
    return add_number(file, before, at[0]) && add_number(file, " ", -at[1]);
}

/* Returns the radius of an arc between two points. */
static double arc_radius(const double from[2], const double to[2], double bulge)
{
    return 0.25 * hypot(to[0] - from[0], to[1] - from[1]) * (1 + bulge * bulge) / fabs(bulge);
}

static bool add_svg_piece(SliceFile *file, const double from[2], const double to[2], double bulge)
{
    if (bulge == 0)
        return add_svg_point(file, " L", to);
    double radius = arc_radius(from, to, bulge);
    return add_number(file, " A", radius) && add_number(file, " ", radius) &&
           add(file, " 0 %d %d", fabs(bulge) > 1, bulge < 0) && add_svg_point(file, " ", to);
}

static bool begin_svg(SliceFile *file)
{
    const SliceSheet *sheet = file->sheet;
    double            wide = sheet->high[0] - sheet->low[0], tall = sheet->high[1] - sheet->low[1];
    bool              feet = strcmp(sheet->unit, "mm") != 0 && strcmp(sheet->unit, "cm") != 0 &&
                strcmp(sheet->unit, "in") != 0;
    /* SVG knows neither metres nor feet. */
    double scale = feet ? 1000 * sheet->metres : 1;
    return add(file, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                     "<svg xmlns=\"http://www.w3.org/2000/svg\"\n"
                     "     xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"") &&
           add(file, "\n     width=\"%.9g%s\" height=\"%.9g%s\"", scale * wide,
               feet ? "mm" : sheet->unit, scale * tall, feet ? "mm" : sheet->unit) &&
           add_number(file, " viewBox=\"", sheet->low[0]) &&
           add_number(file, " ", -sheet->high[1]) && add_number(file, " ", wide) &&
           add_number(file, " ", tall) && add(file, "\">\n");
}

static bool add_svg(SliceFile *file, const Layer *layer)
{
    const KrsSection *section = layer->section;
    if (!add(file, "<g id=\"layer-%u\" inkscape:groupmode=\"layer\" inkscape:label=\"",
             layer->number) ||
        !add_number(file, "", layer->at) ||
        !add(file, "\" fill=\"black\" fill-rule=\"evenodd\" stroke=\"none\">\n"))
        return false;
    if (section->contour_count > 0 && !add(file, "<path d=\""))
        return false;
    for (size_t c = 0; c < section->contour_count; c++) {
        const KrsContour *contour = &section->contours[c];
        const double(*points)[2]  = (const double(*)[2])section->points + contour->first;
        if (!add_svg_point(file, c ? "\nM" : "M", points[0]))
            return false;
        for (size_t i = 0; i < contour->count; i++) {
            double bulge = section->bulges ? section->bulges[contour->first + i] : 0;
            size_t to    = (i + 1) % contour->count;
            if ((to > 0 || bulge != 0) && !add_svg_piece(file, points[i], points[to], bulge))
                return false;
        }
        if (!add(file, " Z"))
            return false;
    }
    return (section->contour_count == 0 || add(file, "\"/>\n")) && add(file, "</g>\n");
}

static bool end_svg(SliceFile *file) { return add(file, "</svg>\n"); }

/* ---- DXF ---- */

/* Begins a file of release 12, which all programs read: lines of a code and its value. */
static bool begin_dxf(SliceFile *file)
{
    static const struct {
        const char *unit;
        int         code;
    } units[] = {{"in", 1}, {"ft", 2}, {"mm", 4}, {"cm", 5}, {"m", 6}, {"um", 13}};
    int code  = 0;
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (strcmp(units[i].unit, file->sheet->unit) == 0)
            code = units[i].code;
    const SliceSheet *sheet = file->sheet;
    return add(file, "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n9\n$INSUNITS\n70\n%d\n",
               code) &&
           add_number(file, "9\n$EXTMIN\n10\n", sheet->low[0]) &&
           add_number(file, "\n20\n", sheet->low[1]) &&
           add_number(file, "\n9\n$EXTMAX\n10\n", sheet->high[0]) &&
           add_number(file, "\n20\n", sheet->high[1]) &&
           add(file, "\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n");
}

static bool add_dxf_contour(SliceFile *file, const Layer *layer, const KrsContour *contour)
{
    const KrsSection *section = layer->section;
    double            height  = file->sheet->stacked ? layer->at : 0;
    if (!add(file, "0\nPOLYLINE\n8\nlayer-%u\n66\n1\n10\n0\n20\n0\n", layer->number) ||
        !add_number(file, "30\n", height) || !add(file, "\n70\n1\n"))
        return false;
    for (size_t i = contour->first; i < contour->first + contour->count; i++) {
        double bulge = section->bulges ? section->bulges[i] : 0;
        if (!add(file, "0\nVERTEX\n8\nlayer-%u\n", layer->number) ||
            !add_number(file, "10\n", section->points[i][0]) ||
            !add_number(file, "\n20\n", section->points[i][1]) ||
            !add_number(file, "\n30\n", height) ||
            (bulge != 0 && !add(file, "\n42\n%.12f", bulge)) || !add(file, "\n"))
            return false;
    }
    return add(file, "0\nSEQEND\n8\nlayer-%u\n", layer->number);
}

static bool add_dxf(SliceFile *file, const Layer *layer)
{
    for (size_t c = 0; c < layer->section->contour_count; c++)
        if (!add_dxf_contour(file, layer, &layer->section->contours[c]))
            return false;
    return true;
}

static bool end_dxf(SliceFile *file) { return add(file, "0\nENDSEC\n0\nEOF\n"); }

/* ---- Common Layer Interface ---- */

/* Begins a file of version 2.0, in ASCII.  Layers are named by their upper side, and the one before
   the first by the lower side of that. */
static bool begin_cli(SliceFile *file)
{
    const SliceSheet *sheet      = file->sheet;
    const double      numbers[6] = {sheet->low[0],  sheet->low[1],  sheet->bottom,
                                    sheet->high[0], sheet->high[1], sheet->top};
    if (!add(file,
             "$$HEADERSTART\n$$ASCII\n$$UNITS/%.9f\n$$VERSION/200\n$$LABEL/1,krs\n$$DIMENSION/",
             1000 * sheet->metres))
        return false;
    for (int i = 0; i < 6; i++)
        if (!add_number(file, i ? "," : "", numbers[i]))
            return false;
    return add(file, "\n$$LAYERS/%06u\n$$HEADEREND\n$$GEOMETRYSTART\n", sheet->layer_count + 1) &&
           add_number(file, "$$LAYER/", sheet->bottom) && add(file, "\n");
}

/* A polyline ends with its first point; 1 is counter-clockwise, 0 clockwise. */
static bool add_cli(SliceFile *file, const Layer *layer)
{
    const KrsSection *section = layer->section;
    if (!add_number(file, "$$LAYER/", layer->high) || !add(file, "\n"))
        return false;
    for (size_t c = 0; c < section->contour_count; c++) {
        const KrsContour *contour = &section->contours[c];
        if (!add(file, "$$POLYLINE/1,%d,%zu", contour->area > 0, contour->count + 1))
            return false;
        for (size_t i = 0; i <= contour->count; i++) {
            const double *at = section->points[contour->first + i % contour->count];
            if (!add_number(file, ",", at[0]) || !add_number(file, ",", at[1]))
                return false;
        }
        if (!add(file, "\n"))
            return false;
    }
    return true;
}

static bool end_cli(SliceFile *file) { return add(file, "$$GEOMETRYEND\n"); }

/* ---- all formats ---- */

static const SliceFormat formats[] = {{".svg", true, true, begin_svg, add_svg, end_svg},
                                      {".dxf", true, true, begin_dxf, add_dxf, end_dxf},
                                      {".cli", true, false, begin_cli, add_cli, end_cli},
                                      {".png", false, false, nothing, slice_add_picture, nothing}};

const SliceFormat *slice_format(const char *path)
{
    const char *dot = strrchr(path, '.');
    if (strcmp(path, STANDARD_OUTPUT) == 0)
        return &formats[0];
    for (size_t i = 0; dot && i < sizeof formats / sizeof *formats; i++)
        if (strcasecmp(dot, formats[i].ending) == 0)
            return &formats[i];
    return NULL;
}
