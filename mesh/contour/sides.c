/* sides.c: points around a place, and which are inside. */
#include "mesh/contour/sides.h"

#include <stdlib.h>

#include "compiler/base/vec.h"

/* Tetrahedra that have a point that may be moved. */
enum { MAX_AROUND = 200 };
/* The sphere around a point may have so many parts that one joins. */
enum { MAX_PARTS = 16 };

/* The points around a point, by their number in the place, and the edges of the sphere that they are on: where those begin. */
typedef struct Link {
    uint32_t point, first_point, first_edge, point_count, edge_count;
    double   distance;
} Link;

typedef struct Place {
    Tets  *tets;
    Arena *arena;
    struct {
        Link *
            items; /* of those that may be moved, the deepest first; all others of the place are behind them */
        size_t count, capacity;
    } links;
    struct {
        uint32_t *items;
        size_t    count, capacity;
    } points, around;
    struct {
        uint32_t (*items)[2];
        size_t count, capacity;
    } edges;
    Numbering numbers;
    bool     *inside, *before;
    uint32_t  parts[2]; /* before, outside and inside */
} Place;

/* Edges of the longest tetrahedra that a point is moved in, by the radius: where they are longer the mesh would be far off.  What is left out as a
   whole leaves no mesh. */
static const double FINE = 0.5;

/* ---- what is there ---- */

static uint32_t number_of(Place *place, uint32_t point)
{
    uint32_t fresh  = (uint32_t)place->points.count;
    uint32_t number = numbering_take(&place->numbers, (NumberKey){point, 1}, fresh);
    if (number == fresh)
        array_push(place->arena, &place->points, point);
    return number;
}

/* Tells whether no tetrahedron that has a point is longer than that, and not many have it. */
static bool is_fine(const Tets *tets, uint32_t point, double longest)
{
    int count = 0;
    for (uint32_t at = tets->points.items[point].first; at; at = tets->links.items[at - 1].next)
        if (++count > MAX_AROUND ||
            tets_longest_edge(tets, &tets->list.items[tets->links.items[at - 1].tet]) > longest)
            return false;
    return true;
}

static int deepest_first(const void *a, const void *b)
{
    const Link *first = a, *second = b;
    return first->distance != second->distance
               ? (first->distance > second->distance) - (first->distance < second->distance)
               : (first->point > second->point) - (first->point < second->point);
}

static void find_free(Place *place, const double center[3], double radius, double deep)
{
    for (uint32_t i = 0; i < place->tets->points.count; i++) {
        double at[3], distance = place->tets->points.items[i].distance;
        tets_position(place->tets, i, at);
        if (fabs(distance) <= deep && distance3(at, center) <= radius &&
            is_fine(place->tets, i, FINE * radius)) {
            Link link = {.point = i, .distance = distance};
            array_push(place->arena, &place->links, link);
        }
    }
    if (place->links.count > 0)
        qsort(place->links.items, place->links.count, sizeof *place->links.items, deepest_first);
    for (size_t i = 0; i < place->links.count; i++)
        number_of(place, place->links.items[i].point);
}

/* The faces across from a point make a sphere. */
static void find_link(Place *place, Link *link)
{
    const Tets *tets  = place->tets;
    link->first_point = (uint32_t)place->around.count;
    link->first_edge  = (uint32_t)place->edges.count;
    for (uint32_t at = tets->points.items[link->point].first; at;
         at          = tets->links.items[at - 1].next) {
        const uint32_t *points = tets->list.items[tets->links.items[at - 1].tet].points;
        uint32_t        across[3], count = 0;
        for (int k = 0; k < 4; k++)
            if (points[k] != link->point)
                across[count++] = number_of(place, points[k]);
        for (int k = 0; k < 3; k++) {
            array_reserve_large(place->arena, &place->edges);
            uint32_t *edge = place->edges.items[place->edges.count++];
            edge[0]        = across[k];
            edge[1]        = across[(k + 1) % 3];
            uint32_t i     = link->first_point;
            while (i < place->around.count && place->around.items[i] != across[k])
                i++;
            if (i == place->around.count)
                array_push(place->arena, &place->around, across[k]);
        }
    }
    link->point_count = (uint32_t)place->around.count - link->first_point;
    link->edge_count  = (uint32_t)place->edges.count - link->first_edge;
}

