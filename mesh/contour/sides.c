/* sides.c: flips sides of points in a region, and counts connected parts by union-find, or by a
   search where one point is left out. */
#include "mesh/contour/sides.h"

#include <stdlib.h>
#include <string.h>

#include "compiler/base/vec.h"

/* The most tetrahedra around a point that may be moved. */
enum { MAX_AROUND = 200 };
/* The most parts of the sphere around a point that it may join. */
enum { MAX_SPHERE_PARTS = 16 };

/* The link of a point: the points around it, by their numbers in the region, and the edges between
   these on a sphere. */
typedef struct Link {
    uint32_t point, first_point, first_edge, point_count, edge_count;
    double   distance;
} Link;

typedef struct Region {
    Tets  *tets;
    Arena *arena;
    struct {
        Link  *items; /* of points that may be moved, the deepest first */
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
    uint32_t  parts[2]; /* connected parts before, outside and inside */
    /* The points next to each point, from `first_next[number]` to below `end_next[number]`; NULL
       until they are needed. */
    uint32_t *first_next, *end_next, *next;
    /* In a search: the points to be visited, and the search that has met each point last. */
    uint32_t *queue, *met, search;
} Region;

/* Longest edges of tetrahedra around points that are moved, over the radius: with longer ones the
   mesh would be far off. */
static const double FINE = 0.5;

/* ---- points and links ---- */

static uint32_t number_of(Region *region, uint32_t point)
{
    uint32_t fresh  = (uint32_t)region->points.count;
    uint32_t number = numbering_take(&region->numbers, (NumberKey){point, 1}, fresh);
    if (number == fresh)
        array_push(region->arena, &region->points, point);
    return number;
}

/* Tells whether few tetrahedra have a point, and none has a longer edge than `longest`. */
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

static void find_free(Region *region, const double center[3], double radius, double deep)
{
    for (uint32_t i = 0; i < region->tets->points.count; i++) {
        double at[3], distance = region->tets->points.items[i].distance;
        tets_position(region->tets, i, at);
        if (fabs(distance) <= deep && distance3(at, center) <= radius &&
            is_fine(region->tets, i, FINE * radius)) {
            Link link = {.point = i, .distance = distance};
            array_push(region->arena, &region->links, link);
        }
    }
    if (region->links.count > 0)
        qsort(region->links.items, region->links.count, sizeof *region->links.items, deepest_first);
    for (size_t i = 0; i < region->links.count; i++)
        number_of(region, region->links.items[i].point);
}

/* Finds the link of a point: the faces opposite to it make a sphere. */
static void find_link(Region *region, Link *link)
{
    const Tets *tets  = region->tets;
    link->first_point = (uint32_t)region->around.count;
    link->first_edge  = (uint32_t)region->edges.count;
    for (uint32_t at = tets->points.items[link->point].first; at;
         at          = tets->links.items[at - 1].next) {
        const uint32_t *points = tets->list.items[tets->links.items[at - 1].tet].points;
        uint32_t        across[3], count = 0;
        for (int k = 0; k < 4; k++)
            if (points[k] != link->point)
                across[count++] = number_of(region, points[k]);
        for (int k = 0; k < 3; k++) {
            array_reserve_large(region->arena, &region->edges);
            uint32_t *edge = region->edges.items[region->edges.count++];
            edge[0]        = across[k];
            edge[1]        = across[(k + 1) % 3];
            uint32_t i     = link->first_point;
            while (i < region->around.count && region->around.items[i] != across[k])
                i++;
            if (i == region->around.count)
                array_push(region->arena, &region->around, across[k]);
        }
    }
    link->point_count = (uint32_t)region->around.count - link->first_point;
    link->edge_count  = (uint32_t)region->edges.count - link->first_edge;
}

/* ---- connected parts ---- */

static uint32_t leader_of(uint32_t *leaders, uint32_t number)
{
    while (leaders[number] != number) {
        leaders[number] = leaders[leaders[number]];
        number          = leaders[number];
    }
    return number;
}

/* Joins neighbours in a link that are on the same side, and counts `parts` down. */
static void join(const Region *region, const Link *link, uint32_t *leaders, uint32_t parts[2])
{
    for (uint32_t i = link->first_edge; i < link->first_edge + link->edge_count; i++) {
        uint32_t a = region->edges.items[i][0], b = region->edges.items[i][1];
        if (region->inside[a] != region->inside[b])
            continue;
        uint32_t first = leader_of(leaders, a), second = leader_of(leaders, b);
        parts[region->inside[a]] -= first != second;
        leaders[first] = second;
    }
}

/* Counts the parts of the sphere around a point that are outside, and inside. */
static void count_around(const Region *region, const Link *link, uint32_t *leaders,
                         uint32_t parts[2])
{
    parts[0] = parts[1] = 0;
    for (uint32_t i = link->first_point; i < link->first_point + link->point_count; i++) {
        uint32_t number = region->around.items[i];
        leaders[number] = number;
        parts[region->inside[number]]++;
    }
    join(region, link, leaders, parts);
}

/* Counts the parts of the whole region. */
static void count_parts(const Region *region, uint32_t *leaders, uint32_t parts[2])
{
    parts[0] = parts[1] = 0;
    for (uint32_t i = 0; i < region->points.count; i++) {
        leaders[i] = i;
        parts[region->inside[i]]++;
    }
    for (size_t i = 0; i < region->links.count; i++) {
        const Link *link = &region->links.items[i];
        join(region, link, leaders, parts);
        for (uint32_t k = link->first_point; k < link->first_point + link->point_count; k++) {
            uint32_t other = region->around.items[k];
            uint32_t first = leader_of(leaders, (uint32_t)i), second = leader_of(leaders, other);
            if (region->inside[i] != region->inside[other] || first == second)
                continue;
            leaders[first] = second;
            parts[region->inside[i]]--;
        }
    }
}

/* ---- neighbours ---- */

/* Calls `use` with each two points of the region that an edge joins, some of them often. */
static void visit_edges(Region *region, void (*use)(Region *region, uint32_t a, uint32_t b))
{
    for (uint32_t i = 0; i < region->links.count; i++) {
        const Link *link = &region->links.items[i];
        for (uint32_t k = link->first_edge; k < link->first_edge + link->edge_count; k++)
            use(region, region->edges.items[k][0], region->edges.items[k][1]);
        for (uint32_t k = link->first_point; k < link->first_point + link->point_count; k++)
            use(region, i, region->around.items[k]);
    }
}

static void count_neighbours(Region *region, uint32_t a, uint32_t b)
{
    region->first_next[a + 1]++;
    region->first_next[b + 1]++;
}

static void add_neighbour(Region *region, uint32_t point, uint32_t other)
{
    uint32_t at = region->first_next[point];
    while (at < region->end_next[point] && region->next[at] != other)
        at++;
    if (at == region->end_next[point])
        region->next[region->end_next[point]++] = other;
}

static void add_neighbours(Region *region, uint32_t a, uint32_t b)
{
    add_neighbour(region, a, b);
    add_neighbour(region, b, a);
}

static void find_neighbours(Region *region)
{
    size_t count       = region->points.count;
    region->first_next = arena_new_array(region->arena, uint32_t, count + 1);
    region->end_next   = arena_new_array(region->arena, uint32_t, count + 1);
    region->queue      = arena_new_array(region->arena, uint32_t, count + 1);
    region->met        = arena_new_array(region->arena, uint32_t, count + 1);
    memset(region->first_next, 0, (count + 1) * sizeof *region->first_next);
    memset(region->met, 0, (count + 1) * sizeof *region->met);
    visit_edges(region, count_neighbours);
    for (size_t i = 0; i < count; i++)
        region->first_next[i + 1] += region->first_next[i];
    memcpy(region->end_next, region->first_next, (count + 1) * sizeof *region->first_next);
    region->next = arena_new_array(region->arena, uint32_t, region->first_next[count] + 1);
    visit_edges(region, add_neighbours);
}

/* Has a search meet all points of a side that are connected with one, but for `without`. */
static void meet_part(Region *region, uint32_t start, uint32_t without)
{
    size_t count       = 1;
    region->queue[0]   = start;
    region->met[start] = region->search;
    for (size_t i = 0; i < count; i++) {
        uint32_t point = region->queue[i];
        for (uint32_t at = region->first_next[point]; at < region->end_next[point]; at++) {
            uint32_t other = region->next[at];
            if (other == without || region->met[other] == region->search ||
                region->inside[other] != region->inside[start])
                continue;
            region->met[other]     = region->search;
            region->queue[count++] = other;
        }
    }
}

/* Returns how many connected parts of its side the points around a point would be, without it. */
static uint32_t parts_without(Region *region, uint32_t number)
{
    const Link *link  = &region->links.items[number];
    uint32_t    parts = 0;
    if (!region->next)
        find_neighbours(region);
    region->search++;
    for (uint32_t i = link->first_point; i < link->first_point + link->point_count; i++) {
        uint32_t other = region->around.items[i];
        if (region->inside[other] != region->inside[number] || region->met[other] == region->search)
            continue;
        meet_part(region, other, number);
        parts++;
    }
    return parts;
}

/* Returns how much the Euler number of the inside grows if a point becomes inside: a cone is added
   over the inside of its sphere. */
static long euler_of_cone(const uint32_t parts[2])
{
    if (parts[0] == 0)
        return -1;
    return parts[1] == 0 ? 1 : (long)parts[0] - (long)parts[1];
}

/* ---- flips ---- */

/* Tells whether a point that is flipped to a side joins only parts that are not connected yet;
   `*other` becomes the number of parts of the other side around it. */
static bool may_flip(const Region *region, const Link *link, bool inside, uint32_t *leaders,
                     uint32_t *wholes, uint32_t *other)
{
    uint32_t parts[2], whole[MAX_SPHERE_PARTS], count = 0;
    count_around(region, link, leaders, parts);
    *other = parts[!inside];
    if (parts[inside] == 0 || parts[inside] > MAX_SPHERE_PARTS || parts[!inside] == 0)
        return false;
    for (uint32_t i = link->first_point; i < link->first_point + link->point_count; i++) {
        uint32_t number = region->around.items[i];
        if (region->inside[number] != inside || leaders[number] != number)
            continue;
        whole[count] = leader_of(wholes, number);
        for (uint32_t k = 0; k < count; k++)
            if (whole[k] == whole[count])
                return false;
        count++;
    }
    return true;
}

/* Flips a point to a side; returns how much the Euler number of the inside grows. */
static long flip(Region *region, uint32_t number, bool inside, uint32_t *leaders, uint32_t *wholes)
{
    const Link *link = &region->links.items[number];
    uint32_t    parts[2];
    count_around(region, link, leaders, parts);
    region->inside[number] = inside;
    wholes[number]         = number;
    for (uint32_t i = link->first_point; i < link->first_point + link->point_count; i++)
        if (region->inside[region->around.items[i]] == inside)
            wholes[leader_of(wholes, region->around.items[i])] = leader_of(wholes, number);
    return inside ? euler_of_cone(parts) : -euler_of_cone(parts);
}

/* Flips a point that closes a hole, unless this divides the other side, which has `*parts`, into
   more parts than before; returns as flip. */
static long close_hole(Region *region, uint32_t number, bool inside, uint32_t *leaders,
                       uint32_t *wholes, uint32_t *parts)
{
    uint32_t more = parts_without(region, number) - 1;
    if (*parts + more > region->parts[!inside])
        return 0;
    *parts += more;
    return flip(region, number, inside, leaders, wholes);
}

/* Moves all to one side, and those back that were on the other, as long as no handle appears.
   Returns how much the Euler number of the inside grows. */
static long sweep(Region *region, bool inside, uint32_t *leaders, uint32_t *wholes)
{
    uint32_t parts[2], other, count = (uint32_t)region->links.count;
    long     euler = 0;
    for (uint32_t i = 0; i < count; i++)
        if (region->inside[i] != inside)
            euler += flip(region, i, inside, leaders, wholes);
    count_parts(region, wholes, parts);
    for (bool any = true, closing = false; any || !closing;) {
        closing = !any;
        any     = false;
        for (uint32_t k = 0; k < count; k++) {
            uint32_t i = inside ? count - 1 - k : k;
            if (region->before[i] == inside || region->inside[i] != inside ||
                !may_flip(region, &region->links.items[i], !inside, leaders, wholes, &other) ||
                (other > 1 && !closing))
                continue;
            euler += other > 1 ? close_hole(region, i, !inside, leaders, wholes, &parts[inside])
                               : flip(region, i, !inside, leaders, wholes);
            any = any || region->inside[i] != inside;
        }
    }
    return euler;
}

/* Returns how many fewer handles and parts there are; 0 if there are more of one kind, or the parts
   of that side change in number. */
static long gain_of(Region *region, bool inside, uint32_t *leaders, uint32_t *wholes)
{
    uint32_t after[2], *before = region->parts;
    for (size_t i = 0; i < region->points.count; i++)
        region->inside[i] = region->before[i];
    count_parts(region, leaders, before);
    long euler = sweep(region, inside, leaders, wholes);
    count_parts(region, leaders, after);
    long parts = (long)before[!inside] - (long)after[!inside], handles = euler + parts;
    return before[inside] == after[inside] && parts >= 0 && handles >= 0 ? handles + parts : 0;
}

/* Chooses the side to which points go, and lists those that are moved; returns how many. */
static size_t tidy(Region *region, uint32_t *moved, size_t most)
{
    uint32_t *leaders = arena_new_array(region->arena, uint32_t, region->points.count + 1);
    uint32_t *wholes  = arena_new_array(region->arena, uint32_t, region->points.count + 1);
    size_t    count   = 0;
    region->inside    = arena_new_array(region->arena, bool, region->points.count + 1);
    region->before    = arena_new_array(region->arena, bool, region->points.count + 1);
    for (size_t i = 0; i < region->points.count; i++)
        region->before[i] = point_is_inside(region->tets, region->points.items[i]);
    long cut    = gain_of(region, false, leaders, wholes),
         filled = gain_of(region, true, leaders, wholes);
    if (cut <= 0 && filled <= 0)
        return 0;
    if (cut >= filled)
        gain_of(region, false, leaders, wholes);
    for (size_t i = 0; i < region->links.count; i++)
        if (region->inside[i] != region->before[i]) {
            if (count < most)
                moved[count] = region->links.items[i].point;
            count++;
        }
    return count <= most ? count : 0;
}

/* ---- islands ---- */

enum { MAX_OF_ISLAND = 64 };

/* Adds the points of a tetrahedron that are inside to an island; returns false if one is of a large
   part, or they are too many. */
static bool add_to_island(const Tets *tets, uint32_t tet, uint32_t island[MAX_OF_ISLAND],
                          size_t *count)
{
    for (int k = 0; k < 4; k++) {
        const uint32_t other = tets->list.items[tet].points[k];
        size_t         known = 0;
        if (!point_is_inside(tets, other))
            continue;
        while (known < *count && island[known] != other)
            known++;
        if (known < *count)
            continue;
        if (*count == MAX_OF_ISLAND || tets->points.items[other].large)
            return false;
        island[(*count)++] = other;
    }
    return true;
}

/* Lists the points inside that are connected with a point.  Returns how many; 0: they are no
   island, since they are too many, or some are far or deep.  Marks what it found of a part that is
   no island as large. */
static size_t find_island(Tets *tets, uint32_t point, const double center[3], double radius,
                          double deep, uint32_t island[MAX_OF_ISLAND])
{
    size_t count = 1;
    bool   small = true;
    island[0]    = point;
    for (size_t i = 0; i < count && small; i++) {
        double at[3];
        tets_position(tets, island[i], at);
        small = fabs(tets->points.items[island[i]].distance) <= deep &&
                distance3(at, center) <= radius;
        for (uint32_t link = tets->points.items[island[i]].first; link && small;
             link          = tets->links.items[link - 1].next)
            small = add_to_island(tets, tets->links.items[link - 1].tet, island, &count);
    }
    for (size_t i = 0; i < count && !small; i++)
        tets->points.items[island[i]].large = true;
    return small ? count : 0;
}

static void move(Tets *tets, const uint32_t *points, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        tets->points.items[points[i]].moved = !tets->points.items[points[i]].moved;
        tets_renew(tets, points[i]);
    }
}

