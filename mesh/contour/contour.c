/* contour.c: finds vertices on edges, in faces and inside of tetrahedra. */
#include "mesh/contour/contour.h"

#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/field/roots.h"
#include "mesh/contour/batches.h"
#include "mesh/contour/quadric.h"
#include "mesh/contour/snap.h"
#include "mesh/contour/weights.h"

/* Part of an edge at its ends where no vertex is, so that no vertices coincide. */
static const double END_OF_EDGE = 1e-4;
/* Part of an edge between a point that was moved to the other side and the vertex. */
static const double BESIDE_MOVED = 0.1;
/* Part of the error by which a line or a triangle may miss the surface without a further vertex. */
static const double STRAIGHT = 0.1;

/* ---- distances of points ---- */

static void box_of_points(const Contour *contour, const uint32_t *points, size_t count,
                          double low[3], double high[3])
{
    tets_position(contour->tets, points[0], low);
    memcpy(high, low, 3 * sizeof *low);
    for (size_t i = 1; i < count; i++) {
        double at[3];
        tets_position(contour->tets, points[i], at);
        for (int k = 0; k < 3; k++) {
            low[k]  = min2(low[k], at[k]);
            high[k] = max2(high[k], at[k]);
        }
    }
}

static void box_of_point(const void *user, size_t number, double low[3], double high[3])
{
    const Contour *contour = user;
    box_of_points(contour, (uint32_t[]){(uint32_t)number}, 1, low, high);
}

static void find_distances(const void *user, const MeshField *field, const uint32_t *numbers,
                           size_t count)
{
    const Contour *contour = user;
    double         positions[MAX_FIELD_POINTS][3], distances[MAX_FIELD_POINTS];
    for (size_t i = 0; i < count; i++)
        tets_position(contour->tets, numbers[i], positions[i]);
    field_distances(field, (const double(*)[3])positions, count, distances);
    for (size_t i = 0; i < count; i++)
        contour->tets->points.items[numbers[i]].distance = distances[i];
}

static void find_all(Contour *contour, const Batches *batches, size_t first, size_t end)
{
    const Tets  *tets     = contour->tets;
    BatchContext context  = {.fields = contour->fields,
                             .origin = {tets->origin[0], tets->origin[1], tets->origin[2]},
                             .side   = tets->step * CUBE_STEPS,
                             .margin = 0.01 * contour->error,
                             .groups = &contour->groups};
    contour->groups.arena = contour->arena;
    batches_find(&context, batches, contour, first, end);
}

void contour_distances(Contour *contour)
{
    static const Batches points = {box_of_point, find_distances, NULL, 1};
    find_all(contour, &points, contour->known_points, contour->tets->points.count);
    contour->known_points = contour->tets->points.count;
}

/* ---- vertices on edges ---- */

/* Returns a search for the vertex on an edge, which is done where a point was moved to the other
   side: the vertex is near to that point. */
static RootSearch root_search(const Contour *contour, const Crossing *crossing)
{
    const TetPoint *points   = contour->tets->points.items;
    bool            reversed = points[crossing->from].distance > points[crossing->to].distance;
    uint32_t        from     = reversed ? crossing->to : crossing->from,
             to              = reversed ? crossing->from : crossing->to;
    RootSearch search        = {
               .high = 1, .at_low = points[from].distance, .at_high = points[to].distance};
    tets_position(contour->tets, from, search.from);
    tets_position(contour->tets, to, search.along);
    add_scaled3(search.along, search.along, -1, search.from);
    search.length = length3(search.along);
    search.done   = (search.at_low < 0) == (search.at_high < 0);
    if (search.done)
        search.low = search.high = points[from].moved ? BESIDE_MOVED : 1 - BESIDE_MOVED;
    return search;
}

static void locate_crossings(const Contour *contour, const MeshField *field,
                             const uint32_t *numbers, size_t count)
{
    RootSearch searches[MAX_FIELD_POINTS];
    for (size_t i = 0; i < count; i++)
        searches[i] = root_search(contour, &contour->crossings.items[numbers[i]]);
    find_roots(field, searches, count, 1e-4 * contour->error);
    for (size_t i = 0; i < count; i++) {
        const RootSearch *search   = &searches[i];
        Crossing         *crossing = &contour->crossings.items[numbers[i]];
        double            part     = 0.5 * (search->low + search->high);
        part                       = min2(max2(part, END_OF_EDGE), 1 - END_OF_EDGE);
        add_scaled3(crossing->at, search->from, part, search->along);
        for (int k = 0; k < 3; k++)
            crossing->normal[k] = search->along[k] / search->length;
    }
}