/* ---- shapes ---- */

static uint32_t leader_of(uint32_t *leaders, uint32_t number)
{
    while (leaders[number] != number) {
        leaders[number] = leaders[leaders[number]];
        number          = leaders[number];
    }
    return number;
}

/* Joins what hangs together on the same side: so there are fewer parts. */
static void join(const Place *place, const Link *link, uint32_t *leaders, uint32_t parts[2])
{
    for (uint32_t i = link->first_edge; i < link->first_edge + link->edge_count; i++) {
        uint32_t a = place->edges.items[i][0], b = place->edges.items[i][1];
        if (place->inside[a] != place->inside[b])
            continue;
        uint32_t first = leader_of(leaders, a), second = leader_of(leaders, b);
        parts[place->inside[a]] -= first != second;
        leaders[first] = second;
    }
}

/* How many parts of the sphere around a point are outside, and how many inside. */
static void count_around(const Place *place, const Link *link, uint32_t *leaders, uint32_t parts[2])
{
    parts[0] = parts[1] = 0;
    for (uint32_t i = link->first_point; i < link->first_point + link->point_count; i++) {
        uint32_t number = place->around.items[i];
        leaders[number] = number;
        parts[place->inside[number]]++;
    }
    join(place, link, leaders, parts);
}

/* Counts the parts of all of the place. */
static void count_parts(const Place *place, uint32_t *leaders, uint32_t parts[2])
{
    parts[0] = parts[1] = 0;
    for (uint32_t i = 0; i < place->points.count; i++) {
        leaders[i] = i;
        parts[place->inside[i]]++;
    }
    for (size_t i = 0; i < place->links.count; i++) {
        const Link *link = &place->links.items[i];
        join(place, link, leaders, parts);
        for (uint32_t k = link->first_point; k < link->first_point + link->point_count; k++) {
            uint32_t other = place->around.items[k];
            uint32_t first = leader_of(leaders, (uint32_t)i), second = leader_of(leaders, other);
            if (place->inside[i] != place->inside[other] || first == second)
                continue;
            leaders[first] = second;
            parts[place->inside[i]]--;
        }
    }
}

/* How much the Euler number of what is inside grows if a point becomes inside: by that of a cone over what is inside around it. */
static long euler_of_cone(const uint32_t parts[2])
{
    if (parts[0] == 0)
        return -1;
    return parts[1] == 0 ? 1 : (long)parts[0] - (long)parts[1];
}

/* ---- to one side and back ---- */

/* Tells whether a point would join nothing that already hangs together if it were on that side; `other`: parts of
   the other side that are around it. */
static bool may_go(const Place *place, const Link *link, bool inside, uint32_t *leaders,
                   uint32_t *wholes, uint32_t *other)
{
    uint32_t parts[2], whole[MAX_PARTS], count = 0;
    count_around(place, link, leaders, parts);
    *other = parts[!inside];
    if (parts[inside] == 0 || parts[inside] > MAX_PARTS || parts[!inside] == 0)
        return false;
    for (uint32_t i = link->first_point; i < link->first_point + link->point_count; i++) {
        uint32_t number = place->around.items[i];
        if (place->inside[number] != inside || leaders[number] != number)
            continue;
        whole[count] = leader_of(wholes, number);
        for (uint32_t k = 0; k < count; k++)
            if (whole[k] == whole[count])
                return false;
        count++;
    }
    return true;
}

