/*
 * split.c: vertices that are doubled where triangles differ in what they know of them.
 */
#include <string.h>

#include "cli/mesh/meshing.h"

static const uint32_t NONE = UINT32_MAX;

/* A corner: its place in a texture, its frame and its color. */
typedef struct Corner {
    double        place[2];
    MeshFrame     frame;
    unsigned char color[3];
} Corner;

typedef struct Split {
    const MeshParts *from;
    size_t          *source; /* of vertices: the one that it was */
    bool             all;
    double (*places)[2];
    MeshFrame *frames;
    unsigned char (*colors)[3];
    uint32_t *next, *first; /* vertices of one source: the first, and one by one */
    uint32_t (*triangles)[3];
    size_t count;
} Split;

static Corner corner_of(const Split *split, size_t triangle, int k)
{
    const MeshParts *parts = split->from;
    Corner           corner;
    memset(&corner, 0, sizeof corner);
    memcpy(corner.color, mesh_corner_color(parts, triangle, k), sizeof corner.color);
    if (split->all && parts->corner_places)
        memcpy(corner.place, parts->corner_places[triangle][k], sizeof corner.place);
    if (split->all && parts->corner_frames)
        corner.frame = parts->corner_frames[triangle][k];
    return corner;
}

static uint32_t take_vertex(Split *split, uint32_t source, const Corner *corner)
{
    uint32_t *at = &split->first[source];
    for (; *at != NONE; at = &split->next[*at])
        if (memcmp(split->places[*at], corner->place, sizeof corner->place) == 0 &&
            memcmp(&split->frames[*at], &corner->frame, sizeof corner->frame) == 0 &&
            memcmp(split->colors[*at], corner->color, sizeof corner->color) == 0)
            return *at;
    uint32_t number       = (uint32_t)split->count++;
    *at                   = number;
    split->next[number]   = NONE;
    split->source[number] = source;
    split->frames[number] = corner->frame;
    memcpy(split->places[number], corner->place, sizeof corner->place);
    memcpy(split->colors[number], corner->color, sizeof corner->color);
    return number;
}

static MeshPart split_part(Split *split, const MeshPart *part)
{
    MeshPart result     = *part;
    result.first_vertex = split->count;
    for (size_t i = part->first_triangle; i < part->first_triangle + part->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            Corner corner          = corner_of(split, i, k);
            split->triangles[i][k] = take_vertex(split, split->from->triangles[i][k], &corner);
        }
    result.vertex_count = split->count - result.first_vertex;
    return result;
}

static void copy_vertices(const Split *split, Arena *arena, MeshParts *parts)
{
    double(*vertices)[3] = arena_alloc(arena, split->count, sizeof *vertices);
    for (size_t i = 0; i < split->count; i++)
        memcpy(vertices[i], parts->vertices[split->source[i]], sizeof *vertices);
    parts->vertices = (const double(*)[3])vertices;
    parts->colors   = (const unsigned char(*)[3])split->colors;
}

void split_corners(Arena *arena, MeshParts *parts, bool all)
{
    size_t    triangles = parts_triangle_count(parts), most = 3 * triangles;
    size_t    vertices = parts_vertex_count(parts);
    MeshPart *list     = arena_new_array(arena, MeshPart, parts->part_count);
    if (!parts->corner_colors && !(all && (parts->corner_places || parts->corner_frames)))
        return;
    Split split = {.from      = parts,
                   .all       = all,
                   .colors    = arena_alloc(arena, most, sizeof *split.colors),
                   .source    = arena_alloc(arena, most, sizeof *split.source),
                   .places    = arena_alloc(arena, most, sizeof *split.places),
                   .frames    = arena_alloc(arena, most, sizeof *split.frames),
                   .next      = arena_alloc(arena, most, sizeof *split.next),
                   .first     = arena_alloc(arena, vertices, sizeof *split.first),
                   .triangles = arena_alloc(arena, triangles, sizeof *split.triangles)};
    memset(split.first, 0xff, vertices * sizeof *split.first);
    for (size_t i = 0; i < parts->part_count; i++)
        list[i] = split_part(&split, &parts->parts[i]);
    copy_vertices(&split, arena, parts);
    parts->corner_colors = NULL;
    parts->triangles     = (const uint32_t(*)[3])split.triangles;
    parts->vertex_places = all && parts->corner_places ? (const double(*)[2])split.places : NULL;
    parts->vertex_frames = all && parts->corner_frames ? split.frames : NULL;
    parts->parts         = list;
}