/* Finds values and normals by differences; where these vanish normals stay along the edges. */
static void find_normals(const Contour *contour, const MeshField *field, const uint32_t *numbers,
                         size_t count)
{
    enum { EACH = 7, AT_ONCE = MAX_FIELD_POINTS / EACH };
    double step = 1e-3 * contour->error;
    for (size_t i = 0, now; i < count; i += now) {
        double points[AT_ONCE * EACH][3], values[AT_ONCE * EACH];
        now = count - i < AT_ONCE ? count - i : AT_ONCE;
        for (size_t k = 0; k < now * EACH; k++) {
            size_t beside = k % EACH;
            memcpy(points[k], contour->crossings.items[numbers[i + k / EACH]].at, sizeof points[k]);
            if (beside < 6)
                points[k][beside / 2] += beside % 2 ? step : -step;
        }
        field_distances(field, (const double(*)[3])points, now * EACH, values);
        for (size_t k = 0; k < now; k++) {
            const double *own       = &values[k * EACH];
            Crossing     *crossing  = &contour->crossings.items[numbers[i + k]];
            double        normal[3] = {own[1] - own[0], own[3] - own[2], own[5] - own[4]};
            crossing->value         = own[6];
            if (normalize3(normal))
                memcpy(crossing->normal, normal, sizeof normal);
        }
    }
}

static void box_of_crossing(const void *user, size_t number, double low[3], double high[3])
{
    const Contour  *contour  = user;
    const Crossing *crossing = &contour->crossings.items[number];
    box_of_points(contour, (uint32_t[]){crossing->from, crossing->to}, 2, low, high);
}

static void find_crossings(const void *user, const MeshField *field, const uint32_t *numbers,
                           size_t count)
{
    const Contour *contour = user;
    locate_crossings(contour, field, numbers, count);
    find_normals(contour, field, numbers, count);
}

/* ---- vertices in faces ---- */

/* Finds the vertex in a face: where the tangent planes at both crossings meet it, snapped to the
   surface. */
static void find_line(const Contour *contour, const MeshField *field, double missed, FaceLine *line)
{
    const Crossing *a = &contour->crossings.items[line->crossings[0]];
    const Crossing *b = &contour->crossings.items[line->crossings[1]];
    double          corners[3][3], edges[2][3], middle[3], rows[3][3];
    for (int i = 0; i < 3; i++) {
        tets_position(contour->tets, line->points[i], corners[i]);
        middle[i] = 0.5 * (a->at[i] + b->at[i]);
    }
    add_scaled3(edges[0], corners[1], -1, corners[0]);
    add_scaled3(edges[1], corners[2], -1, corners[0]);
    cross3(edges[0], edges[1], rows[2]);
    normalize3(rows[2]);
    memcpy(rows[0], a->normal, sizeof rows[0]);
    memcpy(rows[1], b->normal, sizeof rows[1]);
    double   right[3] = {dot3(rows[0], a->at), dot3(rows[1], b->at), dot3(rows[2], corners[0])};
    Snapping snapping = {(const double(*)[3])corners, 3, rows[2], middle, missed, contour->error};
    bool     meet     = solve3((const double(*)[3])rows, right, line->at);
    line->bent        = snap_nearby(field, &snapping, meet, line->at, &line->value);
    line->off         = fabs(missed);
    if (line->bent) {
        const double *ends[2] = {a->at, b->at};
        line->off             = max_off(field, line->at, ends, 2);
    }
}

static void box_of_line(const void *user, size_t number, double low[3], double high[3])
{
    const Contour *contour = user;
    box_of_points(contour, contour->lines.items[number].points, 3, low, high);
}

/* Finds vertices in faces, of which most need none. */
static void find_lines(const void *user, const MeshField *field, const uint32_t *numbers,
                       size_t count)
{
    const Contour *contour = user;
    double         middles[MAX_FIELD_POINTS][3], distances[MAX_FIELD_POINTS];
    for (size_t i = 0; i < count; i++) {
        const FaceLine *line = &contour->lines.items[numbers[i]];
        for (int k = 0; k < 3; k++)
            middles[i][k] = 0.5 * (contour->crossings.items[line->crossings[0]].at[k] +
                                   contour->crossings.items[line->crossings[1]].at[k]);
    }
    field_distances(field, (const double(*)[3])middles, count, distances);
    for (size_t i = 0; i < count; i++)
        contour->lines.items[numbers[i]].known = true;
    for (size_t i = 0; i < count; i++)
        if (fabs(distances[i]) > STRAIGHT * contour->error)
            find_line(contour, field, distances[i], &contour->lines.items[numbers[i]]);
}

static bool line_is_known(const void *user, size_t number)
{
    const Contour *contour = user;
    return contour->lines.items[number].known;
}

/* ---- vertices inside ---- */

