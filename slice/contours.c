/* contours.c: follows the contours of a section from chord to chord. */
#include "slice/section.h"

#include <stdlib.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/minmax.h"

/* The parts of the error for dropped points, and for arcs; chords have the rest. */
static const double PART_OF_POINTS = 0.5, PART_OF_ARCS = 0.002;

typedef struct Result {
    OutlinePoint *points, *copy; /* of the present contour; a copy, which is simplified */
    double       *bulges;
    KrsSection   *section;
} Result;

/* Lists the points from a crossing on until it comes again; returns 0 if chords do not lead
   back. */
static size_t follow(const Section *s, uint32_t start, bool *seen, OutlinePoint *points)
{
    size_t   count = 0;
    uint32_t at    = start;
    do {
        const Crossing *crossing = &s->crossings.items[at];
        if (seen[at] || crossing->chord == 0)
            return 0;
        const Chord *chord = &s->chords.items[crossing->chord - 1];
        seen[at]           = true;
        points[count++]    = (OutlinePoint){{crossing->point[0], crossing->point[1]},
                                            crossing->corner};
        memcpy(points + count, s->bends.items + chord->first, chord->count * sizeof *points);
        count += chord->count;
        at = chord->to;
    } while (at != start);
    return count;
}

/* Returns the area; points are taken from the first one, since far from the origin digits would be
   lost. */
static double area_of(const OutlinePoint *points, const double *bulges, size_t count)
{
    double area = 0;
    for (size_t i = 0; i < count; i++) {
        const double *a = points[i].at, *b = points[(i + 1) % count].at, *o = points[0].at;
        area += 0.5 * ((a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]));
        if (bulges && bulges[i] != 0) {
            double chord = real_hypot(b[0] - a[0], b[1] - a[1]), angle = 4 * real_atan(bulges[i]);
            double radius = chord / (2 * real_sin(0.5 * angle));
            area += 0.5 * radius * radius * (angle - real_sin(angle));
        }
    }
    return area;
}

/* Returns the width of a strip with the area and the length of a contour. */
static double width_of(const OutlinePoint *points, size_t count)
{
    double length = 0;
    for (size_t i = 0; i < count; i++) {
        const double *a = points[i].at, *b = points[(i + 1) % count].at;
        length += real_hypot(b[0] - a[0], b[1] - a[1]);
    }
    return length > 0 ? 2 * fabs(area_of(points, NULL, count)) / length : 0;
}

/* Tells whether nothing is left of a contour when points are dropped. */
static bool vanishes(Section *s, const OutlinePoint *points, size_t count)
{
    ArenaMark     before = arena_mark(&s->arena);
    OutlinePoint *copy   = arena_new_array(&s->arena, OutlinePoint, count + 1);
    memcpy(copy, points, count * sizeof *copy);
    bool gone = leave_out_points(copy, count, PART_OF_POINTS * s->error, &s->arena) < 3;
    arena_rewind(&s->arena, before);
    return gone;
}

/* Tells whether a contour comes of rounding, where nothing thin was found, or of something thinner
   than is searched for, which is counted. */
static bool is_noise(Section *s, const OutlinePoint *points, size_t count, double width)
{
    static const double LEAST = 1e-3;
    double              thin  = s->side * ((double)s->thinnest / WHOLE_SIDE);
    if (!s->split_thin)
        return vanishes(s, points, count);
    if (width >= 0.25 * thin)
        return false;
    if (width > LEAST * thin && s->lost++ == 0)
        memcpy(s->lost_at, points[0].at, sizeof s->lost_at);
    return true;
}

/* Adds the present points, of which few stay, to a section of lines, or of arcs as well. */
static void add_points(Section *s, const Result *result, size_t count, double error, bool arcs,
                       KrsSection *section)
{
    OutlinePoint *points  = result->copy;
    KrsContour    contour = {.first = section->point_count};
    memcpy(points, result->points, count * sizeof *points);
    contour.count = arcs ? fit_arcs(points, result->bulges, count, PART_OF_ARCS * error, &s->arena)
                         : leave_out_points(points, count, PART_OF_POINTS * error, &s->arena);
    contour.area  = area_of(points, arcs ? result->bulges : NULL, contour.count);
    if (contour.count < (arcs ? 2 : 3) || contour.area == 0)
        return;
    for (size_t i = 0; i < contour.count; i++) {
        memcpy(section->points[contour.first + i], points[i].at, sizeof *section->points);
        if (arcs)
            section->bulges[contour.first + i] = result->bulges[i];
    }
    section->point_count += contour.count;
    section->contours[section->contour_count++] = contour;
}

static void add_contour(Section *s, const Result *result, size_t count)
{
    double width = width_of(result->points, count), error = min2(s->error, 0.5 * width);
    if (is_noise(s, result->points, count, width))
        return;
    add_points(s, result, count, error, s->arcs, result->section);
    if (result->section->lines)
        add_points(s, result, count, error, false, result->section->lines);
}

/* Makes a section with room for all points, of which few stay. */
static KrsSection *section_new(size_t points, size_t contours, bool arcs, bool lines)
{
    KrsSection *section = calloc(1, sizeof *section);
    if (!section)
        return NULL;
    section->points   = malloc((points + 1) * sizeof *section->points);
    section->bulges   = arcs ? malloc((points + 1) * sizeof *section->bulges) : NULL;
    section->contours = malloc((contours + 1) * sizeof *section->contours);
    section->lines    = lines ? section_new(points, contours, false, false) : NULL;
    if (section->points && section->contours && (section->bulges || !arcs) &&
        (section->lines || !lines))
        return section;
    krs_section_free(section);
    return NULL;
}

static void *shrunk(void *items, size_t count, size_t size)
{
    void *less = realloc(items, (count + 1) * size);
    return less ? less : items;
}

static void shrink_section(KrsSection *section)
{
    section->points   = shrunk(section->points, section->point_count, sizeof *section->points);
    section->contours = shrunk(section->contours, section->contour_count,
                               sizeof *section->contours);
    if (section->bulges)
        section->bulges = shrunk(section->bulges, section->point_count, sizeof *section->bulges);
    if (section->lines)
        shrink_section(section->lines);
}

bool section_contours(Section *s, KrsSection **section)
{
    size_t room = s->crossings.count + s->bends.count;
    *section    = section_new(room, s->crossings.count, s->arcs, s->lines);
    if (!*section)
        return false;
    Result    result = {.section = *section};
    bool     *seen   = arena_new_array(&s->arena, bool, s->crossings.count + 1);
    ArenaMark before = arena_mark(&s->arena);
    result.points    = arena_new_array(&s->arena, OutlinePoint, room + 1);
    result.copy      = arena_new_array(&s->arena, OutlinePoint, room + 1);
    result.bulges    = arena_new_array(&s->arena, double, room + 1);
    for (uint32_t i = 0; i < s->crossings.count; i++) {
        size_t count = seen[i] ? 0 : follow(s, i, seen, result.points);
        if (count > 0)
            add_contour(s, &result, count);
    }
    arena_rewind(&s->arena, before);
    result.section->lost     = s->lost;
    result.section->thinnest = s->side * ((double)s->thinnest / WHOLE_SIDE);
    slice_point(&s->plane, s->lost_at, result.section->lost_at);
    shrink_section(result.section);
    return true;
}

void krs_section_free(KrsSection *section)
{
    if (!section)
        return;
    krs_section_free(section->lines);
    free(section->points);
    free(section->bulges);
    free(section->contours);
    free(section);
}