/* Returns how much the Euler number of what is inside grows. */
static long go(Place *place, uint32_t number, bool inside, uint32_t *leaders, uint32_t *wholes)
{
    const Link *link = &place->links.items[number];
    uint32_t    parts[2];
    count_around(place, link, leaders, parts);
    place->inside[number] = inside;
    wholes[number]        = number;
    for (uint32_t i = link->first_point; i < link->first_point + link->point_count; i++)
        if (place->inside[place->around.items[i]] == inside)
            wholes[leader_of(wholes, place->around.items[i])] = leader_of(wholes, number);
    return inside ? euler_of_cone(parts) : -euler_of_cone(parts);
}

/* A point that closes a hole is the last one of what is thin: what it divides was so before. */
static long close_hole(Place *place, uint32_t number, bool inside, uint32_t *leaders,
                       uint32_t *wholes)
{
    uint32_t parts[2];
    long     euler = go(place, number, inside, leaders, wholes);
    count_parts(place, wholes, parts);
    if (parts[!inside] <= place->parts[!inside])
        return euler;
    place->inside[number] = !inside;
    count_parts(place, wholes, parts);
    return 0;
}

/* Moves all to one side, and those back that were on the other, as long as no handle appears.  Returns how much the
   Euler number of what is inside grows. */
static long sweep(Place *place, bool inside, uint32_t *leaders, uint32_t *wholes)
{
    uint32_t parts[2], other, count = (uint32_t)place->links.count;
    long     euler = 0;
    for (uint32_t i = 0; i < count; i++)
        if (place->inside[i] != inside)
            euler += go(place, i, inside, leaders, wholes);
    count_parts(place, wholes, parts);
    for (bool any = true, closing = false; any || !closing;) {
        closing = !any;
        any     = false;
        for (uint32_t k = 0; k < count; k++) {
            uint32_t i = inside ? count - 1 - k : k;
            if (place->before[i] == inside || place->inside[i] != inside ||
                !may_go(place, &place->links.items[i], !inside, leaders, wholes, &other) ||
                (other > 1 && !closing))
                continue;
            euler += other > 1 ? close_hole(place, i, !inside, leaders, wholes)
                               : go(place, i, !inside, leaders, wholes);
            any = any || place->inside[i] != inside;
        }
    }
    return euler;
}

/* How many handles and parts there are fewer; 0 if there are more of anything, or others hang together. */
static long gain_of(Place *place, bool inside, uint32_t *leaders, uint32_t *wholes)
{
    uint32_t after[2], *before = place->parts;
    for (size_t i = 0; i < place->points.count; i++)
        place->inside[i] = place->before[i];
    count_parts(place, leaders, before);
    long euler = sweep(place, inside, leaders, wholes);
    count_parts(place, leaders, after);
    long parts = (long)before[!inside] - (long)after[!inside], handles = euler + parts;
    return before[inside] == after[inside] && parts >= 0 && handles >= 0 ? handles + parts : 0;
}

/* Returns how many points are moved. */
static size_t tidy(Place *place, uint32_t *moved, size_t most)
{
    uint32_t *leaders = arena_new_array(place->arena, uint32_t, place->points.count + 1);
    uint32_t *wholes  = arena_new_array(place->arena, uint32_t, place->points.count + 1);
    size_t    count   = 0;
    place->inside     = arena_new_array(place->arena, bool, place->points.count + 1);
    place->before     = arena_new_array(place->arena, bool, place->points.count + 1);
    for (size_t i = 0; i < place->points.count; i++)
        place->before[i] = point_is_inside(place->tets, place->points.items[i]);
    long cut    = gain_of(place, false, leaders, wholes),
         filled = gain_of(place, true, leaders, wholes);
    if (cut <= 0 && filled <= 0)
        return 0;
    if (cut >= filled)
        gain_of(place, false, leaders, wholes);
    for (size_t i = 0; i < place->links.count; i++)
        if (place->inside[i] != place->before[i]) {
            if (count < most)
                moved[count] = place->links.items[i].point;
            count++;
        }
    return count <= most ? count : 0;
}