static void find_middle(const Contour *contour, const Patch *patch, double middle[3])
{
    middle[0] = middle[1] = middle[2] = 0;
    for (uint32_t i = 0; i < patch->corner_count; i++)
        add_scaled3(middle, middle, 1.0 / patch->corner_count,
                    contour->crossings.items[patch->crossings[i]].at);
}

/* Returns the largest distance from the surface at the vertex inside and in the middles between it
   and those around it. */
static double off_of_fan(const Contour *contour, const MeshField *field, const Patch *patch)
{
    const double *around[8];
    size_t        count = 0;
    for (uint32_t i = 0; i < patch->corner_count; i++) {
        const FaceLine *line = &contour->lines.items[patch->lines[i]];
        around[count++]      = contour->crossings.items[patch->crossings[i]].at;
        if (line->bent)
            around[count++] = line->at;
    }
    return max2(fabs(patch->value), max_off(field, patch->apex, around, count));
}

/* Finds the vertex inside; `missed` is the distance at the middle of the crossings. */
static void find_apex(const Contour *contour, const MeshField *field, const double middle[3],
                      double missed, Patch *patch)
{
    double corners[4][3], points[4][3], normals[4][3];
    for (uint32_t i = 0; i < patch->corner_count; i++) {
        const Crossing *crossing = &contour->crossings.items[patch->crossings[i]];
        memcpy(points[i], crossing->at, sizeof points[i]);
        memcpy(normals[i], crossing->normal, sizeof normals[i]);
    }
    tets_corners(contour->tets, &contour->tets->list.items[patch->tet], corners);
    quadric_point((const double(*)[3])points, (const double(*)[3])normals, patch->corner_count,
                  patch->apex);
    Snapping snapping = {(const double(*)[3])corners, 4, NULL, middle, missed, contour->error};
    if (snap_nearby(field, &snapping, true, patch->apex, &patch->value)) {
        patch->fan = true;
    } else {
        memcpy(patch->apex, middle, 3 * sizeof *middle);
        patch->value = missed;
    }
    patch->off = patch->fan ? off_of_fan(contour, field, patch) : fabs(missed);
}

static void box_of_patch(const void *user, size_t number, double low[3], double high[3])
{
    const Contour *contour = user;
    const Tet     *tet     = &contour->tets->list.items[contour->patches.items[number].tet];
    box_of_points(contour, tet->points, 4, low, high);
}

static void find_apexes(const void *user, const MeshField *field, const uint32_t *numbers,
                        size_t count)
{
    const Contour *contour = user;
    double         middles[MAX_FIELD_POINTS][3], distances[MAX_FIELD_POINTS];
    for (size_t i = 0; i < count; i++)
        find_middle(contour, &contour->patches.items[numbers[i]], middles[i]);
    field_distances(field, (const double(*)[3])middles, count, distances);
    for (size_t i = 0; i < count; i++) {
        Patch *patch = &contour->patches.items[numbers[i]];
        patch->fan   = false;
        for (uint32_t k = 0; k < patch->corner_count; k++)
            patch->fan = patch->fan || contour->lines.items[patch->lines[k]].bent;
        if (patch->fan || fabs(distances[i]) > STRAIGHT * contour->error)
            find_apex(contour, field, middles[i], distances[i], patch);
    }
}

/* ---- patches ---- */

static uint32_t take_crossing(Contour *contour, uint32_t inside, uint32_t outside)
{
    uint32_t fresh  = (uint32_t)contour->crossings.count;
    uint32_t number = numbering_take(&contour->crossing_numbers, edge_key(inside, outside), fresh);
    if (number == fresh) {
        Crossing crossing = {.from = inside, .to = outside};
        array_push_large(contour->arena, &contour->crossings, crossing);
    }
    return number;
}

static bool has_crossings(const FaceLine *line, uint32_t first, uint32_t second)
{
    return (line->crossings[0] == first && line->crossings[1] == second) ||
           (line->crossings[0] == second && line->crossings[1] == first);
}

/* Returns the line between two crossings on one face, which is found anew if a point was moved to
   the other side. */
static uint32_t take_line(Contour *contour, uint32_t first, uint32_t second)
{
    const Crossing *a = &contour->crossings.items[first], *b = &contour->crossings.items[second];
    uint32_t        third  = b->from == a->from || b->from == a->to ? b->to : b->from;
    uint32_t        fresh  = (uint32_t)contour->lines.count;
    uint32_t        number = numbering_take(&contour->line_numbers, face_key(a->from, a->to, third),
                                            fresh);
    FaceLine        line   = {.points = {a->from, a->to, third}, .crossings = {first, second}};
    if (number == fresh)
        array_push_large(contour->arena, &contour->lines, line);
    else if (!has_crossings(&contour->lines.items[number], first, second)) {
        contour->lines.items[number] = line;
        contour->known_lines = contour->known_lines < number ? contour->known_lines : number;
    }
    return number;
}