/* Moves the points of all islands to the outside; returns whether there were any. */
static bool drop_islands(Tets *tets, const double center[3], double radius, double deep)
{
    bool any = false;
    for (uint32_t i = 0; i < tets->points.count; i++)
        tets->points.items[i].large = false;
    for (uint32_t i = 0; i < tets->points.count; i++) {
        uint32_t island[MAX_OF_ISLAND];
        double   at[3];
        tets_position(tets, i, at);
        if (!point_is_inside(tets, i) || tets->points.items[i].large ||
            distance3(at, center) > radius)
            continue;
        size_t count = find_island(tets, i, center, radius, deep, island);
        move(tets, island, count);
        any = any || count > 0;
    }
    return any;
}

/* ---- entry point ---- */

bool sides_tidy(Contour *contour, const double center[3], double radius, double deep)
{
    enum { MAX_FREE = 10000, MAX_MOVED = 2000 };
    uint32_t  moved[MAX_MOVED];
    size_t    count = 0;
    Tets     *tets  = contour->tets;
    ArenaMark mark  = arena_mark(contour->arena);
    Region region   = {.tets = tets, .arena = contour->arena, .numbers = {.arena = contour->arena}};
    find_free(&region, center, radius, deep);
    if (region.links.count > 0 && region.links.count < MAX_FREE) {
        for (size_t i = 0; i < region.links.count; i++)
            find_link(&region, &region.links.items[i]);
        count = tidy(&region, moved, MAX_MOVED);
    }
    arena_rewind(contour->arena, mark);
    move(tets, moved, count);
    return drop_islands(tets, center, radius, deep) || count > 0;
}