/* ---- crumbs ---- */

enum { MAX_OF_CRUMB = 64 };

/* Adds the points of a tetrahedron that are inside.  Returns false if one is no part of a crumb, or there is no room. */
static bool add_neighbors(const Tets *tets, uint32_t tet, const bool *large,
                          uint32_t crumb[MAX_OF_CRUMB], size_t *count)
{
    for (int k = 0; k < 4; k++) {
        const uint32_t other = tets->list.items[tet].points[k];
        size_t         known = 0;
        if (!point_is_inside(tets, other))
            continue;
        while (known < *count && crumb[known] != other)
            known++;
        if (known < *count)
            continue;
        if (*count == MAX_OF_CRUMB || large[other])
            return false;
        crumb[(*count)++] = other;
    }
    return true;
}

/* Finds all points that are inside and hang together with one.  Returns how many; 0: they are no crumb, since there are too many,
   or some are far or deep.  `large` are points of what is no crumb: those that were found are noted. */
static size_t find_crumb(const Tets *tets, uint32_t point, const double center[3], double radius,
                         double deep, bool *large, uint32_t crumb[MAX_OF_CRUMB])
{
    size_t count = 1;
    bool   small = true;
    crumb[0]     = point;
    for (size_t i = 0; i < count && small; i++) {
        double at[3];
        tets_position(tets, crumb[i], at);
        small = fabs(tets->points.items[crumb[i]].distance) <= deep &&
                distance3(at, center) <= radius;
        for (uint32_t link = tets->points.items[crumb[i]].first; link && small;
             link          = tets->links.items[link - 1].next)
            small = add_neighbors(tets, tets->links.items[link - 1].tet, large, crumb, &count);
    }
    for (size_t i = 0; i < count && !small; i++)
        large[crumb[i]] = true;
    return small ? count : 0;
}

static void move(Tets *tets, const uint32_t *points, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        tets->points.items[points[i]].moved = !tets->points.items[points[i]].moved;
        tets_renew(tets, points[i]);
    }
}

static bool drop_crumbs(Contour *contour, const double center[3], double radius, double deep)
{
    Tets     *tets  = contour->tets;
    ArenaMark mark  = arena_mark(contour->arena);
    bool     *large = arena_new_array(contour->arena, bool, tets->points.count);
    bool      any   = false;
    for (uint32_t i = 0; i < tets->points.count; i++) {
        uint32_t crumb[MAX_OF_CRUMB];
        double   at[3];
        tets_position(tets, i, at);
        if (!point_is_inside(tets, i) || large[i] || distance3(at, center) > radius)
            continue;
        size_t count = find_crumb(tets, i, center, radius, deep, large, crumb);
        move(tets, crumb, count);
        any = any || count > 0;
    }
    arena_rewind(contour->arena, mark);
    return any;
}

/* ---- all ---- */

bool sides_tidy(Contour *contour, const double center[3], double radius, double deep)
{
    enum { MAX_FREE = 10000, MAX_MOVED = 2000 };
    uint32_t  moved[MAX_MOVED];
    size_t    count = 0;
    Tets     *tets  = contour->tets;
    ArenaMark mark  = arena_mark(contour->arena);
    Place     place = {.tets = tets, .arena = contour->arena, .numbers = {.arena = contour->arena}};
    find_free(&place, center, radius, deep);
    if (place.links.count > 0 && place.links.count < MAX_FREE) {
        for (size_t i = 0; i < place.links.count; i++)
            find_link(&place, &place.links.items[i]);
        count = tidy(&place, moved, MAX_MOVED);
    }
    arena_rewind(contour->arena, mark);
    move(tets, moved, count);
    return drop_crumbs(contour, center, radius, deep) || count > 0;
}