/* Tells whether points 1 to 3 are in the positive order, seen from point 0. */
static bool is_positive(const Tets *tets, const uint32_t points[4])
{
    double edges[3][3], cross[3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            edges[i][k] = (double)tets->points.items[points[i + 1]].at[k] -
                          (double)tets->points.items[points[0]].at[k];
    cross3(edges[1], edges[2], cross);
    return dot3(edges[0], cross) > 0;
}

static void reverse(uint32_t *numbers, uint32_t count)
{
    for (uint32_t i = 0; i < count / 2; i++) {
        uint32_t swap          = numbers[i];
        numbers[i]             = numbers[count - 1 - i];
        numbers[count - 1 - i] = swap;
    }
}

/* Lists the points of a tetrahedron, those inside first; returns how many are inside. */
static uint32_t inside_first(const Tets *tets, const Tet *tet, uint32_t points[4])
{
    uint32_t count = 0, end = 4;
    for (int i = 0; i < 4; i++)
        if (point_is_inside(tets, tet->points[i]))
            points[count++] = tet->points[i];
    for (int i = 3; i >= 0; i--)
        if (!point_is_inside(tets, tet->points[i]))
            points[--end] = tet->points[i];
    return count;
}

static void add_patch(Contour *contour, uint32_t number, const uint32_t points[4], uint32_t inside)
{
    static const int around[4][2] = {{0, 2}, {0, 3}, {1, 3}, {1, 2}};
    Patch            patch        = {.tet = number, .corner_count = inside == 2 ? 4 : 3};
    for (uint32_t i = 0; i < patch.corner_count; i++) {
        uint32_t from = inside == 1 ? points[0] : inside == 3 ? points[i] : points[around[i][0]];
        uint32_t to = inside == 1 ? points[i + 1] : inside == 3 ? points[3] : points[around[i][1]];
        patch.crossings[i] = take_crossing(contour, from, to);
    }
    if (!is_positive(contour->tets, points))
        reverse(patch.crossings, patch.corner_count);
    for (uint32_t i = 0; i < patch.corner_count; i++)
        patch.lines[i] = take_line(contour, patch.crossings[i],
                                   patch.crossings[(i + 1) % patch.corner_count]);
    array_push_large(contour->arena, &contour->patches, patch);
}

/* Returns how many triangles fill a patch. */
static uint8_t triangles_of(const Contour *contour, const Patch *patch)
{
    uint32_t count = patch->fan ? patch->corner_count : patch->corner_count - 2;
    for (uint32_t i = 0; i < patch->corner_count; i++)
        count += contour->lines.items[patch->lines[i]].bent;
    return (uint8_t)count;
}

static void find_patches(Contour *contour, size_t first)
{
    static const Batches crossings = {box_of_crossing, find_crossings, NULL, 12};
    static const Batches lines     = {box_of_line, find_lines, line_is_known, 1};
    static const Batches patches   = {box_of_patch, find_apexes, NULL, 1};
    find_all(contour, &crossings, contour->known_crossings, contour->crossings.count);
    contour->known_crossings = contour->crossings.count;
    find_all(contour, &lines, contour->known_lines, contour->lines.count);
    contour->known_lines = contour->lines.count;
    find_all(contour, &patches, first, contour->patches.count);
}

void contour_find_patches(Contour *contour)
{
    const Tets *tets  = contour->tets;
    size_t      first = contour->patches.count;
    for (size_t i = 0; i < tets->fresh.count; i++) {
        uint32_t   number = tets->fresh.items[i], points[4];
        const Tet *tet    = &tets->list.items[number];
        uint32_t   inside = inside_first(tets, tet, points);
        if (tet->triangle_count == 0 && inside > 0 && inside < 4)
            add_patch(contour, number, points, inside);
    }
    find_patches(contour, first);
    for (size_t i = first; i < contour->patches.count; i++) {
        Patch *patch        = &contour->patches.items[i];
        Tet   *tet          = &tets->list.items[patch->tet];
        tet->patch          = (uint32_t)i;
        tet->triangle_count = triangles_of(contour, patch);
    }
}

uint32_t patch_diagonal(const Contour *contour, const Patch *patch)
{
    const double *at[4];
    if (patch->corner_count < 4)
        return 0;
    for (int i = 0; i < 4; i++)
        at[i] = contour->crossings.items[patch->crossings[i]].at;
    return distance3(at[1], at[3]) < distance3(at[0], at[2]);
}

double patch_off(const Contour *contour, const Patch *patch)
{
    double most = patch->off;
    for (uint32_t i = 0; i < patch->corner_count; i++)
        most = max2(most, contour->lines.items[patch->lines[i]].off);
    return most;
}
